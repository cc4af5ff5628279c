#pragma once

#include <cstdint>
#include <span>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/render/render.h"

namespace fovea::cli {

/// Draws views side by side, row by row; about square if `columns` is 0. Tells its progress; can be cancelled
/// between views. Throws Error(usage) if the sheet would be larger than common viewers open.
Image8 draw_sheet(const RenderScene& scene, std::span<const View> views, std::int64_t columns,
                  const RenderOptions& options, Context& context, std::span<const VertexField> fields);

/// The same of pictures that are there already, all of the same size.
Image8 join_sheet(std::span<const Image8> pictures, std::int64_t columns);

}  // namespace fovea::cli
