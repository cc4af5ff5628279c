#pragma once

#include <string>

#include "fovea/base/error.h"

// Private to io/.

namespace fovea::gltf {

/// For decoders of a part of a file, which do not know where in it they are: callers add the place.
[[noreturn]] inline void fail(const std::string& message) { throw Error(ErrorKind::format, message); }

}  // namespace fovea::gltf
