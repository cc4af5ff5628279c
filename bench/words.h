#pragma once

#include <optional>
#include <string>
#include <vector>

namespace fovea::bench {

/// The word after `name`, both taken out of a command's; none if it is not there. Throws Error(usage) if it
/// is the last.
std::optional<std::string> take_option(std::vector<std::string>& words, const std::string& name);

}  // namespace fovea::bench
