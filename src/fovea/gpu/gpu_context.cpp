#include "fovea/gpu/gpu_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <initializer_list>

#include "fovea/base/error.h"

namespace fovea {

namespace {

[[noreturn]] void give_up(const std::string& why) {
  throw Error(ErrorKind::unsupported, "there is no OpenGL 4.3 without a window here: " + why, "gpu",
              "levels can be made on the processor instead");
}

/// Libraries that are missing would end the program at the first call.
void need_library(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (dlopen(name, RTLD_LAZY | RTLD_GLOBAL) != nullptr) return;
  }
  give_up(std::string(*names.begin()) + " is missing");
}

}  // namespace

GpuContext::GpuContext() {
  need_library({"libEGL.so.1"});
  need_library({"libOpenGL.so.0", "libGL.so.1"});
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  } else {
    display_ = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  }
  if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) == EGL_FALSE)
    give_up("there is no display");
  if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) give_up("the driver has no OpenGL");
  const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                         4,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         3,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                         EGL_NONE};
  context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  if (context_ == EGL_NO_CONTEXT) give_up("the driver refuses");
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
    eglDestroyContext(display_, context_);
    give_up("the context cannot be used");
  }
  device_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

GpuContext::~GpuContext() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

void need_gpu_context() {
  if (epoxy_is_desktop_gl() && epoxy_gl_version() >= 43) return;
  throw Error(ErrorKind::unsupported, "the context that is current is not of OpenGL 4.3 or later", "gpu");
}

}  // namespace fovea
