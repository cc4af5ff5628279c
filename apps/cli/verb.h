#pragma once

#include <memory>
#include <string>
#include <vector>

#include "arguments.h"
#include "session.h"

namespace fovea::cli {

/// A command line that a user can copy, and what it does.
struct Example {
  std::string command;
  std::string meaning;
};

/// What `--help` says about a verb besides its options.
struct VerbText {
  std::string name;
  std::string summary;      ///< One line, without a full stop.
  std::string description;  ///< A paragraph.
  std::vector<Example> examples;
};

/// One subcommand: declares its arguments, then runs with them. A new verb is one file with a class
/// like this and its maker, and one line in verbs.cpp.
class Verb {
 public:
  virtual ~Verb() = default;
  virtual VerbText text() const = 0;
  /// Adds positionals and options that point into this object.
  virtual void declare(Arguments& arguments) = 0;
  /// Does the work and returns the exit code; throws fovea::Error. Fills `session.report`.
  virtual int run(Session& session) = 0;
};

/// Makes every verb, in the order of `fovea --help`.
std::vector<std::unique_ptr<Verb>> make_verbs();

}  // namespace fovea::cli
