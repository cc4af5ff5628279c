#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fovea/lod/lod_chain_files.h"

namespace fovea::cli {

/// "10000,3000,500" as numbers; none of an empty text. Throws Error(usage) that names the option.
std::vector<double> number_list(const std::string& text, const std::string& option);
/// The same for whole numbers.
std::vector<std::int64_t> count_list(const std::string& text, const std::string& option);

/// A table of levels: sizes, where each comes in, errors.
std::string levels_text(const LodChain& chain, const std::vector<LodFile>& files);

}  // namespace fovea::cli
