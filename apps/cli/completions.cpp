#include "completions.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "fovea/base/error.h"
#include "help.h"
#include "verb.h"

namespace fovea::cli {

namespace {

/// An option as a shell sees it.
struct Word {
  std::string name;  ///< "--ratio"
  std::string help;  ///< Its first sentence.
  bool has_value = false;
  std::vector<std::string> choices;  ///< Of its values; empty where files or anything may follow.
};

struct VerbWords {
  VerbText text;
  std::vector<Word> options;
};

std::string first_sentence(const std::string& help) {
  const std::size_t end = help.find_first_of(".:;");
  return help.substr(0, end);
}

Word word_of(const Option& option, const std::string& default_text) {
  Word word{(is_taken_back(option, default_text) ? "--no-" : "--") + option.name,
            first_sentence(meaning(option, default_text)),
            !option.is_flag(),
            {}};
  if (const auto* named = std::get_if<Option::Choice>(&option.value)) {
    word.choices = named->names;
    word.has_value = named->alone.empty();
  }
  return word;
}

std::vector<VerbWords> all_words() {
  std::vector<VerbWords> all;
  for (const auto& verb : make_verbs()) {
    CommonOptions common;
    Arguments arguments;
    verb->declare(arguments);
    arguments.add("Common", describe(common));
    VerbWords& words = all.emplace_back(VerbWords{verb->text(), {}});
    for (const OptionGroup& group : arguments.groups()) {
      for (std::size_t i = 0; i < group.options.size(); ++i)
        words.options.push_back(word_of(group.options[i], group.defaults[i]));
    }
    words.options.push_back({"--help", "Show options and examples", false, {}});
  }
  return all;
}

/// Within single quotes; `also` are characters that a shell reads there all the same.
std::string quoted(const std::string& text, std::string_view also = {}) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      if (also.find(c) != std::string_view::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

std::string bash(const std::vector<VerbWords>& all) {
  std::string verbs, values, options;
  for (const VerbWords& verb : all) {
    verbs += verb.text.name + " ";
    std::string names;
    for (const Word& word : verb.options) {
      names += word.name + " ";
      if (!word.choices.empty())
        values += fmt::format("    '{} {}') words='{}' ;;\n", verb.text.name, word.name,
                              fmt::join(word.choices, " "));
    }
    options += fmt::format("    {}) words='{}' ;;\n", verb.text.name, names);
  }
  return fmt::format(
      "# bash completion of fovea: eval \"$(fovea --completions=bash)\"\n"
      "_fovea() {{\n"
      "  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}} words=\n"
      "  if [ \"$COMP_CWORD\" = 1 ]; then\n"
      "    COMPREPLY=($(compgen -W '{}--help --version' -- \"$cur\"))\n"
      "    return\n"
      "  fi\n"
      "  case \"${{COMP_WORDS[1]}} $prev\" in\n{}  esac\n"
      "  if [ -z \"$words\" ] && [ \"${{cur#-}}\" = \"$cur\" ]; then\n"
      "    COMPREPLY=($(compgen -f -- \"$cur\"))\n"
      "    return\n"
      "  fi\n"
      "  [ -n \"$words\" ] || case \"${{COMP_WORDS[1]}}\" in\n{}  esac\n"
      "  COMPREPLY=($(compgen -W \"$words\" -- \"$cur\"))\n"
      "}}\n"
      "complete -o filenames -F _fovea fovea\n",
      verbs, values, options);
}

std::string zsh(const std::vector<VerbWords>& all) {
  std::string verbs, cases;
  for (const VerbWords& verb : all) {
    verbs += fmt::format("    '{}:{}'\n", verb.text.name, quoted(verb.text.summary, ":"));
    cases += fmt::format("    {})\n      _arguments -s", verb.text.name);
    for (const Word& word : verb.options) {
      std::string value;
      if (word.has_value)
        value =
            word.choices.empty() ? ":value:_files" : fmt::format(":value:({})", fmt::join(word.choices, " "));
      cases += fmt::format(" \\\n        '{}[{}]{}'", word.name, quoted(word.help, "[]:\\"), value);
    }
    cases += " \\\n        '*:file:_files'\n      ;;\n";
  }
  return fmt::format(
      "#compdef fovea\n"
      "# zsh completion of fovea: eval \"$(fovea --completions=zsh)\"\n"
      "_fovea() {{\n"
      "  local -a verbs=(\n{}  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe verb verbs\n"
      "    return\n"
      "  fi\n"
      "  local verb=$words[2]\n"
      "  shift words\n"
      "  (( CURRENT-- ))\n"
      "  case $verb in\n{}  esac\n"
      "}}\n"
      "compdef _fovea fovea\n",
      verbs, cases);
}

std::string fish(const std::vector<VerbWords>& all) {
  std::string text = "# fish completion of fovea: fovea --completions=fish | source\n";
  for (const VerbWords& verb : all)
    text += fmt::format("complete -c fovea -f -n __fish_use_subcommand -a {} -d '{}'\n", verb.text.name,
                        quoted(verb.text.summary));
  for (const VerbWords& verb : all) {
    for (const Word& word : verb.options) {
      std::string value = word.has_value ? " -r" : "";
      if (!word.choices.empty()) value = fmt::format(" -x -a '{}'", fmt::join(word.choices, " "));
      text += fmt::format("complete -c fovea -n '__fish_seen_subcommand_from {}' -l {}{} -d '{}'\n",
                          verb.text.name, word.name.substr(2), value, quoted(word.help));
    }
  }
  return text;
}

}  // namespace

std::string completions(const std::string& shell) {
  const std::vector<VerbWords> all = all_words();
  if (shell == "bash") return bash(all);
  if (shell == "zsh") return zsh(all);
  if (shell == "fish") return fish(all);
  throw Error(ErrorKind::usage, "there are no completions for this shell", "--completions",
              "write bash, zsh or fish: eval \"$(fovea --completions=bash)\"");
}

}  // namespace fovea::cli
