#pragma once

#include <cstddef>
#include <string>
#include <vector>

// Private to io.

namespace fovea {

/// A GLB file of its JSON and the bytes of buffer 0, which may be empty: then there is no BIN chunk. Throws
/// Error(limit) beyond the 4 GiB where the format ends.
std::vector<std::byte> make_glb(std::string json, const std::vector<std::byte>& binary);

}  // namespace fovea
