#pragma once

#include <string>

#include "fovea/texture/shrink.h"
#include "session.h"

namespace fovea::cli {

/// What became of textures: "images" and "atlases" of the report, and the same for people, image by image.
/// `rebake`: whether they were to be baked anew.
std::string tell_shrunk(Session& session, const Shrunk& result, bool rebake);

}  // namespace fovea::cli
