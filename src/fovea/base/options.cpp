#include "fovea/base/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <utility>

#include "fovea/base/error.h"

namespace fovea {

namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

/// What an option takes: "whole numbers 1..16".
std::string allowed_text(const Option& option) {
  const bool whole = std::holds_alternative<std::int64_t*>(option.value) ||
                     std::holds_alternative<std::optional<std::int64_t>*>(option.value);
  const std::string range = option.range_text();
  return whole ? "whole numbers" + (range.empty() ? "" : " " + range) : range;
}

[[noreturn]] void bad_value(const Option& option, const std::string& text) {
  const std::string allowed = allowed_text(option);
  std::string hint = allowed.empty() ? "" : "allowed: " + allowed;
  if (const auto* named = std::get_if<Option::Choice>(&option.value)) {
    const std::vector<std::string> near = nearest_names(text, named->names);
    if (!near.empty()) hint = fmt::format("did you mean {}? {}", near.front(), hint);
  }
  throw Error(ErrorKind::usage, fmt::format("'{}' is not a value for it", text),
              fmt::format("--{}", option.name), hint);
}

template <class Number>
Number parse_number(const Option& option, const std::string& text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end) bad_value(option, text);
  return number;
}

void check_range(const Option& option, double number) {
  if (!(std::isfinite(number) && number >= option.low && number <= option.high))
    bad_value(option, fmt::format("{}", number));
}

}  // namespace

std::string Option::range_text() const {
  if (const auto* c = std::get_if<Choice>(&value)) return fmt::format("{}", fmt::join(c->names, "|"));
  const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
  if (has_low && has_high) return fmt::format("{}..{}", low, high);
  if (has_low) return fmt::format(">= {}", low);
  if (has_high) return fmt::format("<= {}", high);
  return {};
}

std::string Option::value_text() const {
  return std::visit(
      Overloaded{[](const bool* v) { return std::string(*v ? "true" : "false"); },
                 [](const std::string* v) { return *v; },
                 [](const std::vector<std::string>* v) { return fmt::format("{}", fmt::join(*v, " ")); },
                 [](const Choice& c) { return c.names.at(static_cast<std::size_t>(c.get())); },
                 [](const auto* v) {
                   if constexpr (requires { v->has_value(); }) {
                     return v->has_value() ? fmt::format("{}", **v) : std::string("none");
                   } else {
                     return fmt::format("{}", *v);
                   }
                 }},
      value);
}

void Option::parse(const std::string& text) {
  std::visit(
      Overloaded{[&](bool* v) {
                   if (text != "true" && text != "false") bad_value(*this, text);
                   *v = text == "true";
                 },
                 [&](std::string* v) { *v = text; }, [&](std::vector<std::string>* v) { v->push_back(text); },
                 [&](Choice& c) {
                   const auto at = std::find(c.names.begin(), c.names.end(), text);
                   if (at == c.names.end()) bad_value(*this, text);
                   c.set(static_cast<int>(at - c.names.begin()));
                 },
                 [&](auto* v) {
                   using T = std::decay_t<decltype(*v)>;
                   if constexpr (requires { typename T::value_type; }) {
                     *v = parse_number<typename T::value_type>(*this, text);
                   } else {
                     *v = parse_number<T>(*this, text);
                   }
                 }},
      value);
  check();
}

void Option::check() const {
  // The pointers are taken as they are stored: any conversion would lose against `const auto&`.
  std::visit(Overloaded{[&](std::int64_t* v) { check_range(*this, static_cast<double>(*v)); },
                        [&](double* v) { check_range(*this, *v); },
                        [&](std::optional<std::int64_t>* v) {
                          if (v->has_value()) check_range(*this, static_cast<double>(**v));
                        },
                        [&](std::optional<double>* v) {
                          if (v->has_value()) check_range(*this, **v);
                        },
                        [](const auto&) {}},
             value);
}

void check(const OptionList& options) {
  std::string faults, hint;
  for (const Option& option : options) {
    try {
      option.check();
    } catch (const Error& e) {
      faults += (faults.empty() ? "" : "; ") + std::string(e.what());
      hint += (hint.empty() ? "" : "; ") + fmt::format("--{} {}", option.name, e.hint());
    }
  }
  if (!faults.empty()) throw Error(ErrorKind::usage, faults, {}, hint);
}

std::vector<std::string> nearest_names(const std::string& name, const std::vector<std::string>& candidates,
                                       int count) {
  // Neighbours that changed places count once.
  const auto edit_distance = [&](const std::string& other) {
    std::vector<std::size_t> before, last, row(other.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= name.size(); ++i) {
      before = std::exchange(last, row);
      row[0] = i;
      for (std::size_t j = 1; j <= other.size(); ++j) {
        row[j] = std::min({last[j - 1] + (name[i - 1] != other[j - 1]), last[j] + 1, row[j - 1] + 1});
        if (i > 1 && j > 1 && name[i - 1] == other[j - 2] && name[i - 2] == other[j - 1])
          row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    return row.back();
  };
  std::vector<std::pair<std::size_t, std::string>> ranked;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(candidate);
    if (3 * distance <= std::max(candidate.size(), name.size())) ranked.emplace_back(distance, candidate);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> result;
  for (const auto& [distance, candidate] : ranked) {
    if (static_cast<int>(result.size()) == count) break;
    result.push_back(candidate);
  }
  return result;
}

}  // namespace fovea
