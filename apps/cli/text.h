#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fovea::cli {

/// 15452 -> "15,452".
std::string count_text(std::uint64_t count);
/// "1 mesh", "2 meshes": the count with its noun.
std::string plural(std::uint64_t count, const std::string& one, const std::string& many);
/// Decimal units, three digits: "980 B", "37.4 kB", "3.74 MB".
std::string bytes_text(std::uint64_t bytes);
/// "0.42 s", "3 min 12 s".
std::string seconds_text(double seconds);
/// part / whole as "12.3 %"; empty if `whole` is 0.
std::string percent_text(std::uint64_t part, std::uint64_t whole);
/// A number in up to four digits.
std::string number_text(double number);
/// `text` without control characters, so that names from files cannot steer the terminal.
std::string printable(std::string_view text);
/// "600 KB, 2" -> {"600 KB", "2"}: what stands between commas, one part more than there are commas, without
/// blanks around it.
std::vector<std::string> split_list(std::string_view text);
/// Breaks a paragraph at spaces so that no line exceeds `width`; lines after the first are indented.
std::string wrap(const std::string& text, std::size_t width, std::size_t indent);

/// Columns of text, aligned as the letters of `align` say: 'l' to the left, 'r' (numbers) to the right;
/// the last letter holds for all further columns.
class TextTable {
 public:
  explicit TextTable(std::string align) : align_(std::move(align)) {}
  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  bool empty() const { return rows_.empty(); }
  /// All rows, each after `indent` spaces and ended by a line break. Trailing blanks are cut.
  std::string text(std::size_t indent) const;

 private:
  std::string align_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace fovea::cli
