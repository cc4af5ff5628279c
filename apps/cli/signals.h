#pragma once

#include "fovea/base/context.h"

namespace fovea::cli {

/// While it lives, the first SIGINT or SIGTERM cancels `context` and a second one kills the process; a
/// file that grows beyond what is allowed is an error of writing.
/// One at a time.
class CancelOnSignal {
 public:
  explicit CancelOnSignal(Context& context);
  ~CancelOnSignal();
  CancelOnSignal(const CancelOnSignal&) = delete;
  CancelOnSignal& operator=(const CancelOnSignal&) = delete;
};

}  // namespace fovea::cli
