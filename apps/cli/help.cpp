#include "help.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "text.h"

namespace fovea::cli {

namespace {

constexpr std::size_t kWidth = 100;
constexpr std::size_t kHelpColumn = 30;

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return c == ' ' ? '_' : static_cast<char>(std::toupper(c)); });
  return text;
}

bool is_text(const Option& option) {
  return std::holds_alternative<std::string*>(option.value) || option.is_list();
}

// The word that stands for an option's value: "N", "X", a choice, or for text the unit ("FILE").
std::string value_name(const Option& option) {
  if (std::holds_alternative<bool*>(option.value)) return {};
  if (is_text(option)) return option.unit.empty() ? "TEXT" : upper(option.unit);
  if (const auto* named = std::get_if<Option::Choice>(&option.value))
    return named->alone.empty() ? option.range_text() : "[" + option.range_text() + "]";
  const bool whole = std::holds_alternative<std::int64_t*>(option.value) ||
                     std::holds_alternative<std::optional<std::int64_t>*>(option.value);
  return whole ? "N" : "X";
}

bool is_optional(const Option& option) {
  return std::holds_alternative<std::optional<std::int64_t>*>(option.value) ||
         std::holds_alternative<std::optional<double>*>(option.value);
}

std::string flag_text(const Option& option, const std::string& default_text) {
  const std::string shorter = short_flag(option.name);
  const std::string negation = is_taken_back(option, default_text) ? "no-" : "";
  const std::string value = value_name(option);
  return (shorter.empty() ? "" : shorter + ", ") + "--" + negation + option.name +
         (value.empty() ? "" : " " + value);
}

// "0..1, of the diagonal, default 0.5": what the flag itself does not show.
std::string details(const Option& option, const std::string& default_text) {
  std::vector<std::string> parts;
  const bool shown = option.is_flag() || std::holds_alternative<Option::Choice>(option.value);
  if (!shown && !option.range_text().empty()) {
    parts.push_back(option.range_text());
  }
  if (!is_text(option) && !option.unit.empty()) parts.push_back(option.unit);
  if (!option.is_flag() && !default_text.empty() && !is_optional(option)) {
    parts.push_back("default " + default_text);
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

// A choice of more values than a line holds goes on in the next.
std::string break_choice(std::string text) {
  const std::string next = "\n      ";
  for (std::size_t begin = 0; text.size() - begin > kWidth;) {
    const std::size_t bar = text.rfind('|', begin + kWidth - 1);
    if (bar == std::string::npos || bar <= begin) break;
    text.insert(bar + 1, next);
    begin = bar + 2;
  }
  return text;
}

std::string entry(const std::string& left, const std::string& help) {
  const std::string start = break_choice("  " + left);
  // A long flag gets a line of its own.
  const std::string gap = start.size() + 2 > kHelpColumn ? "\n" + std::string(kHelpColumn, ' ')
                                                         : std::string(kHelpColumn - start.size(), ' ');
  return start + gap + wrap(help, kWidth, kHelpColumn) + "\n";
}

std::string usage_line(const Verb& verb, const Arguments& arguments) {
  std::string line = "fovea " + verb.text().name;
  for (const Positional& p : arguments.positionals())
    line += (p.required ? " " + p.name : " [" + p.name + "]") + (p.values != nullptr ? "..." : "");
  for (const OptionGroup& group : arguments.groups()) {
    for (const Option& option : group.options) {
      if (option.name == "output") line += " -o " + value_name(option);
    }
  }
  return line + " [options]";
}

// The arguments of a verb together with those that all verbs share.
Arguments declared(Verb& verb, CommonOptions& common) {
  Arguments arguments;
  verb.declare(arguments);
  arguments.add("Common", describe(common));
  return arguments;
}

std::string table_cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

std::string markdown(Verb& verb) {
  CommonOptions common;
  const Arguments arguments = declared(verb, common);
  std::string text = fmt::format("## {}\n\n`{}`\n", verb.text().name, usage_line(verb, arguments));
  for (const OptionGroup& group : arguments.groups()) {
    if (group.title == "Common") continue;
    text +=
        fmt::format("\n### {}\n\n| option | range, unit, default | meaning |\n|---|---|---|\n", group.title);
    for (std::size_t i = 0; i < group.options.size(); ++i) {
      const Option& option = group.options[i];
      text += fmt::format("| `{}` | {} | {} |\n", table_cell(flag_text(option, group.defaults[i])),
                          table_cell(details(option, group.defaults[i])),
                          table_cell(meaning(option, group.defaults[i])));
    }
  }
  return text;
}

}  // namespace

bool is_taken_back(const Option& option, const std::string& default_text) {
  return option.is_flag() && default_text == "true";
}

std::string meaning(const Option& option, const std::string& default_text) {
  if (!is_taken_back(option, default_text)) return option.help;
  std::string text = option.help;
  text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return "Do not " + text;
}

std::string main_help() {
  std::string text = "fovea " FOVEA_VERSION
                     " - perceptual simplification of textured 3D models\n\n"
                     "Usage: fovea VERB INPUT... [-o OUTPUT] [options]\n\nVerbs\n";
  for (const auto& verb : make_verbs()) text += entry(verb->text().name, verb->text().summary);
  text += "\nOptions\n";
  text += entry("-h, --help", "Show this, or after a verb the verb's options and examples.");
  text += entry("--version", "Show the version.");
  text += entry("--completions=SHELL", "What bash, zsh or fish needs to complete verbs and options.");
  text += "\nExamples\n";
  for (const auto& verb : make_verbs()) text += "  " + verb->text().examples.front().command + "\n";
  text +=
      "\nExit codes\n"
      "  0 done   1 a fault of Fovea   2 usage   3 file not found   4 damaged file   5 unsupported\n"
      "  6 over a limit   7 cannot write   8 target not reached   130 cancelled\n";
  return text;
}

std::string verb_help(Verb& verb) {
  CommonOptions common;
  const Arguments arguments = declared(verb, common);
  const VerbText words = verb.text();
  std::string text = fmt::format("fovea {} - {}\n\nUsage: {}\n\n{}\n", words.name, words.summary,
                                 usage_line(verb, arguments), wrap(words.description, kWidth, 0));
  if (!arguments.positionals().empty()) text += "\n";
  for (const Positional& p : arguments.positionals()) text += entry(p.name, p.help);
  for (const OptionGroup& group : arguments.groups()) {
    text += "\n" + group.title + "\n";
    for (std::size_t i = 0; i < group.options.size(); ++i) {
      const std::string more = details(group.options[i], group.defaults[i]);
      text += entry(flag_text(group.options[i], group.defaults[i]),
                    meaning(group.options[i], group.defaults[i]) + (more.empty() ? "" : " [" + more + "]"));
    }
  }
  text += entry("-h, --help", "Show this.");
  text += "\nExamples\n";
  for (const Example& example : words.examples) {
    text += "  " + example.command + "\n      " + wrap(example.meaning, kWidth, 6) + "\n";
  }
  return text;
}

std::string options_markdown() {
  std::string text = "# Options\n\nMade by `fovea --help=markdown`; a test compares it with the program.\n\n";
  for (const auto& verb : make_verbs()) text += markdown(*verb) + "\n";
  CommonOptions common;
  text += "## All verbs\n\n| option | range, unit, default | meaning |\n|---|---|---|\n";
  for (const Option& option : describe(common)) {
    text += fmt::format("| `{}` | {} | {} |\n", table_cell(flag_text(option, option.value_text())),
                        table_cell(details(option, option.value_text())), table_cell(option.help));
  }
  return text;
}

}  // namespace fovea::cli
