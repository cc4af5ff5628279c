#pragma once

#include <filesystem>
#include <string>

namespace fovea {

/// ASCII letters in lower case, all else as it is.
std::string lower_case(std::string text);

/// ".obj" of "Model.OBJ"; empty without one.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace fovea
