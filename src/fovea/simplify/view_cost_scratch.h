#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "fovea/render/wide_triangle.h"
#include "fovea/simplify/local_blocks.h"
#include "fovea/simplify/view_cost.h"

// Of view_cost.cpp alone: what a thread that prices a collapse notes.

namespace fovea {

/// A face around the edge, in one showing.
struct ViewCost::LocalFace {
  const ShownInstance* showing = nullptr;
  const PlannedCollapse* planned = nullptr;
  std::uint32_t face = 0, shown = 0;
  std::array<const ScreenVertex*, 3> before{}, after{};  // [#views]
  bool goes = false, double_sided = false, has_holes = false;
};

/// The faces around an edge and the pixels that they cover, before and after its collapse.
struct ViewCost::Scratch {
  Scratch(std::size_t shown_faces, std::size_t value_count)
      : changed_by(shown_faces + 1, 0), delta(value_count, 0) {}

  /// A face as a view would see it after the collapse.
  struct Seen {
    bool is_seen = false;
    std::array<ScreenVertex, 3> corners;
    SampleBox box;
    std::size_t first_rows = 0;  // of the columns of its box
    std::optional<FaceValues::Shading> shading;
  };

  void begin_collapse() {
    ++collapse;
    faces.clear();
    looks.clear();
  }
  void add(const LocalFace& face) {
    changed_by[face.shown] = collapse;
    faces.push_back(face);
    looks.emplace_back();
  }
  /// Whether the collapse changes the face of a fragment; never the background.
  bool changes(const Fragment& fragment) const {  // the last in `changed_by` stands for no triangle
    return changed_by[std::min<std::size_t>(fragment.triangle, changed_by.size() - 1)] == collapse;
  }

  /// A view of the faces: which pixels they may cover, before or after.
  struct Sight {
    /// Adds those of a triangle. Returns where the rows of its columns begin.
    std::size_t add(const std::array<ScreenVertex, 3>& v, const SampleBox& box) {
      const int from = box.left / kColumn, to = (box.right - 1) / kColumn;
      const std::size_t at = rows.size();
      rows.resize(at + static_cast<std::size_t>(to - from + 1), {box.top, box.bottom});
      if (from < to && WideTriangle::fits(v)) find_rows(v, box, rows.data() + at);
      for (int column = from; column <= to; ++column) {
        RowRange& all = columns[static_cast<std::size_t>(column)];
        const RowRange& one = rows[at + static_cast<std::size_t>(column - from)];
        if (one.begin >= one.end) continue;
        all.begin = std::min(all.begin, one.begin);
        all.end = std::max(all.end, one.end);
      }
      first = std::min(first, from);
      last = std::max(last, to);
      top = std::min(top, box.top);
      bottom = std::max(bottom, box.bottom);
      return at;
    }
    void clear() {
      for (int column = first; column <= last; ++column) columns[static_cast<std::size_t>(column)] = {};
      first = top = std::numeric_limits<int>::max();
      last = bottom = -1;
      going.clear();
      rows.clear();
    }
    int height() const { return bottom - top; }

    std::vector<Seen> seen;            // [#faces] or more
    std::vector<std::uint32_t> going;  // those that are seen before, as shown
    std::vector<RowRange> rows;        // of the columns of each face's box
    std::vector<RowRange>
        columns;  // of all of them, for the whole view; those from first to last are covered
    int first = 0, last = -1, top = 0, bottom = 0;
  };
  Sight& sight(std::size_t view) { return sights[view % 2]; }

  std::vector<std::uint32_t> changed_by;  // [#shown faces + 1], the last collapse that changes them
  std::uint32_t collapse = 0;
  std::vector<LocalFace> faces;                // by shown number
  std::vector<std::optional<FaceLook>> looks;  // [#faces]
  std::array<Sight, 2> sights;                 // of a view and the next
  // Of the pixels that a sight covers:
  std::vector<LocalBlock> locals;      // [#columns][height]
  std::vector<std::uint32_t> unclear;  // of a column
  // Of those that would change, face by face; for each there is room for all that it may cover:
  std::vector<std::uint32_t> pixels, before, original, after;
  std::vector<std::uint32_t> begin, end;  // [#faces + 1]; the first is not a face
  std::vector<std::uint32_t> values;      // of a row
  std::vector<PlannedCollapse> planned;   // [#showings of the slot]
  std::vector<ScreenVertex> merged;       // [#showings of the slot][#views]
  std::vector<int> delta;                 // [#values], pixels more after the collapse (entropy)
  std::vector<std::uint32_t> in_delta;    // where that may not be 0
};

}  // namespace fovea
