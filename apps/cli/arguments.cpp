#include "arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "fovea/base/error.h"

namespace fovea::cli {

namespace {

std::string help_hint(const std::string& verb) { return fmt::format("see: fovea {} --help", verb); }

// What may follow an option whose value can be left out: names of choices have no dots or slashes, files do.
bool looks_like_choice(const std::string& word) {
  return !word.empty() && word[0] != '-' && word.find_first_of("./\\") == std::string::npos;
}

// CLI11 counts a flag up for --name and down for --no-name and --name=false.
void add_flag(CLI::App& app, Option& option, const std::string& names) {
  bool* value = std::get<bool*>(option.value);
  app.add_flag_function(
      names + ",!--no-" + option.name, [value](std::int64_t count) { *value = count > 0; }, option.help);
}

}  // namespace

std::string short_flag(const std::string& option) {
  static const std::map<std::string, std::string> kFlags{{"output", "-o"}, {"verbose", "-v"}, {"help", "-h"}};
  const auto at = kFlags.find(option);
  return at == kFlags.end() ? std::string() : at->second;
}

void Arguments::add(Positional positional) { positionals_.push_back(std::move(positional)); }

void Arguments::add(const std::string& title, OptionList options) {
  const std::vector<std::string> known = flags();
  for (const Option& option : options) {
    if (std::find(known.begin(), known.end(), "--" + option.name) != known.end()) {
      throw Error(ErrorKind::internal, "option declared twice", "--" + option.name);
    }
  }
  auto group = std::find_if(groups_.begin(), groups_.end(), [&](const auto& g) { return g.title == title; });
  if (group == groups_.end()) group = groups_.insert(groups_.end(), OptionGroup{title, {}, {}});
  for (Option& option : options) {
    group->defaults.push_back(option.value_text());
    group->options.push_back(std::move(option));
  }
}

void Arguments::add_hint(const std::string& option, std::string hint) { hints_[option] = std::move(hint); }

std::vector<std::string> Arguments::flags() const {
  std::vector<std::string> names{"--help", "--version"};
  for (const OptionGroup& group : groups_) {
    for (const Option& option : group.options) names.push_back("--" + option.name);
  }
  return names;
}

void Arguments::refuse(const std::string& word, const std::string& verb) const {
  if (word.size() < 2 || word[0] != '-') {
    throw Error(ErrorKind::usage, fmt::format("'{}' is one argument too many", word), {}, help_hint(verb));
  }
  const std::string name = word.substr(0, word.find('='));
  const std::vector<std::string> near = nearest_names(name, flags());
  throw Error(ErrorKind::usage, fmt::format("unknown option '{}'", name), {},
              near.empty() ? help_hint(verb) : fmt::format("did you mean {}?", near.front()));
}

void Arguments::set(Option& option, const std::string& text) const {
  try {
    option.parse(text);
  } catch (const Error& error) {
    const auto extra = hints_.find(option.name);
    if (extra == hints_.end()) throw;
    throw Error(error.kind(), error.message(), error.place(),
                error.hint().empty() ? extra->second : error.hint() + "; " + extra->second);
  }
}

std::vector<std::string> Arguments::with_values(std::vector<std::string> words) const {
  for (const OptionGroup& group : groups_) {
    for (const Option& option : group.options) {
      const auto* named = std::get_if<Option::Choice>(&option.value);
      if (named == nullptr || named->alone.empty()) continue;
      for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] != "--" + option.name) continue;
        if (i + 1 == words.size() || !looks_like_choice(words[i + 1])) words[i] += "=" + named->alone;
      }
    }
  }
  return words;
}

void Arguments::parse(const std::vector<std::string>& words, const std::string& verb) {
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  for (OptionGroup& group : groups_) {
    for (Option& option : group.options) {
      const std::string shorter = short_flag(option.name);
      const std::string names = (shorter.empty() ? "" : shorter + ",") + "--" + option.name;
      if (option.is_flag()) {
        add_flag(app, option, names);
      } else {
        app.add_option_function<std::string>(names, [&](const std::string& text) { set(option, text); })
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
      }
    }
  }
  for (const Positional& positional : positionals_) {
    if (positional.values != nullptr) {
      app.add_option(positional.name, *positional.values);
    } else {
      app.add_option(positional.name, *positional.value);
    }
  }
  try {
    std::vector<std::string> reversed = with_values(words);
    std::reverse(reversed.begin(), reversed.end());
    app.parse(std::move(reversed));
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string text = error.what();
    throw Error(ErrorKind::usage, "needs a value", text.substr(0, text.find(':')), help_hint(verb));
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorKind::usage, error.what(), {}, help_hint(verb));
  } catch (const std::logic_error&) {
    // CLI11 lets the standard library's own exceptions through for --flag=VALUE.
    throw Error(ErrorKind::usage, "a flag can only be true or false", {}, help_hint(verb));
  }
  // An unknown flag's value looks like a surplus argument: the flag is the fault to name.
  const std::vector<std::string> rest = app.remaining();
  const auto flag =
      std::find_if(rest.begin(), rest.end(), [](const auto& w) { return w.size() > 1 && w[0] == '-'; });
  if (!rest.empty()) refuse(flag != rest.end() ? *flag : rest.front(), verb);
  for (const Positional& positional : positionals_) {
    if (positional.required &&
        (positional.values != nullptr ? positional.values->empty() : positional.value->empty())) {
      throw Error(ErrorKind::usage, fmt::format("{} is missing", positional.name), {}, help_hint(verb));
    }
  }
}

}  // namespace fovea::cli
