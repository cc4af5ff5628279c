#include "fovea/io/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>

#include "fovea/base/error.h"

namespace fovea {

namespace {

/// What comes first through the pipe; then `size` bytes of result, or three texts each ending in 0.
struct Header {
  std::int32_t is_error = 0;
  std::int32_t kind = 0;
  std::uint64_t size = 0;
};

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close_now(); }
  int get() const { return number_; }
  void close_now() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

// In the child. -------------------------------------------------------------------------------

/// Bytes of writable memory that the process has now.
std::uint64_t data_bytes() {
  std::uint64_t size = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    const int read =
        std::fscanf(file, "%lu %lu %lu %lu %lu %lu", &size, &resident, &shared, &text, &library, &data);
    std::fclose(file);
    if (read != 6) data = 0;
  }
  return data * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void lower_limit(int resource, std::uint64_t value) {
  rlimit limit{};
  if (::getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0) return;
  limit.rlim_cur = std::min<std::uint64_t>(limit.rlim_max, value);
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

void confine(const ChildLimits& limits) {
  lower_limit(RLIMIT_DATA, data_bytes() + limits.memory_bytes);
  lower_limit(RLIMIT_CPU, limits.cpu_seconds);
  lower_limit(RLIMIT_CORE, 0);
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTERM, SIGINT, SIGXCPU, SIGPIPE}) {
    std::signal(signal, SIG_DFL);
  }
  const int nowhere = ::open("/dev/null", O_RDWR);
  if (nowhere < 0) return;
  ::dup2(nowhere, 1);
  ::dup2(nowhere, 2);
}

void send(int to, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::write(to, at, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) ::_exit(1);  // nobody listens any more
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

void send_error(int to, const Error& error) {
  std::string text = error.message();
  for (const std::string* more : {&error.place(), &error.hint()}) (text += '\0') += *more;
  const Header header{1, static_cast<std::int32_t>(error.kind()), text.size()};
  send(to, &header, sizeof header);
  send(to, text.data(), text.size());
}

[[noreturn]] void run_child(const std::function<std::vector<std::byte>()>& work, const ChildLimits& limits,
                            const std::string& place, int to) {
  confine(limits);
  try {
    const std::vector<std::byte> result = work();
    const Header header{0, 0, result.size()};
    send(to, &header, sizeof header);
    send(to, result.data(), result.size());
  } catch (const Error& error) {
    send_error(to, error);
  } catch (const std::bad_alloc&) {
    send_error(to, Error(ErrorKind::limit, "reading this file needs more memory than is allowed", place,
                         "raise --max-total-bytes or --max-expansion"));
  } catch (const std::exception& error) {
    send_error(to, Error(ErrorKind::format, error.what(), place));
  } catch (...) {
    send_error(to, Error(ErrorKind::format, "the import library failed", place));
  }
  ::_exit(0);
}

// In the parent. ------------------------------------------------------------------------------

class Child {
 public:
  Child(pid_t process, int from, const std::string& place, Context& context)
      : process_(process), from_(from), place_(place), context_(context) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (ended_) return;
    ::kill(process_, SIGKILL);
    wait(0);
  }

  void receive(void* data, std::size_t size) {
    char* at = static_cast<char*>(data);
    while (size > 0) {
      wait_for_data();
      const ssize_t received = ::read(from_, at, size);
      if (received < 0 && errno == EINTR) continue;
      if (received <= 0) fail();
      at += received;
      size -= static_cast<std::size_t>(received);
    }
  }

 private:
  /// Returns when something can be read; looks for cancelling and for the child's end meanwhile (a
  /// child of another thread may hold our pipe open, so its closing is not enough).
  void wait_for_data() {
    for (;;) {
      pollfd waiting{from_, POLLIN, 0};
      const int ready = ::poll(&waiting, 1, ended_ ? 0 : 100);
      if (ready > 0) return;
      if (ready == 0 && ended_) fail();
      context_.advance_or_throw("import", 0);
      if (!ended_) wait(WNOHANG);
    }
  }
  void wait(int flags) {
    const pid_t result = ::waitpid(process_, &status_, flags);
    if (result == process_ || (result < 0 && errno != EINTR)) ended_ = true;
  }
  [[noreturn]] void fail() {
    while (!ended_) wait(0);
    if (WIFSIGNALED(status_) && WTERMSIG(status_) == SIGXCPU) {
      throw Error(ErrorKind::limit, "reading this file takes too long", place_);
    }
    const std::string how = WIFSIGNALED(status_) ? fmt::format(" (signal {})", WTERMSIG(status_)) : "";
    throw Error(ErrorKind::format, "the import library broke down on this file" + how, place_,
                "the file may be damaged; convert it to glTF with the program that made it");
  }

  pid_t process_;
  int from_;
  const std::string& place_;
  Context& context_;
  int status_ = 0;
  bool ended_ = false;
};

Error received_error(const Header& header, const std::string& text) {
  std::array<std::string, 3> parts;
  std::size_t begin = 0;
  for (std::string& part : parts) {
    const std::size_t end = std::min(text.find('\0', begin), text.size());
    part = text.substr(begin, end - begin);
    begin = std::min(end + 1, text.size());
  }
  return Error(static_cast<ErrorKind>(header.kind), parts[0], parts[1], parts[2]);
}

}  // namespace

std::vector<std::byte> run_in_child(const std::function<std::vector<std::byte>()>& work,
                                    const ChildLimits& limits, const std::string& place, Context& context) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw Error(ErrorKind::internal, fmt::format("no pipe can be made: {}", std::strerror(errno)), place);
  }
  const Descriptor from(ends[0]);
  Descriptor to(ends[1]);
  const pid_t process = ::fork();
  if (process < 0) {
    throw Error(ErrorKind::internal, fmt::format("no process can be made: {}", std::strerror(errno)), place);
  }
  if (process == 0) run_child(work, limits, place, to.get());
  to.close_now();
  Child child(process, from.get(), place, context);
  Header header;
  child.receive(&header, sizeof header);
  const std::uint64_t most = header.is_error ? std::uint64_t{1} << 20 : limits.result_bytes;
  if (header.size > most) {
    throw Error(ErrorKind::limit, fmt::format("the file expands to {} bytes", header.size), place,
                "raise --max-total-bytes or --max-expansion");
  }
  if (header.is_error) {
    std::string text(header.size, '\0');
    child.receive(text.data(), text.size());
    throw received_error(header, text);
  }
  std::vector<std::byte> result(header.size);
  child.receive(result.data(), result.size());
  return result;
}

}  // namespace fovea
