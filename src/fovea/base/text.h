#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace fovea {

/// ASCII letters in lower case, all else as it is.
std::string lower_case(std::string text);

/// ".obj" of "Model.OBJ"; empty without one.
std::string lower_extension(const std::filesystem::path& path);

/// The bytes as characters; they stay where they are.
inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace fovea
