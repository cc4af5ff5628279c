#include "fovea/base/team.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace fovea {

namespace {

/// So often a helper looks for work before it sleeps: about 100 µs.
constexpr int kLooks = 4000;

/// Tells the processor that this is a loop that waits.
inline void pause() {
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

}  // namespace

Team::Team(const Context& context) {
  const int machine = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1u));
  const int threads = std::min(context.thread_count(), machine);
  helpers_.reserve(static_cast<std::size_t>(threads));
  try {
    for (int i = 1; i < threads; ++i) helpers_.emplace_back([this] { help(); });
  } catch (const std::system_error&) {
    // The machine has no more threads to give: those that there are do the work.
  }
}

Team::~Team() {
  ends_ = true;
  ++calls_;
  calls_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void Team::run(std::size_t count, const std::function<void(std::size_t)>& body) {
  if (helpers_.empty() || count < 2) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  body_ = &body;
  count_ = count;
  next_ = 0;
  is_open_ = true;
  ++calls_;
  calls_.notify_all();
  work();
  // Whoever comes in from here on sees that it is closed and touches nothing.
  is_open_ = false;
  for (int i = 0; inside_ != 0; ++i) i < kLooks ? pause() : std::this_thread::yield();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

/// Takes pieces until there are no more.
void Team::work() {
  try {
    for (std::size_t i = next_++; i < count_; i = next_++) (*body_)(i);
  } catch (...) {
    next_ = count_;
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::current_exception();
  }
}

void Team::help() {
  std::uint32_t seen = 0;
  while (!ends_) {
    for (int i = 0; i < kLooks && calls_ == seen; ++i) pause();
    calls_.wait(seen);
    seen = calls_;
    ++inside_;
    if (is_open_) work();
    --inside_;
  }
}

}  // namespace fovea
