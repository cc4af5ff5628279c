#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/error.h"
#include "fovea/base/options.h"
#include "progress.h"

namespace fovea::cli {

/// Keys in the order in which they were added.
using Json = nlohmann::ordered_json;

/// Options of every verb.
struct CommonOptions {
  bool quiet = false;
  bool json = false;
  bool verbose = false;
  std::int64_t threads = 0;
  std::int64_t seed = 1;
};
OptionList describe(CommonOptions& options);

/// Runs `work` on what was read from `path`: an Error about the data gets the path before its place.
template <class Work>
auto about(const std::string& path, Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (const Error& error) {
    const ErrorKind kind = error.kind();
    if (kind != ErrorKind::format && kind != ErrorKind::unsupported && kind != ErrorKind::limit) throw;
    throw error.within(path);
  }
}

/// One run of a verb: the library's context, what is printed where, and the report for --json.
///
/// stdout is for data, stderr for talk. `--json` turns everything on stdout into one object.
class Session {
 public:
  explicit Session(const CommonOptions& common);

  Context context;
  /// What the verb found, in the order in which it says so; `finish` adds the rest.
  Json report = Json::object();

  /// Runs `work` as a named phase: timed, told with --verbose, not begun when cancelled.
  template <class Work>
  auto phase(const std::string& name, Work&& work) {
    if (context.cancelled()) throw Error(ErrorKind::cancelled, "cancelled");
    const PhaseTimer timer(*this, name);
    return std::forward<Work>(work)();
  }
  /// The same `about` what was read from `path`.
  template <class Work>
  auto phase(const std::string& name, const std::string& path, Work&& work) {
    return phase(name, [&] { return about(path, std::forward<Work>(work)); });
  }

  bool json() const { return common_.json; }
  bool verbose() const { return common_.verbose; }
  /// Data that the user asked for: stdout, unless --json replaces it.
  void print(const std::string& text);
  /// What was done: stdout, unless --quiet or --json.
  void print_summary(const std::string& text);
  /// Talk, a line: stderr, unless --quiet.
  void say(const std::string& line);

  double seconds() const;
  /// "0.42 s, peak memory 37.4 MB".
  std::string spent_text() const;
  /// Tells the diagnostics, and with --json prints the report with diagnostics, times, memory and
  /// exit code. Throws Error(output) if stdout cannot be written.
  void finish(int exit_code);

 private:
  struct Phase {
    std::string name;
    double seconds = 0;
    std::uint64_t peak_bytes = 0;  ///< Of the process up to the phase's end.
  };
  class PhaseTimer {
   public:
    PhaseTimer(Session& session, const std::string& name);
    ~PhaseTimer();
    PhaseTimer(const PhaseTimer&) = delete;
    PhaseTimer& operator=(const PhaseTimer&) = delete;

   private:
    Session& session_;
    std::string name_;
    double start_;
  };

  void tell_diagnostics();
  void add_resources();

  CommonOptions common_;
  Progress progress_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<Phase> phases_;
};

/// Largest resident memory of this process so far.
std::uint64_t peak_memory_bytes();

/// Checks an output path before any work is spent on it: Error(usage) for none, with an example, for "-" and
/// for a path that is an input without `force`, then all that `check` does.
void check_output(const std::string& output, const std::string& example,
                  const std::vector<std::string>& inputs, bool force,
                  const std::function<void(const std::filesystem::path&)>& check);

/// An input path as given; Error(usage) for "-", Error(input) if it is missing, a folder, a pipe or a device.
void check_input(const std::string& input);

/// The exit code of a run with a target: 8, with a word, if it was missed and that is not allowed.
int target_code(Session& session, bool reached, bool allow_miss);

/// Says that nothing is written, as no file takes so few bytes; `smallest` is what the smallest takes, `hint`
/// what would help besides --allow-miss. Returns the exit code.
int too_many_bytes(Session& session, std::uint64_t wanted, std::uint64_t smallest, const std::string& hint);

}  // namespace fovea::cli
