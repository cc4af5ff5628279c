#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fovea {

/// Throws Error(usage) unless the extension, in upper or lower case, is one of `known`; `what` is to be
/// written: "pictures".
void check_extension(const std::filesystem::path& path, const std::string& what,
                     const std::vector<std::string>& known);

}  // namespace fovea
