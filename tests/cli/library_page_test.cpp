// The code of docs/library.md is that of examples/library_tour, which is built and run against an installed
// Fovea.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "run_command.h"

namespace fovea::test {
namespace {

/// The blocks of C++ of a page, without their fences.
std::vector<std::string> code_of_page(const std::string& page) {
  std::vector<std::string> blocks;
  std::istringstream lines(page);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (inside && line == "```") {
      inside = false;
    } else if (inside) {
      blocks.back() += line + '\n';
    } else if (line == "```cpp") {
      inside = true;
      blocks.emplace_back();
    }
  }
  return blocks;
}

/// What stands between `// [name]` and `// [/name]`, moved to the left edge by the mark's own indentation.
std::vector<std::string> marked_parts(const std::string& source) {
  std::vector<std::string> parts;
  std::istringstream lines(source);
  std::string end;
  std::size_t indentation = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t mark = line.find("// [");
    if (!end.empty() && mark != std::string::npos && line.substr(mark) == end) {
      end.clear();
    } else if (!end.empty()) {
      parts.back() += line.substr(std::min(indentation, line.size())) + '\n';
    } else if (mark != std::string::npos) {
      end = "// [/" + line.substr(mark + 4);
      indentation = mark;
      parts.emplace_back();
    }
  }
  return parts;
}

TEST(LibraryPage, ShowsCodeThatCompiles) {
  const std::vector<std::string> shown = code_of_page(read_text(FOVEA_LIBRARY_PAGE));
  const std::vector<std::string> compiled = marked_parts(read_text(FOVEA_LIBRARY_TOUR));
  EXPECT_EQ(shown.size(), compiled.size());
  EXPECT_THAT(shown, testing::IsSubsetOf(compiled))
      << "docs/library.md and examples/library_tour/main.cpp differ";
}

}  // namespace
}  // namespace fovea::test
