#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/team.h"
#include "fovea/render/fragment_lists.h"
#include "fovea/simplify/collapse_state.h"
#include "fovea/simplify/face_values.h"
#include "fovea/simplify/shown_surface.h"
#include "fovea/simplify/value_merge.h"

namespace fovea {

/// What of a picture a collapse must not change.
enum class ViewMeasure {
  entropy,  ///< How evenly regions (or faces) share each view: viewpoint entropy.
  image,    ///< The colour of each pixel, against the original's.
};

/// A sum over views that may stop before the last.
struct PartialChange {
  std::int64_t sum = 0;     ///< In units of the measure, see ViewCost::amount.
  std::uint32_t views = 0;  ///< Over the first of them.
};

/// What collapses change in a set of views, from lists of the fragments behind every pixel: only pixels that
/// the triangles around an edge cover are looked at, and nothing is drawn again.
///
/// - `image`: Σ over views and pixels of |C' − O|² − |C − O|², with C the colour now, C' that after the
///   collapse and O that of the original, each channel 0 … 255 (after Lindstrom and Turk 2000). A pixel that
///   model and background swap counts 8128 more, as much as 52 in each channel; a hole, background where the
///   original has opaque surface and has it all around, 64,512 more, as much as 147.
/// - `entropy`: Σ over views of |H − H'|, H = −Σ (a_i / a_t) log₂ (a_i / a_t) over the pixels a_i of each
///   region and the background, a_t those of the view (paper eq. 4).
///
/// Sums are whole numbers, so they do not depend on the order in which anything is looked at: the change that
/// is predicted is exactly that between two fresh renderings.
class ViewCost {
 public:
  /// Renders what is shown, views in parallel. All must outlive this. `size` is that of the views;
  /// `originals` [#views][#pixels] are the colours to compare with, those of now if there are none.
  ViewCost(const CollapseState& state, ShownSurface& shown, const FaceValues& values, ViewMeasure measure,
           int size, std::vector<std::vector<std::uint32_t>> originals, const Context& context, Team& team);
  ~ViewCost();

  /// Memory of a thread that prices.
  struct Scratch;
  std::shared_ptr<Scratch> make_scratch() const;

  /// What the collapse of the edge a–b to p changes: squared display values (0 … 3 · 255² for a pixel) over
  /// all views and pixels, possibly negative, or bits over all views. `merge` has planned the collapse.
  /// Changes nothing but `scratch`: for many threads, each with one of its own. O(#views · (one-rings + their
  /// pixels)).
  double change(std::uint32_t a, std::uint32_t b, Vec3d p, const ValueMerge& merge, Scratch& scratch) const;
  /// The same, going on from `part` by one view or more until all have been looked at or it is more than
  /// `limit`. Nothing around the edge may have changed since `part` began.
  void add_change(std::uint32_t a, std::uint32_t b, Vec3d p, const ValueMerge& merge, double limit,
                  Scratch& scratch, PartialChange& part) const;
  /// What has been summed, in the units of `change`.
  double amount(const PartialChange& part) const;
  bool is_whole(const PartialChange& part) const { return part.views == views_.size(); }

  /// What it changes if some faces go, of one mesh.
  double change_without(std::span<const std::uint32_t> faces, Scratch& scratch) const;

  /// To be called before anything changes, with all faces that will: takes them out of the lists.
  void take_out(std::span<const std::uint32_t> faces);
  /// To be called before a collapse of a and b to p changes the mesh, after which b is left.
  void move(std::uint32_t a, std::uint32_t b, Vec3d p);
  /// To be called when all has changed: puts faces into the lists as they are now.
  void put_in(std::span<const std::uint32_t> faces);

  /// The measure of what is shown now: the squared error of all pixels, or the sum of the views' entropies,
  /// each as often as its picture is as large as the largest.
  double total() const;
  std::size_t view_count() const { return views_.size(); }
  const FragmentLists& fragments(std::size_t view) const { return views_[view].lists; }
  /// What is in front of each pixel of a view now. [#pixels]
  std::vector<std::uint32_t> picture(std::size_t view) const;
  std::size_t bytes() const;

 private:
  struct ViewState {
    FragmentLists lists;
    std::vector<std::uint32_t> count;     // [#regions], their pixels, those of the background first (entropy)
    std::vector<std::uint32_t> original;  // [#pixels of the lists], what they showed at first (image)
  };
  template <class Change>
  void for_showings(std::span<const std::uint32_t> faces, Change&& change);
  void put_in(std::size_t view, const ShownInstance& showing, std::uint32_t f);
  void take_out(std::size_t view, const ShownInstance& showing, std::uint32_t f);
  void swap_value(ViewState& view, const Fragment& before, const Fragment& after) const;
  std::array<ScreenVertex, 3> corners(std::size_t view, const ShownInstance& showing, std::uint32_t f) const;
  double along(std::uint32_t a, std::uint32_t b, Vec3d p) const;
  void gather(std::uint32_t a, std::uint32_t b, Vec3d p, const ValueMerge& merge, Scratch& scratch) const;
  struct LocalFace;
  LocalFace local_face(const ShownInstance& showing, std::uint32_t f, const PlannedCollapse& planned,
                       const ScreenVertex* merged) const;
  void add_change(double limit, Scratch& scratch, PartialChange& part) const;
  void look_at(std::size_t view, Scratch& scratch) const;
  void lay_faces(std::size_t view, Scratch& scratch) const;
  void lay_spans(std::size_t view, std::size_t i, Scratch& scratch) const;
  const FaceValues::Shading& shading(Scratch& scratch, std::size_t i, std::size_t view) const;
  static Fragment nearest_that_stays(const FragmentLists& lists, std::size_t pixel, const Scratch& scratch);
  template <class Change>
  void for_changes(std::size_t view, Scratch& scratch, Change&& change) const;
  template <class Change>
  void ask(std::size_t view, int x, int y, float nearness, std::uint32_t face, Scratch& scratch,
           Change&& change) const;
  std::int64_t change_of_image(std::size_t view, Scratch& scratch) const;
  std::int64_t change_of_entropy(std::size_t view, Scratch& scratch) const;

  const CollapseState& state_;
  ShownSurface& shown_;
  const FaceValues& values_;
  const ViewMeasure measure_;
  Team& team_;
  std::vector<ViewState> views_;
  std::vector<std::int64_t> n_log_n_;  // [#pixels + 1] n log₂ n, in units of 1 / log_scale_
  double log_scale_ = 1;
};

}  // namespace fovea
