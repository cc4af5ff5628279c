#include "fovea/judge/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/simplify/simplify.h"
#include "support/by_quadrics.h"
#include "support/meshes.h"

namespace fovea {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Report : public ::testing::Test {
 protected:
  Report() {
    options_.views.set = ViewSet::tetrahedron;
    options_.size = 48;
    options_.distance_samples = 200;
    SimplifyOptions simplify_options = test::by_quadrics();
    simplify_options.ratio = 0.1;
    small_ = simplify(model_, simplify_options, {}, context_).model;
  }

  std::string page(const std::string& name, int threads = 1) {
    Context context;
    context.threads = threads;
    const Model* const tests[] = {&small_, &model_};
    CompareReport report;
    const auto found = compare(model_, tests, options_, context, report.observer());
    const ReportModel shown[] = {{name, 10, 20, {1, 2, 3, 4}}, {"same", 5, 6, {}}};
    return report.html({"reference", 100, 200, {}}, shown, found);
  }

  /// The data that the page holds.
  static nlohmann::json data_of(const std::string& page) {
    const std::string before = "const D = ";
    const std::size_t begin = page.find(before) + before.size();
    return nlohmann::json::parse(page.substr(begin, page.find(";\n", begin) - begin));
  }

  Context context_;
  Model model_ = test::model_of(test::torus(24, 12)), small_;
  CompareOptions options_;
};

TEST_F(Report, HoldsAllPicturesOfAllViews) {
  const nlohmann::json data = data_of(page("small"));
  ASSERT_EQ(data["views"].size(), 4u);
  for (const nlohmann::json& view : data["views"]) {
    for (const char* pass : {"base", "lit"})
      EXPECT_THAT(view[pass].get<std::string>(), HasSubstr("data:image/webp;base64,UklGR"));  // RIFF
    ASSERT_EQ(view["tests"].size(), 2u);
    for (const nlohmann::json& test : view["tests"]) {
      for (const char* kind : {"base", "lit", "flip", "distance"})
        EXPECT_GT(test[kind].get<std::string>().size(), 100u) << kind;
    }
    EXPECT_EQ(view["tests"][1]["lit"], view["lit"]) << "the same model gives the same picture";
  }
  EXPECT_EQ(data["tests"][0]["bytes"]["images"], 2);
  EXPECT_EQ(data["tests"][0]["scores"]["views"].size(), 4u);
  EXPECT_TRUE(data["tests"][1]["scores"]["lit"]["psnr"].is_null());
}

TEST_F(Report, NeedsNothingElse) {
  std::string text = page("small");
  const std::string svg = "http://www.w3.org/2000/svg";  // a name, not a place
  ASSERT_THAT(text, HasSubstr(svg));
  text.erase(text.find(svg), svg.size());
  EXPECT_THAT(text, Not(HasSubstr("http:")));
  EXPECT_THAT(text, Not(HasSubstr("https:")));
  EXPECT_THAT(text, Not(HasSubstr("src=\"")));
}

TEST_F(Report, NamesCannotEndTheScript) {
  const std::string text = page("</script><script>alert(1)//\xff");
  EXPECT_THAT(text, Not(HasSubstr("</script><script>")));
  EXPECT_THAT(data_of(text)["tests"][0]["name"].get<std::string>(), HasSubstr("</script>"));
}

TEST_F(Report, IsTheSameForAnyThreads) { EXPECT_EQ(page("small", 1), page("small", 3)); }

}  // namespace
}  // namespace fovea
