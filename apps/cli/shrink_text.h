#pragma once

#include <optional>
#include <span>
#include <string>

#include "fovea/texture/shrink.h"
#include "session.h"

namespace fovea::cli {

/// What became of textures: "images" and "atlases" of the report, and the same for people, image by image.
/// `rebake`: whether they were to be baked anew. `texels_per_pixel` [#images], or empty: texels of each to a
/// pixel that shows it, before; none where no pixel does.
std::string tell_shrunk(Session& session, const Shrunk& result, bool rebake,
                        std::span<const std::optional<double>> texels_per_pixel = {});

}  // namespace fovea::cli
