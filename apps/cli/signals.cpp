#include "signals.h"

#include <atomic>
#include <csignal>

namespace fovea::cli {

namespace {

std::atomic<Context*> listener{nullptr};
static_assert(std::atomic<Context*>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

void on_signal(int signal) {
  Context* context = listener.load();
  if (context != nullptr && !context->cancelled()) {
    context->cancel();
    return;
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

CancelOnSignal::CancelOnSignal(Context& context) {
  listener = &context;
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  // A file that grows beyond what is allowed is an error of writing, like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
}

CancelOnSignal::~CancelOnSignal() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  listener = nullptr;
}

}  // namespace fovea::cli
