#include "cli/text.h"

#include <gtest/gtest.h>

#include "cli/progress.h"

namespace fovea::cli {
namespace {

TEST(Text, CountsAreGrouped) {
  EXPECT_EQ(count_text(0), "0");
  EXPECT_EQ(count_text(999), "999");
  EXPECT_EQ(count_text(1000), "1,000");
  EXPECT_EQ(count_text(1234567), "1,234,567");
}

TEST(Text, BytesHaveThreeDigits) {
  EXPECT_EQ(bytes_text(999), "999 B");
  EXPECT_EQ(bytes_text(1000), "1.00 kB");
  EXPECT_EQ(bytes_text(37400), "37.4 kB");
  EXPECT_EQ(bytes_text(374000), "374 kB");
  EXPECT_EQ(bytes_text(999499), "999 kB");
  EXPECT_EQ(bytes_text(999999), "1.00 MB");
}

TEST(Text, SecondsAndPercent) {
  EXPECT_EQ(seconds_text(0.415), "0.41 s");
  EXPECT_EQ(seconds_text(192), "3 min 12 s");
  EXPECT_EQ(seconds_text(7260), "2 h 1 min");
  EXPECT_EQ(percent_text(1, 8), "12.5 %");
  EXPECT_EQ(percent_text(1, 0), "");
}

TEST(Text, NamesCannotSteerTheTerminal) { EXPECT_EQ(printable("a\x1b[2Jb\n"), "a?[2Jb?"); }

TEST(Text, ListsAreSplitAtCommas) {
  EXPECT_EQ(split_list("600 KB, 2"), (std::vector<std::string>{"600 KB", "2"}));
  EXPECT_EQ(split_list(",a ,"), (std::vector<std::string>{"", "a", ""}));
  EXPECT_EQ(split_list(" "), std::vector<std::string>{""});
}

TEST(Text, WrapIndentsAllLinesButTheFirst) {
  EXPECT_EQ(wrap("aa bb cc", 7, 2), "aa bb\n  cc");
  EXPECT_EQ(wrap("longerthanaline b", 4, 0), "longerthanaline\nb");
}

TEST(Text, TableAlignsCharactersNotBytes) {
  TextTable table("lr");
  table.row({"é", "1"});
  table.row({"ab", "20"});
  EXPECT_EQ(table.text(1), " é    1\n ab  20\n");
}

TEST(ProgressLine, ShowsPercentAndTimeLeft) {
  EXPECT_EQ(progress_line("read", 0.5, 0.1), "read         [===============               ]  50 %");
  // A quarter took 30 s: three times as much is left.
  EXPECT_EQ(progress_line("collapse", 0.25, 30),
            "collapse     [=======                       ]  25 %  1:30 left");
  EXPECT_EQ(progress_line("x", 2.0, 0), "x            [==============================] 100 %");
}

}  // namespace
}  // namespace fovea::cli
