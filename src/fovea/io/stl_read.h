#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "fovea/io/read.h"
#include "fovea/model/model.h"

namespace fovea {

/// Whether bytes look like STL: a binary file has exactly the size that its triangle count asks for,
/// a text file begins with "solid" and a facet. For the first, `bytes` must be the whole file.
bool is_stl(std::span<const std::byte> bytes);

/// Reads STL, text or binary, as one mesh. Corners are source vertices, in file order. Normals are
/// dropped, since STL has those of the faces only; colours in the attribute bytes too.
///
/// Throws Error(format) with "place:line N" or "place:byte N", Error(limit), Error(unsupported) if
/// there is no triangle.
Model read_stl(std::span<const std::byte> bytes, const std::string& place, const ReadOptions& options,
               Context& context);

}  // namespace fovea
