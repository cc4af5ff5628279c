#include "fovea/base/context.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "fovea/base/error.h"

namespace fovea {
namespace {

TEST(Context, ZeroThreadsMeansAllAndAtLeastOne) {
  Context context;
  EXPECT_GE(context.thread_count(), 1);
  context.threads = 3;
  EXPECT_EQ(context.thread_count(), 3);
}

TEST(Context, AdvanceTellsProgressAndGoesOn) {
  Context context;
  EXPECT_TRUE(context.advance("read", 0.5)) << "nobody listens";
  std::string phase;
  double fraction = -1;
  context.progress = [&](std::string_view p, double f) {
    phase = p;
    fraction = f;
    return true;
  };
  EXPECT_TRUE(context.advance("collapse", 1.5));
  EXPECT_EQ(phase, "collapse");
  EXPECT_EQ(fraction, 1.0) << "clamped";
}

TEST(Context, ProgressCanCancel) {
  Context context;
  context.progress = [](std::string_view, double) { return false; };
  EXPECT_FALSE(context.cancelled());
  EXPECT_FALSE(context.advance("read", 0));
  EXPECT_TRUE(context.cancelled());
}

TEST(Context, CancelFromOutsideStopsTheNextAdvance) {
  Context context;
  EXPECT_NO_THROW(context.advance_or_throw("read", 0));
  std::thread([&] { context.cancel(); }).join();
  EXPECT_FALSE(context.advance("read", 0));
  try {
    context.advance_or_throw("read", 0);
    FAIL() << "must throw";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::cancelled);
  }
}

TEST(Context, EqualCodesAreCountedAndSorted) {
  Context context;
  context.report("b-second", "first message", "place one");
  context.report("a-first", "other", {}, 7);
  context.report("b-second", "later message", "place two", 2);
  const std::vector<Diagnostic> d = context.diagnostics();
  ASSERT_EQ(d.size(), 2u);
  EXPECT_EQ(d[0].code, "a-first");
  EXPECT_EQ(d[0].count, 7u);
  EXPECT_EQ(d[1].code, "b-second");
  EXPECT_EQ(d[1].message, "first message");
  EXPECT_EQ(d[1].place, "place one");
  EXPECT_EQ(d[1].count, 3u);
}

TEST(Context, ReportsFromManyThreadsAllCount) {
  Context context;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 100; ++i) context.report(i % 2 ? "odd" : "even", "m", std::to_string(t));
    });
  }
  for (std::thread& t : threads) t.join();
  const auto d = context.diagnostics();
  ASSERT_EQ(d.size(), 2u);
  EXPECT_EQ(d[0].count, 200u);
  EXPECT_EQ(d[1].count, 200u);
}

}  // namespace
}  // namespace fovea
