#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "run_command.h"

namespace fovea::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Help, NamesAllVerbs) {
  const Outcome help = fovea({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.err, IsEmpty());
  for (const char* verb :
       {"info", "simplify", "lods", "saliency", "segment", "fly", "fit", "compare", "render", "sample"})
    EXPECT_THAT(help.out, HasSubstr(verb));
  EXPECT_EQ(fovea({"-h"}).out, help.out);
}

TEST(Help, TheCommandLinesPageHasAllVerbs) {
  const std::string page = read_text(FOVEA_COMMAND_PAGE);
  for (const char* verb :
       {"info", "simplify", "lods", "saliency", "segment", "fly", "fit", "compare", "render", "sample"})
    EXPECT_THAT(page, HasSubstr("| `" + std::string(verb) + "` | "));
}

TEST(Help, WithoutArgumentsIsAUsageErrorThatHelps) {
  const Outcome nothing = fovea({});
  EXPECT_EQ(nothing.code, 2);
  EXPECT_THAT(nothing.out, IsEmpty());
  EXPECT_THAT(nothing.err, HasSubstr("Usage:"));
}

TEST(Help, VersionIsThatOfTheProject) { EXPECT_EQ(fovea({"--version"}).out, "fovea " FOVEA_VERSION "\n"); }

TEST(Help, EveryVerbHasUsageOptionsAndExamples) {
  for (const std::string verb :
       {"info", "simplify", "lods", "saliency", "segment", "fly", "fit", "compare", "render", "sample"}) {
    const Outcome help = fovea({verb, "--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_THAT(help.out, HasSubstr("Usage: fovea " + verb));
    EXPECT_THAT(help.out, HasSubstr("Examples\n  fovea " + verb));
    for (const char* flag : {"--json", "--quiet", "--threads", "--seed"})
      EXPECT_THAT(help.out, HasSubstr(flag));
    EXPECT_EQ(fovea({"help", verb}).out, help.out);
    EXPECT_EQ(fovea({verb, "missing.glb", "-h"}).out, help.out) << "help wins over all that is wrong";
  }
}

TEST(Help, OptionsShowRangeUnitAndDefault) {
  const std::string help = fovea({"simplify", "--help"}).out;
  EXPECT_THAT(help, HasSubstr("--ratio X"));
  EXPECT_THAT(help, HasSubstr("[0..1"));
  EXPECT_THAT(help, HasSubstr("[1..16"));
  EXPECT_THAT(help, HasSubstr("default 14]"));
  EXPECT_THAT(help, HasSubstr("--compression none|meshopt"));
}

TEST(Help, LinesFitATerminal) {
  for (const std::string verb :
       {"info", "simplify", "lods", "saliency", "segment", "fly", "fit", "compare", "render", "sample"}) {
    std::istringstream lines(fovea({verb, "--help"}).out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  }
}

// script/format does not make this page; `fovea --help=markdown > docs/options.md` does.
TEST(Help, OptionsPageIsThatOfTheProgram) {
  const Outcome page = fovea({"--help=markdown"});
  EXPECT_EQ(page.code, 0);
  EXPECT_EQ(page.out, read_text(FOVEA_OPTIONS_PAGE)) << "run: fovea --help=markdown > docs/options.md";
}

TEST(Suggestions, UnknownVerb) {
  const Outcome typo = fovea({"simplfy", "a.glb"});
  EXPECT_EQ(typo.code, 2);
  EXPECT_EQ(typo.err, "fovea: error: unknown verb 'simplfy'\nhint: did you mean simplify?\n");
}

TEST(Suggestions, NothingNearListsTheVerbs) {
  EXPECT_THAT(fovea({"qqqqqqqqqq"}).err, HasSubstr("verbs are: info, simplify, lods, focus, fit, texture, "
                                                   "saliency, segment, fly, compare, render, sample"));
}

TEST(Suggestions, FlagBeforeTheVerb) {
  const Outcome early = fovea({"--json", "info", "a.glb"});
  EXPECT_EQ(early.code, 2);
  EXPECT_THAT(early.err, HasSubstr("a verb comes first"));
}

TEST(Suggestions, UnknownFlag) {
  for (const char* typo : {"--ratoi", "--ratoi=0.5"}) {
    const Outcome outcome = fovea({"simplify", "a.glb", "-o", "b.glb", typo, "0.5"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, "fovea: error: unknown option '--ratoi'\nhint: did you mean --ratio?\n");
  }
}

TEST(Suggestions, AnOptionOfOtherVerbs) {
  for (const char* option : {"--quantize", "--no-quantize"}) {
    EXPECT_EQ(fovea({"info", "a.glb", option}).err,
              "fovea: error: unknown option '" + std::string(option) +
                  "'\nhint: --quantize is an option of simplify, lods, focus, fit, texture, sample\n");
  }
}

TEST(Suggestions, OnlyWhatIsNear) {
  EXPECT_EQ(fovea({"info", "a.glb", "--sizes"}).err,
            "fovea: error: unknown option '--sizes'\nhint: see: fovea info --help\n");
}

TEST(Suggestions, OfChoices) {
  EXPECT_THAT(fovea({"render", "a.glb", "--views", "orbits"}).err, HasSubstr("did you mean orbit?"));
}

TEST(Suggestions, NoneThatLeadsNowhere) {
  EXPECT_EQ(fovea({"info", "--version"}).out, "fovea " FOVEA_VERSION "\n");
  const Outcome markdown = fovea({"info", "--help=markdown"});
  EXPECT_EQ(markdown.code, 2);
  EXPECT_THAT(markdown.err, HasSubstr("write: fovea --help=markdown"));
}

// Options that would do nothing are not taken silently, whatever their value.
TEST(Usage, OptionsThatNeedOthers) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"--position-bits", "14"}, "--position-bits needs --quantize"},
      {{"--metric", "quadric", "--image-pass", "lit"}, "--image-pass needs --metric image"},
      {{"--metric", "visibility", "--even-exposure"}, "--even-exposure needs --metric image"},
      {{"--metric", "visibility", "--metric-from", "2"}, "--metric-from needs --metric image"},
      {{"--metric", "quadric", "--views", "cube"}, "--views needs a --metric by views"},
      {{"--region-k", "9"}, "--region-k needs --metric entropy"},
      {{"--key-poses", "4"}, "--key-poses needs --saliency"},
      {{"--view-count", "4"}, "--view-count needs --views fibonacci, orbit or cameras"}};
  for (const auto& [more, message] : cases) {
    std::vector<std::string> words{"simplify", "a.glb", "-o", "b.glb", "--ratio", "0.1"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = fovea(words);
    EXPECT_EQ(outcome.code, 2) << message;
    EXPECT_THAT(outcome.err, HasSubstr("error: " + std::string(message)));
  }
  EXPECT_THAT(fovea({"simplify", "a.glb", "-o", "b.glb", "--ratio", "0.1", "--metric", "quadric",
                     "--cull-hidden", "--views", "cube"})
                  .err,
              HasSubstr("no such file"));
}

TEST(Usage, RatioIsNotAPercentage) {
  const Outcome outcome = fovea({"simplify", "a.glb", "-o", "b.glb", "--ratio", "10"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--ratio"));
  EXPECT_THAT(outcome.err, HasSubstr("0.1 keeps 10 %"));
}

TEST(Usage, ValuesAreChecked) {
  const std::vector<std::vector<std::string>> wrong{
      {"--ratio", "ten"},        {"--ratio", "nan"},     {"--error", "inf"},
      {"--triangles", "-5"},     {"--triangles", "1e3"}, {"--ratio"},
      {"--position-bits", "17"}, {"--placement", "any"}, {"--quantize=perhaps"},
      {"--threads", "100000"},   {"--seed", ""},
  };
  for (std::vector<std::string> words : wrong) {
    words.insert(words.begin(), {"simplify", "a.glb", "-o", "b.glb"});
    const Outcome outcome = fovea(words);
    EXPECT_EQ(outcome.code, 2) << words[4];
    EXPECT_THAT(outcome.err, HasSubstr("fovea: error: ")) << words[4];
  }
}

TEST(Usage, MissingAndSurplusArguments) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"info"}, {"info", ""}, {"saliency", ""}, {"saliency", "a.glb", ""}})
    EXPECT_THAT(fovea(words).err, HasSubstr("MODEL is missing"));
  EXPECT_THAT(fovea({"info", "a.glb", "b.glb"}).err, HasSubstr("'b.glb' is one argument too many"));
  EXPECT_EQ(fovea({"info", "a.glb", "b.glb"}).code, 2);
}

