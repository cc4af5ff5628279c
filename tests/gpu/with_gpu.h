#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "fovea/base/context.h"
#include "fovea/base/error.h"
#include "fovea/gpu/gpu_context.h"

namespace fovea::test {

/// Has a context without a window; skips where there is no driver for it.
class WithGpu : public testing::Test {
 protected:
  void SetUp() override {
    try {
      gpu_.emplace();
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }
  std::optional<GpuContext> gpu_;
  Context context_;
};

}  // namespace fovea::test
