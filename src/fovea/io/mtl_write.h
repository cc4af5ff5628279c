#pragma once

#include <string>
#include <vector>

#include "fovea/io/write.h"
#include "fovea/model/model.h"

namespace fovea {

/// Names for the materials of a library: their own, made unique and free of blanks.
std::vector<std::string> material_names(const Model& model, const std::vector<int>& materials);

/// A Wavefront material library of these materials under these names; their images go into `files`.
std::vector<std::byte> write_mtl(const Model& model, const std::vector<int>& materials,
                                 const std::vector<std::string>& names, const std::string& stem,
                                 std::vector<OutputFile>& files);

}  // namespace fovea
