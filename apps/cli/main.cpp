#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "completions.h"
#include "fovea/base/error.h"
#include "help.h"
#include "report.h"
#include "session.h"
#include "signals.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

using Words = std::vector<std::string>;

bool has(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::unique_ptr<Verb> find_verb(const std::string& name) {
  std::vector<std::unique_ptr<Verb>> verbs = make_verbs();
  std::vector<std::string> names;
  for (auto& verb : verbs) {
    if (verb->text().name == name) return std::move(verb);
    names.push_back(verb->text().name);
  }
  const std::vector<std::string> near = nearest_names(name, names);
  const bool flag = name.rfind("-", 0) == 0;
  throw Error(ErrorKind::usage, fmt::format("unknown {} '{}'", flag ? "option" : "verb", name), {},
              flag           ? "a verb comes first: fovea VERB INPUT... [options]"
              : near.empty() ? fmt::format("verbs are: {}", fmt::join(names, ", "))
                             : fmt::format("did you mean {}?", near.front()));
}

// Help and version, which need no verb. True if that was all.
bool answer(const Words& words) {
  const std::string& first = words.front();
  if (first == "--version") {
    fmt::print("fovea {}\n", FOVEA_VERSION);
  } else if (first == "--help" || first == "-h" || (first == "help" && words.size() == 1)) {
    fmt::print("{}", main_help());
  } else if (first == "--help=markdown") {
    fmt::print("{}", options_markdown());
  } else if (first.rfind("--completions=", 0) == 0) {
    fmt::print("{}", completions(first.substr(first.find('=') + 1)));
  } else if (first == "help") {
    fmt::print("{}", verb_help(*find_verb(words[1])));
  } else {
    return false;
  }
  return true;
}

/// The exception that is being handled, as what is told.
Error caught() {
  try {
    throw;
  } catch (const Error& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return {ErrorKind::limit, "out of memory", {}, "the model is too large for this machine"};
  } catch (const std::filesystem::filesystem_error& error) {
    // A file that was there a moment ago.
    return {ErrorKind::input, error.code().message(), error.path1().string()};
  } catch (const std::system_error& error) {
    return {ErrorKind::limit, error.code().message(), {}, "the machine has no more threads or files to give"};
  } catch (const std::exception& error) {
    return {ErrorKind::internal, error.what(), {}, "this is a fault of Fovea: please report it"};
  }
}

void tell(const Error& error) {
  const std::string place = error.place().empty() ? "" : error.place() + ": ";
  fmt::print(stderr, "fovea: error: {}\n", printable(place + error.message()));
  if (!error.hint().empty()) fmt::print(stderr, "hint: {}\n", printable(error.hint()));
}

/// The exit code of the verb; of one that fails, whose report keeps what it holds so far, that of its error.
int run_and_report(Verb& verb, Session& session) {
  std::optional<Error> failure;
  int code = 0;
  try {
    code = verb.run(session);
  } catch (...) {
    failure = caught();
    code = exit_code(failure->kind());
    session.report["error"] = error_json(*failure);
  }
  session.finish(code);
  if (failure) tell(*failure);
  return code;
}

std::vector<std::string> verbs_with(const std::string& option) {
  std::vector<std::string> owners;
  for (const auto& verb : make_verbs()) {
    Arguments arguments;
    verb->declare(arguments);
    if (arguments.has(option)) owners.push_back(verb->text().name);
  }
  return owners;
}

/// What a verb answers without running. True if that was all.
bool answer(Verb& verb, const Words& words) {
  if (has(words, "--help=markdown")) {
    throw Error(ErrorKind::usage, "--help=markdown shows all verbs", {}, "write: fovea --help=markdown");
  }
  if (has(words, "--help") || has(words, "-h")) {
    fmt::print("{}", verb_help(verb));
  } else if (has(words, "--version")) {
    fmt::print("fovea {}\n", FOVEA_VERSION);
  } else {
    return false;
  }
  return true;
}

int run_verb(Verb& verb, const Words& words) {
  if (answer(verb, words)) return 0;
  CommonOptions common;
  Arguments arguments;
  verb.declare(arguments);
  arguments.add("Common", describe(common));
  arguments.parse(words, verb.text().name, verbs_with);

  Session session(common);
  session.report = report_head(verb.text().name);
  session.report["options"] = options_json(arguments);
  const CancelOnSignal guard(session.context);
  return run_and_report(verb, session);
}

int run(const Words& words) {
  if (words.empty()) {
    fmt::print(stderr, "{}", main_help());
    return exit_code(ErrorKind::usage);
  }
  if (answer(words)) return 0;
  const std::unique_ptr<Verb> verb = find_verb(words.front());
  return run_verb(*verb, Words(words.begin() + 1, words.end()));
}

/// For what goes wrong around the run of a verb.
int fail(const Error& error, const Words& words) {
  tell(error);
  const int code = exit_code(error.kind());
  if (has(words, "--json")) {
    Json json = report_head(words.front().rfind("-", 0) == 0 ? "" : words.front());
    json["error"] = error_json(error);
    json["exit_code"] = code;
    fmt::print("{}\n", dump(json));
  }
  return code;
}

}  // namespace

}  // namespace fovea::cli

int main(int argc, char** argv) {
  using namespace fovea;
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  try {
    return cli::run(words);
  } catch (...) {
    return cli::fail(cli::caught(), words);
  }
}
