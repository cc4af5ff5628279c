#include "fovea/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "fovea/base/error.h"

namespace fovea {
namespace {

TEST(ParallelFor, VisitsEachIndexOnce) {
  for (const int threads : {1, 2, 5}) {
    Context context;
    context.threads = threads;
    std::vector<std::atomic<int>> visits(1003);
    parallel_for(context, visits.size(), 10, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const auto& v : visits) ASSERT_EQ(v, 1) << threads << " threads";
  }
}

TEST(ParallelFor, ChunksDependOnGrainOnly) {
  for (const int threads : {1, 3}) {
    Context context;
    context.threads = threads;
    std::vector<std::size_t> ends(4, 0);
    parallel_for(context, 10, 3, [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(begin % 3, 0u);
      ends[begin / 3] = end;
    });
    EXPECT_EQ(ends, (std::vector<std::size_t>{3, 6, 9, 10}));
  }
}

TEST(ParallelFor, ReductionHasTheSameBitsForAnyThreadCount) {
  const auto sum = [](int threads) {
    Context context;
    context.threads = threads;
    std::vector<double> partial(100, 0.0);
    parallel_for(context, 10000, 100, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) partial[begin / 100] += std::sin(static_cast<double>(i));
    });
    return std::accumulate(partial.begin(), partial.end(), 0.0);
  };
  EXPECT_EQ(sum(1), sum(2));
  EXPECT_EQ(sum(1), sum(7));
}

TEST(ParallelFor, NothingToDoAndGrainZero) {
  Context context;
  int calls = 0;
  parallel_for(context, 0, 4, [&](std::size_t, std::size_t) { ++calls; });
  EXPECT_EQ(calls, 0);
  context.threads = 1;
  parallel_for(context, 3, 0, [&](std::size_t begin, std::size_t end) {
    EXPECT_EQ(end, begin + 1);
    ++calls;
  });
  EXPECT_EQ(calls, 3);
}

TEST(ParallelFor, RethrowsExceptions) {
  for (const int threads : {1, 2}) {
    Context context;
    context.threads = threads;
    EXPECT_THROW(parallel_for(context, 100, 1,
                              [](std::size_t begin, std::size_t) {
                                if (begin == 42) throw std::runtime_error("42");
                              }),
                 std::runtime_error);
  }
}

TEST(ParallelForOrThrow, EndsSoonAfterCancelling) {
  for (const int threads : {1, 2}) {
    Context context;
    context.threads = threads;
    std::atomic<int> calls = 0;
    const auto run = [&] {
      parallel_for_or_throw(context, 1000, 1, [&](std::size_t, std::size_t) {
        ++calls;
        context.cancel();
      });
    };
    try {
      run();
      ADD_FAILURE() << "cancelled but not thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
    EXPECT_LE(calls, threads);
  }
}

TEST(ParallelForOrThrow, ElseIsAsParallelFor) {
  Context context;
  std::atomic<std::size_t> sum = 0;
  parallel_for_or_throw(context, 10, 3, [&](std::size_t begin, std::size_t end) { sum += end - begin; });
  EXPECT_EQ(sum, 10u);
}

}  // namespace
}  // namespace fovea
