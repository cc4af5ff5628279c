#pragma once

#include <charconv>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace fovea {

/// Walks over text in memory word by word and counts lines for messages. Never reads beyond the end
/// and never throws: what does not parse gives false and leaves the place unchanged.
///
/// Lines end in \n, \r\n or \r. Blanks are spaces, tabs and, if asked for, a backslash at the end of
/// a line (which joins it to the next).
class TextScanner {
 public:
  explicit TextScanner(std::span<const std::byte> text, bool joins_lines = false)
      : at_(reinterpret_cast<const char*>(text.data())),
        begin_(at_),
        end_(at_ + text.size()),
        joins_lines_(joins_lines) {}

  bool at_end() const { return at_ == end_; }
  /// Number of the present line, from 1.
  std::size_t line() const { return line_; }
  std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }

  /// Whether nothing but blanks and a comment ("#") is left of the line. Skips the blanks.
  bool line_done() {
    skip_blanks();
    return at_ == end_ || *at_ == '\n' || *at_ == '\r' || *at_ == '#';
  }
  void skip_blanks() {
    while (at_ != end_) {
      if (*at_ == ' ' || *at_ == '\t') {
        ++at_;
      } else if (!(joins_lines_ && *at_ == '\\' && skip_join())) {
        return;
      }
    }
  }
  /// Skips blanks and line ends.
  void skip_space() {
    for (skip_blanks(); at_ != end_ && (*at_ == '\n' || *at_ == '\r'); skip_blanks()) skip_line_end();
  }
  /// To the beginning of the next line.
  void next_line() {
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r') {
      if (!(joins_lines_ && *at_ == '\\' && skip_join())) ++at_;
    }
    if (at_ != end_) skip_line_end();
  }
  /// What stands before the next blank or line end; empty at the end of the line.
  std::string_view word() {
    skip_blanks();
    const char* from = at_;
    while (at_ != end_ && !is_space(*at_) && !is_join()) ++at_;
    return {from, static_cast<std::size_t>(at_ - from)};
  }
  /// What is left of the line, without blanks around it.
  std::string_view rest() {
    skip_blanks();
    const char* from = at_;
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
    const char* to = at_;
    while (to != from && (to[-1] == ' ' || to[-1] == '\t')) --to;
    return {from, static_cast<std::size_t>(to - from)};
  }
  /// Whether a blank, a line end or nothing comes next.
  bool at_word_end() const { return at_ == end_ || is_space(*at_) || is_join(); }
  /// Skips `c` if it comes next.
  bool skip(char c) {
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }
  /// A number after blanks. Numbers too small for the type are 0, too large ones infinite.
  template <class T>
  bool number(T& value) {
    skip_blanks();
    const char* from = at_ != end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto [to, error] = std::from_chars(from, end_, value);
    if (error == std::errc::invalid_argument) return false;
    if (error == std::errc::result_out_of_range) {
      if constexpr (std::is_integral_v<T>) return false;
      value = is_tiny(from, to) ? T(0) : std::numeric_limits<T>::infinity();
    }
    at_ = to;
    return true;
  }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  /// Of a number out of range: whether it is too small rather than too large.
  static bool is_tiny(const char* from, const char* to) {
    for (const char* c = from; c != to; ++c) {
      if (*c == 'e' || *c == 'E') return c + 1 != to && c[1] == '-';
    }
    while (from != to && (*from == '-' || *from == '0')) ++from;
    return from != to && *from == '.';
  }
  bool is_join() const {
    return joins_lines_ && *at_ == '\\' && (at_ + 1 == end_ || at_[1] == '\n' || at_[1] == '\r');
  }
  bool skip_join() {
    if (!is_join()) return false;
    ++at_;
    if (at_ != end_) skip_line_end();
    return true;
  }
  void skip_line_end() {
    if (*at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') ++at_;
    ++at_;
    ++line_;
  }

  const char* at_;
  const char* begin_;
  const char* end_;
  std::size_t line_ = 1;
  bool joins_lines_;
};

}  // namespace fovea
