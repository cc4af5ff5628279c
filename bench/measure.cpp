#include "measure.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fstream>

#include "fovea/base/error.h"

namespace fovea::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

double used_seconds(const rusage& usage) { return seconds(usage.ru_utime) + seconds(usage.ru_stime); }

/// A line of /proc/self/status that counts in kB, in bytes.
std::uint64_t status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (std::uint64_t kilobytes = 0; word == key + ":" && status >> kilobytes) return kilobytes * 1024;
  }
  return 0;
}

/// Brings the pages of the program and its libraries in: else those that the work is the first to run would
/// count as its memory, whatever it works on.
void map_program() {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t begin = 0, end = 0;
    if (line.find(" r-") == std::string::npos || line.find('/') == std::string::npos) continue;
    if (std::sscanf(line.c_str(), "%zx-%zx", &begin, &end) != 2) continue;
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_POPULATE_READ);
  }
}

/// Forgets the memory peak so far. The kernel's own counter only grows, and reading a file may have
/// needed more than the work that follows.
std::uint64_t restart_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
  return status_bytes("VmRSS");
}

Cost work_here(const Preparation& prepare) {
  const Work work = prepare();
  map_program();
  const std::uint64_t before = restart_peak();
  const double cpu_before = cpu_seconds();
  const Clock::time_point start = Clock::now();
  Cost cost;
  cost.result = work();
  cost.wall_seconds = seconds_since(start);
  cost.cpu_seconds = cpu_seconds() - cpu_before;
  const std::uint64_t peak = status_bytes("VmHWM");
  cost.peak_bytes = peak > before ? peak - before : 0;
  return cost;
}

[[noreturn]] void child(const Preparation& prepare, int pipe_end) {
  Cost cost;
  int code = 1;
  try {
    cost = work_here(prepare);
    code = write(pipe_end, &cost, sizeof cost) == sizeof cost ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench: {}\n", error.what());
  }
  _exit(code);
}

Cost measure_once(const Preparation& prepare) {
  int ends[2];
  if (pipe(ends) != 0) throw Error(ErrorKind::internal, "no pipe for the measuring process");
  std::fflush(nullptr);
  const pid_t pid = fork();
  if (pid == 0) child(prepare, ends[1]);
  close(ends[1]);
  Cost cost;
  if (pid < 0 || read(ends[0], &cost, sizeof cost) != sizeof cost) cost = {};
  close(ends[0]);
  if (pid > 0) waitpid(pid, nullptr, 0);
  return cost;
}

[[noreturn]] void exec_quietly(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int nothing = open("/dev/null", O_WRONLY);
  dup2(nothing, STDOUT_FILENO);
  dup2(nothing, STDERR_FILENO);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

Cost run_once(const std::vector<std::string>& words, const std::vector<int>& accepted) {
  const Clock::time_point start = Clock::now();
  const pid_t pid = fork();
  if (pid == 0) exec_quietly(words);
  int status = 0;
  rusage usage{};
  const bool ended = pid > 0 && wait4(pid, &status, 0, &usage) == pid && WIFEXITED(status);
  const int code = ended ? WEXITSTATUS(status) : -1;
  if (code != 0 && std::find(accepted.begin(), accepted.end(), code) == accepted.end()) {
    throw Error(ErrorKind::input, fmt::format("{} failed with exit code {}", words[0], code));
  }
  return {seconds_since(start), used_seconds(usage), static_cast<std::uint64_t>(usage.ru_maxrss) * 1024, 0};
}

Cost best(const std::function<Cost()>& run, int repeats) {
  Cost result = run();
  for (int i = 1; i < repeats; ++i) {
    const Cost cost = run();
    result.wall_seconds = std::min(result.wall_seconds, cost.wall_seconds);
    result.cpu_seconds = std::min(result.cpu_seconds, cost.cpu_seconds);
    result.peak_bytes = std::max(result.peak_bytes, cost.peak_bytes);
  }
  return result;
}

}  // namespace

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return used_seconds(usage);
}

Cost measure(const Preparation& prepare, int repeats) {
  return best([&] { return measure_once(prepare); }, repeats);
}

Cost measure_command(const std::vector<std::string>& words, int repeats, const std::vector<int>& accepted) {
  return best([&] { return run_once(words, accepted); }, repeats);
}

}  // namespace fovea::bench
