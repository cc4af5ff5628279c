#include "arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

/// "quantize" of "--no-quantize=true".
std::string bare(const std::string& flag) {
  const std::size_t begin = flag.find_first_not_of('-'), end = flag.find('=');
  const std::string name = begin < end ? flag.substr(begin, end - begin) : "";
  return name.starts_with("no-") ? name.substr(3) : name;
}

}  // namespace

std::string short_flag(const std::string& option) {
  static const std::map<std::string, std::string> kFlags{{"output", "-o"}, {"verbose", "-v"}, {"help", "-h"}};
  const auto at = kFlags.find(option);
  return at == kFlags.end() ? std::string() : at->second;
}

void Arguments::add(Positional positional) { positionals_.push_back(std::move(positional)); }

void Arguments::add(const std::string& title, OptionList options) {
  for (const Option& option : options) {
    if (has(option.name)) {
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

std::vector<std::string> Arguments::names() const {
  std::vector<std::string> names{"help", "version"};
  for (const OptionGroup& group : groups_) {
    for (const Option& option : group.options) names.push_back(option.name);
  }
  return names;
}

bool Arguments::has(const std::string& option) const {
  const std::vector<std::string> known = names();
  return std::find(known.begin(), known.end(), option) != known.end();
}

void Arguments::refuse(const std::string& word, const std::string& verb, const OptionOwners& owners) const {
  if (word.size() < 2 || word[0] != '-') {
    throw Error(ErrorKind::usage, fmt::format("'{}' is one argument too many", word), {}, help_hint(verb));
  }
  const std::string name = word.substr(0, word.find('='));
  const std::vector<std::string> others = owners(bare(name)), near = nearest_names(bare(name), names());
  throw Error(ErrorKind::usage, fmt::format("unknown option '{}'", name), {},
              !others.empty() ? fmt::format("--{} is an option of {}", bare(name), fmt::join(others, ", "))
              : near.empty()  ? help_hint(verb)
                              : fmt::format("did you mean --{}?", near.front()));
}

void Arguments::set(Option& option, const std::string& text) {
  given_.insert(option.name);
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

void Arguments::check_positionals(const std::string& verb) const {
  const auto is_empty = [](const std::string& text) { return text.empty(); };
  for (const Positional& p : positionals_) {
    const bool missing = p.values != nullptr
                             ? p.values->empty() || std::any_of(p.values->begin(), p.values->end(), is_empty)
                             : p.value->empty();
    if (p.required && missing)
      throw Error(ErrorKind::usage, fmt::format("{} is missing", p.name), {}, help_hint(verb));
  }
}

void Arguments::check_needs() const {
  for (const Need& need : needs_) {
    for (const std::string& option : need.options) {
      if (given_.contains(option) && !need.holds()) {
        throw Error(ErrorKind::usage, fmt::format("--{} needs {}", option, need.other), {}, need.hint);
      }
    }
  }
}

void Arguments::parse(const std::vector<std::string>& words, const std::string& verb,
                      const OptionOwners& owners) {
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  for (OptionGroup& group : groups_) {
    for (Option& option : group.options) {
      const std::string shorter = short_flag(option.name);
      const std::string names = (shorter.empty() ? "" : shorter + ",") + "--" + option.name;
      if (option.is_flag()) {
        // CLI11 counts a flag up for --name and down for --no-name and --name=false.
        const auto count_up = [&](std::int64_t count) { set(option, count > 0 ? "true" : "false"); };
        app.add_flag_function(names + ",!--no-" + option.name, count_up, option.help);
      } else if (option.is_list()) {
        const auto add = [&](const std::vector<std::string>& texts) {
          for (const std::string& text : texts) set(option, text);
        };
        app.add_option_function<std::vector<std::string>>(names, add)
            ->expected(1)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
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
  if (!rest.empty()) refuse(flag != rest.end() ? *flag : rest.front(), verb, owners);
  check_positionals(verb);
  check_needs();
}

}  // namespace fovea::cli
