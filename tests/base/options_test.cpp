#include "fovea/base/options.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fovea/base/error.h"

namespace fovea {
namespace {

enum class Color { red, green };

/// One member of every kind that an option can be.
struct Sample {
  bool flag = false;
  std::int64_t count = 5;
  double weight = 0.5;
  std::string name = "x";
  std::optional<std::int64_t> limit;
  std::optional<double> ratio;
  Color color = Color::red;

  OptionList describe() {
    return {{"flag", "A flag.", &flag, ""},
            {"count", "A count.", &count, "triangles", 1, 10},
            {"weight", "A weight.", &weight, "", 0},
            {"name", "A name.", &name, ""},
            {"limit", "A limit.", &limit, "", 0},
            {"ratio", "A ratio.", &ratio, "", 0, 1},
            {"color", "A colour.", choice(color, {"red", "green"}), ""}};
  }
};

Option& find(OptionList& list, const std::string& name) {
  for (Option& o : list) {
    if (o.name == name) return o;
  }
  throw std::logic_error("no such option: " + name);
}

std::string usage_error(OptionList& list, const std::string& name, const std::string& text) {
  try {
    find(list, name).parse(text);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::usage);
    return std::string(e.what()) + " | " + e.hint();
  }
  return "no error";
}

TEST(Options, ParseSetsTheMemberOfEachKind) {
  Sample s;
  OptionList list = s.describe();
  find(list, "flag").parse("true");
  find(list, "count").parse("7");
  find(list, "weight").parse("1e3");
  find(list, "name").parse("a b");
  find(list, "limit").parse("12");
  find(list, "ratio").parse("0.25");
  find(list, "color").parse("green");
  EXPECT_TRUE(s.flag);
  EXPECT_EQ(s.count, 7);
  EXPECT_EQ(s.weight, 1000.0);
  EXPECT_EQ(s.name, "a b");
  EXPECT_EQ(s.limit, 12);
  EXPECT_EQ(s.ratio, 0.25);
  EXPECT_EQ(s.color, Color::green);
}

TEST(Options, TextOfValuesAndRanges) {
  Sample s;
  OptionList list = s.describe();
  EXPECT_EQ(find(list, "flag").value_text(), "false");
  EXPECT_EQ(find(list, "count").value_text(), "5");
  EXPECT_EQ(find(list, "weight").value_text(), "0.5");
  EXPECT_EQ(find(list, "ratio").value_text(), "none");
  EXPECT_EQ(find(list, "color").value_text(), "red");
  EXPECT_EQ(find(list, "count").range_text(), "1..10");
  EXPECT_EQ(find(list, "weight").range_text(), ">= 0");
  EXPECT_EQ(find(list, "color").range_text(), "red|green");
  EXPECT_EQ(find(list, "name").range_text(), "");
  EXPECT_TRUE(find(list, "flag").is_flag());
  EXPECT_FALSE(find(list, "count").is_flag());
  double x = 0;
  EXPECT_EQ((Option{"x", "", &x, "", -std::numeric_limits<double>::infinity(), 3}.range_text()), "<= 3");
}

TEST(Options, BadTextNamesOptionTextAndRange) {
  Sample s;
  OptionList list = s.describe();
  const std::string message = usage_error(list, "count", "many");
  EXPECT_NE(message.find("--count"), std::string::npos) << message;
  EXPECT_NE(message.find("'many'"), std::string::npos) << message;
  EXPECT_NE(message.find("1..10"), std::string::npos) << message;
}

TEST(Options, RejectsWhatIsNotAValueInRange) {
  Sample s;
  OptionList list = s.describe();
  const std::vector<std::pair<std::string, std::string>> bad{{"flag", "yes"},
                                                             {"count", ""},
                                                             {"count", "11"},
                                                             {"count", "0"},
                                                             {"count", "1.5"},
                                                             {"count", "3x"},
                                                             {"count", " 3"},
                                                             {"weight", "-1"},
                                                             {"weight", "nan"},
                                                             {"weight", "inf"},
                                                             {"weight", "1,5"},
                                                             {"limit", "-1"},
                                                             {"ratio", "1.0001"},
                                                             {"ratio", "none"},
                                                             {"color", "blue"},
                                                             {"color", "RED"},
                                                             {"count", "99999999999999999999"}};
  for (const auto& [name, text] : bad) {
    EXPECT_NE(usage_error(list, name, text), "no error") << name << " = '" << text << "'";
  }
}

TEST(Options, HintsSayWhatIsAllowedAndWhatIsNear) {
  Sample s;
  OptionList list = s.describe();
  EXPECT_EQ(usage_error(list, "count", "1.5"),
            "--count: '1.5' is not a value for it | allowed: whole numbers 1..10");
  EXPECT_EQ(usage_error(list, "ratio", "2"), "--ratio: '2' is not a value for it | allowed: 0..1");
  EXPECT_EQ(usage_error(list, "color", "gren"),
            "--color: 'gren' is not a value for it | did you mean green? allowed: red|green");
}

TEST(Options, CheckListsAllFaultsAtOnce) {
  Sample s;
  OptionList list = s.describe();
  EXPECT_NO_THROW(check(list));
  s.count = 99;
  s.ratio = -1;
  try {
    check(list);
    FAIL() << "must throw";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::usage);
    EXPECT_NE(e.message().find("--count"), std::string::npos);
    EXPECT_NE(e.message().find("--ratio"), std::string::npos);
  }
}

TEST(NearestNames, FindsTypingErrors) {
  const std::vector<std::string> names{"vase", "arm", "spheres", "terrain"};
  EXPECT_EQ(nearest_names("vaes", names), std::vector<std::string>{"vase"});
  EXPECT_EQ(nearest_names("terain", names), std::vector<std::string>{"terrain"});
  EXPECT_EQ(nearest_names("sphere", names), std::vector<std::string>{"spheres"});
}

TEST(NearestNames, NothingWhenNothingIsNear) {
  EXPECT_TRUE(nearest_names("quadric", {"vase", "arm"}).empty());
  EXPECT_TRUE(nearest_names("arms", {"vase", "terrain"}).empty());
  EXPECT_TRUE(nearest_names("size", {"views", "time"}).empty());
  EXPECT_TRUE(nearest_names("x", {}).empty());
}

TEST(NearestNames, BestFirstAndNoMoreThanAskedFor) {
  const std::vector<std::string> names{"ratios", "ration", "ratio"};
  const auto two = nearest_names("ratio", names, 2);
  EXPECT_EQ(two, (std::vector<std::string>{"ratio", "ratios"}));
}

}  // namespace
}  // namespace fovea
