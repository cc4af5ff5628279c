#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fovea/base/options.h"

namespace fovea::cli {

/// An argument without a flag: its name as help shows it, and where its text goes.
struct Positional {
  std::string name;
  std::string help;
  std::string* value = nullptr;
  bool required = true;
  std::vector<std::string>* values = nullptr;  ///< Instead of `value`: one or more; must be the last.
};

/// Options that do nothing on their own: giving one is an error unless something else holds.
struct Need {
  std::vector<std::string> options;
  std::string other;            ///< What they need: "--animation".
  std::function<bool()> holds;  ///< Asked after parsing.
  std::string hint{};
};

/// The verbs that have an option.
using OptionOwners = std::function<std::vector<std::string>(const std::string& option)>;

/// Options under one heading of `--help`.
struct OptionGroup {
  std::string title;
  OptionList options;
  std::vector<std::string> defaults;  ///< `value_text` of each option before parsing.
};

/// The arguments of one verb: declared once, then parsed, checked, and shown as help, documentation
/// and report. Everything known of an option comes from its `fovea::Option`.
class Arguments {
 public:
  void add(Positional positional);
  /// Adds a heading with options; the options' values must outlive this object. Adding a title again
  /// appends to it. Throws Error(internal) if a flag exists already.
  void add(const std::string& title, OptionList options);
  /// An extra hint for when the value given to an option is refused.
  void add_hint(const std::string& option, std::string hint);

  void need(Need need) { needs_.push_back(std::move(need)); }

  /// Sets all values from the words after the verb. Throws Error(usage) with the nearest name or the verbs
  /// that have it for an unknown flag, with the range for a bad value, for a missing or surplus argument.
  void parse(const std::vector<std::string>& words, const std::string& verb, const OptionOwners& owners);
  bool has(const std::string& option) const;

  const std::vector<Positional>& positionals() const { return positionals_; }
  const std::vector<OptionGroup>& groups() const { return groups_; }

 private:
  std::vector<std::string> names() const;
  /// With the values of flags that stand alone.
  std::vector<std::string> with_values(std::vector<std::string> words) const;
  [[noreturn]] void refuse(const std::string& word, const std::string& verb,
                           const OptionOwners& owners) const;
  void set(Option& option, const std::string& text);
  void check_positionals(const std::string& verb) const;
  void check_needs() const;

  std::vector<Positional> positionals_;
  std::vector<OptionGroup> groups_;
  std::map<std::string, std::string> hints_;
  std::vector<Need> needs_;
  std::set<std::string> given_;  ///< Options that were set.
};

/// "-o" for the option "output", ...; empty for those without a short flag.
std::string short_flag(const std::string& option);

}  // namespace fovea::cli
