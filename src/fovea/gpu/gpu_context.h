#pragma once

#include <string>

namespace fovea {

/// An OpenGL 4.3 context without a window, made through EGL: for programs that have none. On the machine's
/// graphics card, or on the processor where the driver does that (Mesa's llvmpipe).
class GpuContext {
 public:
  /// Makes it current in this thread. Throws Error(unsupported), with the reason, if the machine has no
  /// driver for it.
  GpuContext();
  ~GpuContext();
  GpuContext(const GpuContext&) = delete;
  GpuContext& operator=(const GpuContext&) = delete;

  /// What draws: "llvmpipe (LLVM 15.0.6, 256 bits)".
  const std::string& device() const { return device_; }

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
  std::string device_;
};

/// Throws Error(unsupported) unless a context of OpenGL 4.3 or later is current in this thread.
void need_gpu_context();

}  // namespace fovea
