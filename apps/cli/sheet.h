#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "arguments.h"
#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/render/render.h"
#include "fovea/render/view.h"
#include "fovea/surface/pose.h"

namespace fovea::cli {

/// Six views from around.
ViewOptions views_around();

/// What a sheet shows of a model.
struct SheetOptions {
  ViewOptions views = views_around();
  std::int64_t size = 384;   ///< Pixels along each side of a view.
  std::int64_t columns = 0;  ///< Views in a row; 0: about as many as rows.
};

/// Adds the options of a sheet that is one of several things that a verb can write; `is_picture` says whether
/// it is asked for, or whether nobody knows yet.
void add_sheet(Arguments& arguments, SheetOptions& sheet, std::function<bool()> is_picture);

/// Draws views side by side, row by row; about square if `columns` is 0. Tells its progress; can be cancelled
/// between views. Throws Error(usage) if the sheet would be larger than common viewers open.
Image8 draw_sheet(const RenderScene& scene, std::span<const View> views, std::int64_t columns,
                  const RenderOptions& options, Context& context, std::span<const VertexField> fields);

/// The same of a model in a pose; the size of pictures is that of the sheet's options.
Image8 draw_sheet(const Model& model, const PoseOptions& pose, const SheetOptions& sheet,
                  RenderOptions options, Context& context, std::span<const VertexField> fields);

/// The same of pictures that are there already, all of the same size.
Image8 join_sheet(std::span<const Image8> pictures, std::int64_t columns);

}  // namespace fovea::cli
