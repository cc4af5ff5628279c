#include "session.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <system_error>

#include "report.h"
#include "text.h"

namespace fovea::cli {

namespace fs = std::filesystem;

OptionList describe(CommonOptions& o) {
  return {
      {"threads", "Threads to use; 0 takes all. The result does not depend on it.", &o.threads, "", 0, 1024},
      {"seed", "Seed of every random choice.", &o.seed, "", 0},
      {"json", "Print one JSON object on stdout instead of text.", &o.json, ""},
      {"quiet", "Print only errors, and data that was asked for.", &o.quiet, ""},
      {"verbose", "Tell each phase with its time and memory; list everything.", &o.verbose, ""},
  };
}

Session::Session(const CommonOptions& common) : common_(common), progress_(!common.quiet) {
  context.threads = static_cast<int>(common.threads);
  context.seed = static_cast<std::uint64_t>(common.seed);
  if (progress_.active()) {
    context.progress = [this](std::string_view phase, double fraction) {
      progress_.show(phase, fraction);
      return true;
    };
  }
}

void Session::print(const std::string& text) {
  progress_.clear();
  if (!common_.json) std::fputs(text.c_str(), stdout);
}

void Session::print_summary(const std::string& text) {
  if (!common_.quiet) print(text);
}

void Session::say(const std::string& line) {
  if (common_.quiet) return;
  progress_.clear();
  std::fprintf(stderr, "fovea: %s\n", line.c_str());
}

double Session::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::string Session::spent_text() const {
  return fmt::format("{}, peak memory {}", seconds_text(seconds()), bytes_text(peak_memory_bytes()));
}

Session::PhaseTimer::PhaseTimer(Session& session, const std::string& name)
    : session_(session), name_(name), start_(session.seconds()) {
  if (session_.verbose()) session_.say(name_ + " ...");
}

Session::PhaseTimer::~PhaseTimer() {
  const Phase phase{name_, session_.seconds() - start_, peak_memory_bytes()};
  session_.phases_.push_back(phase);
  session_.progress_.clear();
  if (session_.verbose()) {
    session_.say(fmt::format("{} {}, peak memory {}", name_, seconds_text(phase.seconds),
                             bytes_text(phase.peak_bytes)));
  }
}

void Session::tell_diagnostics() {
  for (const Diagnostic& d : context.diagnostics()) {
    const std::string count = d.count > 1 ? fmt::format(" ({} times)", count_text(d.count)) : "";
    say(fmt::format("note: {}{}{}{}", printable(d.place), d.place.empty() ? "" : ": ", printable(d.message),
                    count));
  }
}

void Session::add_resources() {
  Json& phases = report["phases"] = Json::array();
  for (const Phase& p : phases_) {
    phases.push_back({{"name", p.name}, {"seconds", p.seconds}, {"peak_memory_bytes", p.peak_bytes}});
  }
  report["seconds"] = seconds();
  report["peak_memory_bytes"] = peak_memory_bytes();
  report["threads"] = context.thread_count();
}

void Session::finish(int exit_code) {
  progress_.clear();
  if (common_.json) {
    report["diagnostics"] = diagnostics_json(context.diagnostics());
    add_resources();
    report["exit_code"] = exit_code;
    std::fputs((dump(report) + "\n").c_str(), stdout);
  } else {
    tell_diagnostics();
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw Error(ErrorKind::output, "cannot write", "standard output");
  }
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB.
}

void check_output(const std::string& output, const std::string& example,
                  const std::vector<std::string>& inputs, bool force,
                  const std::function<void(const fs::path&)>& check) {
  if (output.empty()) {
    throw Error(ErrorKind::usage, "no output is named", {}, "add: -o OUTPUT, for example -o " + example);
  }
  if (output == "-") {
    throw Error(ErrorKind::usage, "standard output is not supported", "-o -",
                "name a file: its extension picks the format");
  }
  for (const std::string& input : inputs) {
    std::error_code missing;
    if (!force && fs::equivalent(output, input, missing)) {
      throw Error(ErrorKind::usage, "the output is an input", output,
                  "--force replaces the original; there is no way back");
    }
  }
  check(output);
}

void check_input(const std::string& input) {
  if (input == "-") {
    throw Error(ErrorKind::usage, "standard input is not supported", "-", "name a file");
  }
  std::error_code error;
  const fs::file_status status = fs::status(input, error);
  if (fs::is_directory(status))
    throw Error(ErrorKind::input, "is a folder", input, "name a model file in it");
  if (status.type() == fs::file_type::none) throw Error(ErrorKind::input, error.message(), input);
  if (status.type() == fs::file_type::not_found) throw Error(ErrorKind::input, "no such file", input);
  // Models are opened more than once, and opening a pipe waits for whoever writes to it.
  if (!fs::is_regular_file(status))
    throw Error(ErrorKind::input, "this is not an ordinary file", input, "write it to a file first");
}

namespace {
constexpr int kTargetMissed = 8;
}

int target_code(Session& session, bool reached, bool allow_miss) {
  if (reached || allow_miss) return 0;
  session.say("target not reached (exit code 8; --allow-miss accepts it)");
  return kTargetMissed;
}

int too_many_bytes(Session& session, std::uint64_t wanted, std::uint64_t smallest, const std::string& hint) {
  session.say(fmt::format("error: no file takes {} or less: the smallest takes {}; nothing is written",
                          bytes_text(wanted), bytes_text(smallest)));
  session.say("hint: --allow-miss writes it all the same; " + hint);
  return kTargetMissed;
}

}  // namespace fovea::cli