/// What bash offers after these words, of which the last is being typed.
std::vector<std::string> completed(const std::vector<std::string>& words) {
  std::string script = "eval \"$(" + std::string(FOVEA_PROGRAM) + " --completions=bash)\"; COMP_WORDS=(fovea";
  for (const std::string& word : words) script += " '" + word + "'";
  script += "); COMP_CWORD=" + std::to_string(words.size()) + "; _fovea; printf '%s\\n' \"${COMPREPLY[@]}\"";
  const Folder folder;
  const std::string command = "bash " + folder.write("complete.sh", script);
  std::vector<std::string> offered(1);
  FILE* const out = popen(command.c_str(), "r");
  for (int c; (c = std::fgetc(out)) != EOF;) {
    if (c == '\n') {
      offered.emplace_back();
    } else {
      offered.back() += static_cast<char>(c);
    }
  }
  pclose(out);
  offered.pop_back();
  return offered;
}

TEST(Completions, BashOffersVerbsOptionsAndChoices) {
  EXPECT_THAT(completed({"si"}), ElementsAre("simplify"));
  EXPECT_THAT(completed({""}), Contains("fit"));
  EXPECT_THAT(completed({"simplify", "m.glb", "--rat"}), ElementsAre("--ratio"));
  EXPECT_THAT(completed({"simplify", "--metric", ""}),
              ElementsAre("auto", "quadric", "visibility", "entropy", "polygon-entropy", "image"));
  EXPECT_THAT(completed({"fit", "--distortion", "f"}), ElementsAre("flip"));
}

TEST(Completions, AreThereForOtherShells) {
  const std::string zsh = fovea({"--completions=zsh"}).out, fish = fovea({"--completions=fish"}).out;
  EXPECT_THAT(zsh, HasSubstr("#compdef fovea"));
  EXPECT_THAT(zsh, HasSubstr("'--metric["));
  EXPECT_THAT(fish, HasSubstr("complete -c fovea -n '__fish_seen_subcommand_from simplify' -l ratio"));
  const Outcome other = fovea({"--completions=tcsh"});
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("write bash, zsh or fish"));
}

}  // namespace
}  // namespace fovea::test
