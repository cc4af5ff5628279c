#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace fovea {

/// One option as data: the single source of its command-line flag, its check, its Python keyword
/// and its row in the documentation. `value` points into the options struct that was described.
struct Option {
  /// A choice among named values, seen through an integer (the enum's value = index in `names`).
  struct Choice {
    std::vector<std::string> names;
    std::function<int()> get;
    std::function<void(int)> set;
    std::string alone{};  ///< The name meant by the flag without a value; empty if it needs one.
  };
  /// A list gets one more with every text that is parsed.
  using Value = std::variant<bool*, std::int64_t*, double*, std::string*, std::optional<std::int64_t>*,
                             std::optional<double>*, std::vector<std::string>*, Choice>;

  std::string name;  ///< Kebab case without dashes in front: "uv-weight".
  std::string help;  ///< One sentence: meaning and the reason of the default.
  Value value;
  std::string unit;  ///< "triangles", "of the diagonal"; empty if it has none.
  double low = -std::numeric_limits<double>::infinity();  ///< Smallest allowed number.
  double high = std::numeric_limits<double>::infinity();  ///< Largest allowed number.

  /// "0..1", ">= 0", "quadric|entropy", or empty when anything goes.
  std::string range_text() const;
  /// The present value as text; "none" for an empty optional.
  std::string value_text() const;
  bool is_list() const { return std::holds_alternative<std::vector<std::string>*>(value); }
  /// Sets the value from text. Throws Error(usage) naming the option, the text and the range.
  void parse(const std::string& text);
  /// Throws Error(usage) if the present value is outside the range.
  void check() const;
  bool is_flag() const { return std::holds_alternative<bool*>(value); }
};

/// The options of one struct, in the order in which `--help` shows them.
using OptionList = std::vector<Option>;

/// Makes a Choice for an enum whose values count up from 0 in the order of `names`. `alone` is the name meant
/// by the flag without a value, if it may be without.
template <class Enum>
Option::Choice choice(Enum& target, std::vector<std::string> names, std::string alone = {}) {
  return {std::move(names), [&target] { return static_cast<int>(target); },
          [&target](int index) { target = static_cast<Enum>(index); }, std::move(alone)};
}

/// Checks every option; one Error(usage) lists all faults, a line each.
void check(const OptionList& options);

/// Those of `candidates` nearest to `name` by edit distance, best first; at most `count`, and none
/// that differs in more than a third of its letters. For "unknown option" messages.
std::vector<std::string> nearest_names(const std::string& name, const std::vector<std::string>& candidates,
                                       int count = 1);

}  // namespace fovea
