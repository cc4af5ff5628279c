#pragma once

#include <cstdint>
#include <span>

#include "fovea/model/image.h"
#include "fovea/render/render.h"

namespace fovea::cli {

/// Room for a sheet of views side by side, in the background's colour; about square if `columns` is 0. Throws
/// Error(usage) if it would be larger than common viewers open.
Image8 empty_sheet(std::size_t views, std::int64_t columns, const RenderOptions& options);

/// Puts the pictures on the sheet, row by row.
void arrange(std::span<const Picture> pictures, Image8& sheet);

}  // namespace fovea::cli
