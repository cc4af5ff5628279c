#pragma once

// Private to lod.

namespace fovea {

/// glTF's name for levels inside a file: an object with "bufferView".
inline constexpr const char* kLevelsExtension = "FOVEA_levels";

}  // namespace fovea
