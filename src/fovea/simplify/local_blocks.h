#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "fovea/base/wide.h"
#include "fovea/render/display_texture.h"
#include "fovea/render/fragment_lists.h"
#include "fovea/render/wide_triangle.h"

namespace fovea {

// The inner loops of ViewCost, over kWide pixels at once. Pixels are blocks of kWide in a row, blocks
// columns, row after row.

/// What a collapse would leave in kWide pixels, of the faces around it.
struct alignas(64) LocalBlock {
  WideFloats nearness;  // of the nearest
  WideWords face;       // counted from 1; 0: none
};

/// Notes a face where it is nearer than what is noted. `rows` are those of the columns of its box; `blocks`
/// is that of the first pixels of the sight, `height` rows of a column after each other.
void lay_face(const WideTriangle& triangle, const RowRange* rows, std::uint32_t face, int first_column,
              int top, int height, LocalBlock* blocks);

/// So many blocks of nothing.
void clear(LocalBlock* blocks, int count);

/// Pixels that a face would show, with what they show now; or that nothing around the edge would.
struct FoundPixels {
  std::uint32_t* pixels;  // x + 2¹⁶ · y
  std::uint32_t* before;
  std::uint32_t* original;
  std::uint32_t* end;  // [#faces + 1], where the next of a face goes
};

/// A column of blocks, in a view.
struct BlockColumn {
  const FrontBlock* fronts;
  const LocalBlock* locals;        // from row `begin` on
  const std::uint32_t* originals;  // of pixels; null: none
  int begin, end;                  // rows
  int x, width;                    // pixels of the view
  // Where many triangles go, what says it of each, see Scratch; else empty.
  std::span<const std::uint32_t> changed_by;
  std::uint32_t collapse;
};
/// Adds to what is found where a face would be in front without doubt; in `unclear` notes the pixels about
/// which more has to be asked. `going` are the triangles that the collapse changes. Returns how many pixels
/// are unclear.
std::size_t find_changes(const BlockColumn& column, std::span<const std::uint32_t> going,
                         const FoundPixels& found, std::uint32_t* unclear);

/// Keeps those of n values that differ before and after, in their order. Returns how many these are.
/// Arrays have room for a multiple of kWide.
std::size_t keep_different(std::size_t n, std::uint32_t* before, std::uint32_t* after);

/// Coverage of originals inside of the model, see `mark_inside`: as good as opaque.
constexpr std::uint32_t kInside = 254;

/// Marks the pixels of an original, row by row, that are opaque and have only such around them: what shows
/// the background there has a hole.
void mark_inside(std::span<PackedColor> picture, int width, int height);

/// |x − original|² over the channels, 0 … 255; between a pixel with and one without a surface 8128 more, and
/// for a hole 64,512.
inline std::int32_t squared_difference(PackedColor x, PackedColor original) {
  const auto d = [&](int shift) {
    return static_cast<std::int32_t>(x >> shift & 255) - static_cast<std::int32_t>(original >> shift & 255);
  };
  const std::int32_t r = d(0), g = d(8), b = d(16), coverage = d(24);
  const std::int32_t uncovered = coverage * coverage / 8;
  return r * r + g * g + b * b + (original >> 24 == kInside ? 8 * uncovered : uncovered);
}

/// How much farther n colours are from the originals after than before. Arrays have room for a multiple of
/// kWide.
std::int64_t added_error(std::size_t n, const std::uint32_t* before, const std::uint32_t* after,
                         const std::uint32_t* original);

}  // namespace fovea
