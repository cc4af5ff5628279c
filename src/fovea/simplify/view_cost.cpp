#include "fovea/simplify/view_cost.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/base/prefetch.h"
#include "fovea/render/wide_triangle.h"
#include "fovea/simplify/local_blocks.h"
#include "fovea/simplify/view_cost_scratch.h"

namespace fovea {

namespace {

/// log₂ by the series of the area tangent: the same bits on every machine.
double log2_of(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // 0.5 … 1
  if (m < 0.7071) {
    m *= 2;
    --exponent;
  }
  const double s = (m - 1) / (m + 1), s2 = s * s;  // |s| < 0.172: thirteen terms leave nothing of a double
  double sum = 0;
  for (int k = 25; k >= 1; k -= 2) sum = sum * s2 + 1.0 / k;
  return exponent + 2 * s * sum * 1.4426950408889634;
}

/// More than go around an edge that is shown once.
constexpr std::size_t kMany = 32;

/// Without what fills up the last column.
std::size_t picture_pixels(const FragmentLists& lists) {
  return static_cast<std::size_t>(lists.width()) * static_cast<std::size_t>(lists.height());
}

std::size_t rounded_up(std::size_t n) { return (n + kWide - 1) / kWide * kWide; }

}  // namespace

ViewCost::~ViewCost() = default;

ViewCost::ViewCost(const CollapseState& state, ShownSurface& shown, const FaceValues& values,
                   ViewMeasure measure, int size, std::vector<std::vector<std::uint32_t>> originals,
                   const Context& context, Team& team)
    : state_(state), shown_(shown), values_(values), measure_(measure), team_(team) {
  std::size_t pixels = 0;  // of the largest
  for (std::size_t v = 0; v < shown.view_count(); ++v) {
    const int width = picture_width(shown.view(v), size);
    views_.push_back({FragmentLists(width, size, values.background()), {}, {}});
    pixels = std::max(pixels, picture_pixels(views_.back().lists));
  }
  if (measure == ViewMeasure::entropy) {
    const double most = static_cast<double>(pixels) * log2_of(static_cast<double>(pixels) + 1);
    log_scale_ = std::exp2(std::floor(61 - log2_of(most + 1)));
    n_log_n_.assign(pixels + 1, 0);
    for (std::size_t n = 1; n <= pixels; ++n) {
      const auto x = static_cast<double>(n);
      n_log_n_[n] = static_cast<std::int64_t>(std::floor(x * log2_of(x) * log_scale_ + 0.5));
    }
  }
  parallel_for(context, views_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      ViewState& view = views_[v];
      if (measure == ViewMeasure::entropy) {
        view.count.assign(values.value_count(), 0);
        view.count[values.background()] = static_cast<std::uint32_t>(picture_pixels(view.lists));
      }
      for (const ShownInstance& showing : shown.showings()) {
        const std::uint32_t first = state.slots[showing.slot].first_face;
        const std::uint32_t last = first + state.face_count(showing.slot);
        for (std::uint32_t f = first; f < last; ++f) {
          if (state.mesh.face_alive(f)) put_in(v, showing, f);
        }
      }
      if (measure == ViewMeasure::entropy) continue;
      std::vector<PackedColor> original = originals.empty() ? picture(v) : std::move(originals[v]);
      const int width = view.lists.width();
      mark_inside(original, width, size);
      view.original.resize(view.lists.pixel_count());
      for (std::size_t p = 0; p < view.original.size(); ++p) view.original[p] = view.lists.first(p).value;
      auto next = original.begin();
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < width; ++x) view.original[view.lists.pixel(x, y)] = *next++;
      }
    }
  });
}

std::shared_ptr<ViewCost::Scratch> ViewCost::make_scratch() const {
  auto scratch = std::make_shared<Scratch>(shown_.face_count(),
                                           measure_ == ViewMeasure::entropy ? values_.value_count() : 0);
  std::size_t width = 0;
  for (const ViewState& view : views_) width = std::max(width, static_cast<std::size_t>(view.lists.width()));
  for (Scratch::Sight& sight : scratch->sights) sight.columns.resize(rounded_up(width) / kWide);
  scratch->unclear.resize(static_cast<std::size_t>(views_[0].lists.height()) * kWide);
  return scratch;
}

std::array<ScreenVertex, 3> ViewCost::corners(std::size_t view, const ShownInstance& showing,
                                              std::uint32_t f) const {
  std::array<ScreenVertex, 3> v;
  for (std::size_t k = 0; k < 3; ++k) v[k] = shown_.vertex(showing, state_.mesh.faces[f].vertex[k])[view];
  return v;
}

// --- What is shown ---------------------------------------------------------------------------------------

void ViewCost::swap_value(ViewState& view, const Fragment& before, const Fragment& after) const {
  if (measure_ != ViewMeasure::entropy) return;
  --view.count[before.value];
  ++view.count[after.value];
}

void ViewCost::put_in(std::size_t v, const ShownInstance& showing, std::uint32_t f) {
  const std::array<ScreenVertex, 3> at = corners(v, showing, f);
  if (!ShownSurface::is_seen(at, shown_.is_double_sided(f), showing.mirrored)) return;
  const FaceLook look = values_.look(showing, f);
  const FaceValues::Shading shading(values_, look, at, v, showing.mirrored);
  ViewState& view = views_[v];
  view.lists.insert(
      shown_.shown_face(showing, f), at,
      [&](int y, int x0, int x1, std::uint32_t* out) { shading.row(y, x0, x1, out); },
      [&](std::size_t, const Fragment& before, const Fragment& after) { swap_value(view, before, after); });
}

void ViewCost::take_out(std::size_t v, const ShownInstance& showing, std::uint32_t f) {
  const std::array<ScreenVertex, 3> at = corners(v, showing, f);
  if (!ShownSurface::is_seen(at, shown_.is_double_sided(f), showing.mirrored)) return;
  ViewState& view = views_[v];
  view.lists.remove(
      shown_.shown_face(showing, f), at,
      [&](std::size_t, const Fragment& before, const Fragment& after) { swap_value(view, before, after); });
}

/// Calls change(view, showing, face) for all of them, views in parallel if there is enough to do.
template <class Change>
void ViewCost::for_showings(std::span<const std::uint32_t> faces, Change&& change) {
  constexpr double kMuch = 2000;  // fragments, which take some tens of nanoseconds each
  const double depth =
      static_cast<double>(views_[0].lists.size()) / (static_cast<double>(state_.mesh.live_faces) + 1);
  const double fragments = depth * static_cast<double>(faces.size() * views_.size());
  const auto in_view = [&](std::size_t v) {
    for (const std::uint32_t f : faces) {
      for (const ShownInstance& showing : shown_.showings(state_.slot_of_face(f))) change(v, showing, f);
    }
  };
  if (fragments > kMuch) {
    team_.run(views_.size(), in_view);
  } else {
    for (std::size_t v = 0; v < views_.size(); ++v) in_view(v);
  }
}

void ViewCost::put_in(std::span<const std::uint32_t> faces) {
  for_showings(faces,
               [&](std::size_t v, const ShownInstance& showing, std::uint32_t f) { put_in(v, showing, f); });
}

void ViewCost::take_out(std::span<const std::uint32_t> faces) {
  for_showings(
      faces, [&](std::size_t v, const ShownInstance& showing, std::uint32_t f) { take_out(v, showing, f); });
}

/// Where p lies between a and b, 0 … 1.
double ViewCost::along(std::uint32_t a, std::uint32_t b, Vec3d p) const {
  const Vec3d pa = state_.mesh.position(a), edge = state_.mesh.position(b) - pa;
  const double l2 = length_squared(edge);
  return l2 > 0 ? std::clamp(dot(p - pa, edge) / l2, 0.0, 1.0) : 0.5;
}

void ViewCost::move(std::uint32_t a, std::uint32_t b, Vec3d p) {
  const Vec3d rounded = in_single_precision(p);
  const auto [low, high] = std::minmax(a, b);
  shown_.move(b, low, high, rounded, along(low, high, rounded));
}

// --- What would change -----------------------------------------------------------------------------------

double ViewCost::change(std::uint32_t a, std::uint32_t b, Vec3d p, const ValueMerge& merge,
                        Scratch& scratch) const {
  PartialChange all;
  add_change(a, b, p, merge, std::numeric_limits<double>::infinity(), scratch, all);
  return amount(all);
}

void ViewCost::add_change(std::uint32_t a, std::uint32_t b, Vec3d p, const ValueMerge& merge, double limit,
                          Scratch& scratch, PartialChange& part) const {
  const Vec3d rounded = in_single_precision(p);  // as the engine keeps it
  scratch.begin_collapse();
  gather(a, b, rounded, merge, scratch);
  add_change(limit, scratch, part);
}

double ViewCost::amount(const PartialChange& part) const {
  const auto sum = static_cast<double>(part.sum);
  return measure_ == ViewMeasure::image ? sum : sum / (log_scale_ * static_cast<double>(n_log_n_.size() - 1));
}

double ViewCost::change_without(std::span<const std::uint32_t> faces, Scratch& scratch) const {
  scratch.begin_collapse();
  scratch.planned.assign(1, {});
  for (const std::uint32_t f : faces) {
    for (const ShownInstance& showing : shown_.showings(state_.slot_of_face(f))) {
      LocalFace local = local_face(showing, f, scratch.planned[0], nullptr);
      local.goes = true;
      scratch.add(local);
    }
  }
  PartialChange all;
  add_change(std::numeric_limits<double>::infinity(), scratch, all);
  return amount(all);
}

/// Adds the change by the faces that are gathered, in the views that `part` lacks.
void ViewCost::add_change(double limit, Scratch& scratch, PartialChange& part) const {
  // Of equally near ones the smaller number is in front: it comes first.
  std::sort(scratch.faces.begin(), scratch.faces.end(),
            [](const LocalFace& x, const LocalFace& y) { return x.shown < y.shown; });
  for (Scratch::Sight& sight : scratch.sights) {
    if (sight.seen.size() < scratch.faces.size()) sight.seen.resize(scratch.faces.size());
  }
  if (is_whole(part)) return;
  look_at(part.views, scratch);
  do {
    const std::size_t v = part.views++;
    if (!is_whole(part)) look_at(part.views, scratch);  // while its pixels come, this view is looked at
    if (scratch.sight(v).last >= 0)
      part.sum +=
          measure_ == ViewMeasure::image ? change_of_image(v, scratch) : change_of_entropy(v, scratch);
  } while (!is_whole(part) && amount(part) <= limit);
}

/// Notes the faces around the edge in all showings, as they are and as they would be.
void ViewCost::gather(std::uint32_t a, std::uint32_t b, Vec3d p, const ValueMerge& merge,
                      Scratch& scratch) const {
  const auto [low, high] = std::minmax(a, b);
  const double t = along(low, high, p);
  const std::span<const ShownInstance> showings = shown_.showings(state_.slot_of_vertex(a));
  scratch.merged.resize(showings.size() * views_.size());
  scratch.planned.clear();
  for (const ShownInstance& showing : showings)
    scratch.planned.push_back({a, b, p, &merge, shown_.to_world(showing, low, high, t)});
  for (std::size_t s = 0; s < showings.size(); ++s) {
    ScreenVertex* const merged = scratch.merged.data() + s * views_.size();
    shown_.project(showings[s], p, scratch.planned[s].world, merged);
    const auto add = [&](std::uint32_t c) {
      scratch.add(local_face(showings[s], c / 3, scratch.planned[s], merged));
    };
    for (const std::uint32_t c : state_.mesh.ring(a)) add(c);
    for (const std::uint32_t c : state_.mesh.ring(b)) {
      const CornerView at_c = state_.mesh.view(c);
      if (at_c.next != a && at_c.previous != a) add(c);
    }
  }
}

ViewCost::LocalFace ViewCost::local_face(const ShownInstance& showing, std::uint32_t f,
                                         const PlannedCollapse& planned, const ScreenVertex* merged) const {
  LocalFace local;
  local.showing = &showing;
  local.planned = &planned;
  local.face = f;
  local.shown = shown_.shown_face(showing, f);
  local.double_sided = shown_.is_double_sided(f);
  local.has_holes = values_.has_holes(f);
  int ends = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t v = state_.mesh.faces[f].vertex[k];
    const bool merges = v == planned.a || v == planned.b;
    ends += merges;
    local.before[k] = shown_.vertex(showing, v);
    local.after[k] = merges ? merged : local.before[k];
  }
  local.goes = ends == 2;
  return local;
}

/// Notes how a view sees the faces and what they may cover, before and after, and starts to load these
/// pixels.
void ViewCost::look_at(std::size_t view, Scratch& scratch) const {
  const FragmentLists& lists = views_[view].lists;
  Scratch::Sight& sight = scratch.sight(view);
  sight.clear();
  const auto corners = [&](const std::array<const ScreenVertex*, 3>& v) {
    return std::array<ScreenVertex, 3>{v[0][view], v[1][view], v[2][view]};
  };
  const auto is_seen = [&](const LocalFace& local, const std::array<ScreenVertex, 3>& v,
                           Scratch::Seen& seen) {
    if (!ShownSurface::is_seen(v, local.double_sided, local.showing->mirrored)) return false;
    seen.box = sample_box(v, lists.rect());
    if (seen.box.empty()) return false;
    seen.first_rows = sight.add(v, seen.box);
    return true;
  };
  for (std::size_t i = 0; i < scratch.faces.size(); ++i) {
    const LocalFace& local = scratch.faces[i];
    Scratch::Seen& seen = sight.seen[i];
    if (is_seen(local, corners(local.before), seen)) sight.going.push_back(local.shown);
    seen.corners = corners(local.after);
    seen.is_seen = !local.goes && is_seen(local, seen.corners, seen);
    seen.shading.reset();
  }
  const ViewState& state = views_[view];
  for (int column = sight.first; column <= sight.last; ++column) {
    const auto [begin, end] = sight.columns[static_cast<std::size_t>(column)];
    const FrontBlock* const blocks = lists.blocks(column);
    for (int y = begin; y < end; ++y) {
      prefetch(&blocks[y].nearness);
      prefetch(&blocks[y].value);
    }
    if (state.original.empty()) continue;
    constexpr int kPerLine = 2;
    for (int y = begin; y < end; y += kPerLine) prefetch(&state.original[lists.pixel(column * kColumn, y)]);
  }
}

/// Finds what is nearest after the collapse of the faces around the edge, and makes room for what they show.
void ViewCost::lay_faces(std::size_t view, Scratch& scratch) const {
  Scratch::Sight& sight = scratch.sight(view);
  const int height = sight.height();
  scratch.locals.resize(static_cast<std::size_t>(sight.last - sight.first + 1) *
                        static_cast<std::size_t>(height));
  LocalBlock* column_blocks = scratch.locals.data();
  for (int column = sight.first; column <= sight.last; ++column, column_blocks += height) {
    const auto [begin, end] = sight.columns[static_cast<std::size_t>(column)];
    if (begin < end) clear(column_blocks + (begin - sight.top), end - begin);
  }
  std::size_t room = 0;
  scratch.begin.assign(1, 0);
  for (std::size_t i = 0; i < scratch.faces.size(); ++i) {
    scratch.begin.push_back(static_cast<std::uint32_t>(room));
    const Scratch::Seen& seen = sight.seen[i];
    if (!seen.is_seen) continue;
    const auto columns =
        static_cast<std::size_t>((seen.box.right - 1) / kColumn - seen.box.left / kColumn + 1);
    for (const RowRange& rows : std::span(sight.rows).subspan(seen.first_rows, columns))
      room += static_cast<std::size_t>(std::max(rows.end - rows.begin, 0)) * kWide;
    if (!scratch.faces[i].has_holes && WideTriangle::fits(seen.corners)) {
      lay_face(WideTriangle(seen.corners, views_[view].lists.rect()), sight.rows.data() + seen.first_rows,
               static_cast<std::uint32_t>(i + 1), sight.first, sight.top, height, scratch.locals.data());
    } else {
      lay_spans(view, i, scratch);
    }
  }
  scratch.end = scratch.begin;
  for (std::vector<std::uint32_t>* const words :
       {&scratch.pixels, &scratch.before, &scratch.original, &scratch.after}) {
    if (words->size() < room) words->resize(room);
  }
}

/// The same for face i, one row after the other.
void ViewCost::lay_spans(std::size_t view, std::size_t i, Scratch& scratch) const {
  Scratch::Sight& sight = scratch.sight(view);
  const bool has_holes = scratch.faces[i].has_holes;
  for_spans(sight.seen[i].corners, views_[view].lists.rect(),
            [&](int y, int x0, int x1, const NearnessPlane& plane) {
              if (has_holes) {
                scratch.values.resize(static_cast<std::size_t>(x1 - x0));
                shading(scratch, i, view).row(y, x0, x1, scratch.values.data());
              }
              plane.for_row(y, x0, x1, [&](int x, float n) {
                if (has_holes && scratch.values[static_cast<std::size_t>(x - x0)] == FragmentLists::kHole)
                  return;
                const int column = x / kColumn - sight.first;
                LocalBlock& block =
                    scratch.locals[static_cast<std::size_t>(column * sight.height() + y - sight.top)];
                const auto lane = static_cast<std::size_t>(x % kColumn);
                if (!(n > block.nearness[lane])) return;
                block.nearness[lane] = n;
                block.face[lane] = static_cast<std::uint32_t>(i + 1);
              });
            });
}

/// What face i would show, made when it is first asked for.
const FaceValues::Shading& ViewCost::shading(Scratch& scratch, std::size_t i, std::size_t view) const {
  Scratch::Seen& seen = scratch.sight(view).seen[i];
  if (!seen.shading) {
    const LocalFace& local = scratch.faces[i];
    std::optional<FaceLook>& look = scratch.looks[i];
    if (!look) look = values_.look(*local.showing, local.face, local.planned);
    seen.shading.emplace(values_, *look, seen.corners, view, local.showing->mirrored);
  }
  return *seen.shading;
}

/// Calls change(n, values before, values after, originals) for groups of n pixels in which something else
/// would be in front. Arrays, which it may write to, have room for a multiple of kWide and are filled up with
/// the last pixel's; originals are for images.
template <class Change>
void ViewCost::for_changes(std::size_t v, Scratch& scratch, Change&& change) const {
  const ViewState& view = views_[v];
  Scratch::Sight& sight = scratch.sight(v);
  lay_faces(v, scratch);
  const FoundPixels found{scratch.pixels.data(), scratch.before.data(), scratch.original.data(),
                          scratch.end.data()};
  std::span<const std::uint32_t> changed_by;
  if (sight.going.size() > kMany) changed_by = scratch.changed_by;
  const LocalBlock* locals = scratch.locals.data();
  for (int column = sight.first; column <= sight.last; ++column, locals += sight.height()) {
    const auto [begin, end] = sight.columns[static_cast<std::size_t>(column)];
    if (begin >= end) continue;
    const int x = column * kColumn;
    const std::uint32_t* const originals =
        view.original.empty() ? nullptr : view.original.data() + view.lists.pixel(x, 0);
    const BlockColumn pixels{view.lists.blocks(column),
                             locals + (begin - sight.top),
                             originals,
                             begin,
                             end,
                             x,
                             view.lists.width() - x,
                             changed_by,
                             scratch.collapse};
    const std::size_t unclear = find_changes(pixels, sight.going, found, scratch.unclear.data());
    for (std::size_t n = 0; n < unclear; ++n) {
      const std::uint32_t pixel = scratch.unclear[n];
      const auto y = static_cast<int>(pixel >> 16);
      const std::size_t lane = pixel % kWide;
      const LocalBlock& local = locals[y - sight.top];
      ask(v, static_cast<int>(pixel & 0xFFFF), y, local.nearness[lane], local.face[lane], scratch, change);
    }
  }
  for (std::size_t i = 0; i < scratch.faces.size(); ++i) {
    const std::size_t first = scratch.begin[i + 1], count = scratch.end[i + 1] - first;
    if (count == 0) continue;
    for (std::vector<std::uint32_t>* const words : {&scratch.pixels, &scratch.before, &scratch.original}) {
      for (std::size_t n = count; n % kWide != 0; ++n) (*words)[first + n] = (*words)[first + count - 1];
    }
    std::uint32_t* const after = scratch.after.data() + first;
    shading(scratch, i, v).at(std::span(scratch.pixels).subspan(first, count), after);
    for (std::size_t n = count; n % kWide != 0; ++n) after[n] = after[count - 1];
    change(count, scratch.before.data() + first, after, scratch.original.data() + first);
  }
}

/// Of a pixel in which nothing is in front without doubt: it shows a face of the collapse now, or one of
/// equal nearness after it.
template <class Change>
void ViewCost::ask(std::size_t v, int x, int y, float nearness, std::uint32_t face, Scratch& scratch,
                   Change&& change) const {
  const ViewState& view = views_[v];
  const std::size_t pixel = view.lists.pixel(x, y);
  const Fragment front = view.lists.first(pixel);
  const bool goes = scratch.changes(front);
  const Fragment stays = goes ? nearest_that_stays(view.lists, pixel, scratch) : front;
  const std::uint32_t original = view.original.empty() ? 0 : view.original[pixel];
  if (face != 0 && Fragment{nearness, scratch.faces[face - 1].shown, 0}.is_before(stays)) {
    const std::uint32_t at = scratch.end[face]++;
    scratch.pixels[at] = static_cast<std::uint32_t>(x) + (static_cast<std::uint32_t>(y) << 16);
    scratch.before[at] = front.value;
    scratch.original[at] = original;
  } else if (goes) {
    std::array<std::uint32_t, kWide> before, after, originals;
    before.fill(front.value);
    after.fill(stays.value);
    originals.fill(original);
    change(std::size_t{1}, before.data(), after.data(), originals.data());
  }
}

/// What is nearest at a pixel of all that the collapse does not change.
Fragment ViewCost::nearest_that_stays(const FragmentLists& lists, std::size_t pixel, const Scratch& scratch) {
  const Fragment second = lists.front(pixel).second;
  if (!scratch.changes(second)) return second;
  for (const Fragment& fragment : lists.behind(pixel)) {
    if (!scratch.changes(fragment)) return fragment;
  }
  return lists.background();
}

std::int64_t ViewCost::change_of_image(std::size_t v, Scratch& scratch) const {
  std::int64_t sum = 0;
  for_changes(v, scratch,
              [&](std::size_t n, const std::uint32_t* before, const std::uint32_t* after,
                  const std::uint32_t* original) { sum += added_error(n, before, after, original); });
  return sum;
}

std::int64_t ViewCost::change_of_entropy(std::size_t v, Scratch& scratch) const {
  const ViewState& view = views_[v];
  const auto add = [&](std::uint32_t region, int pixels) {
    if (scratch.delta[region] == 0) scratch.in_delta.push_back(region);
    scratch.delta[region] += pixels;
  };
  for_changes(v, scratch,
              [&](std::size_t n, std::uint32_t* before, std::uint32_t* after, const std::uint32_t*) {
                const std::size_t count = keep_different(n, before, after);
                for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
                  // Neighbours mostly change alike.
                  while (end < count && before[end] == before[begin] && after[end] == after[begin]) ++end;
                  add(before[begin], -static_cast<int>(end - begin));
                  add(after[begin], static_cast<int>(end - begin));
                }
              });
  std::int64_t sum = 0;
  for (const std::uint32_t region : scratch.in_delta) {  // one may be there twice
    const std::uint32_t count = view.count[region];
    sum += n_log_n_[count + static_cast<std::uint32_t>(scratch.delta[region])] - n_log_n_[count];
    scratch.delta[region] = 0;
  }
  scratch.in_delta.clear();
  return std::abs(sum);
}

std::vector<std::uint32_t> ViewCost::picture(std::size_t view) const {
  const FragmentLists& lists = views_[view].lists;
  std::vector<std::uint32_t> values;
  values.reserve(lists.pixel_count());
  for (int y = 0; y < lists.height(); ++y) {
    for (int x = 0; x < lists.width(); ++x) values.push_back(lists.first(lists.pixel(x, y)).value);
  }
  return values;
}

double ViewCost::total() const {
  std::int64_t sum = 0;
  double bits = 0;
  for (const ViewState& view : views_) {
    if (measure_ == ViewMeasure::image) {
      for (std::size_t p = 0; p < view.original.size(); ++p)  // what fills up is equal
        sum += squared_difference(view.lists.first(p).value, view.original[p]);
    } else {
      std::int64_t logs = 0;
      for (const std::uint32_t n : view.count) logs += n_log_n_[n];
      const auto largest = static_cast<double>(n_log_n_.size() - 1);
      bits += static_cast<double>(n_log_n_[picture_pixels(view.lists)] - logs) / (log_scale_ * largest);
    }
  }
  return measure_ == ViewMeasure::image ? static_cast<double>(sum) : bits;
}

std::size_t ViewCost::bytes() const {
  std::size_t sum = shown_.bytes() + n_log_n_.size() * sizeof(std::int64_t);
  for (const ViewState& view : views_) {
    sum += view.lists.bytes() + (view.count.size() + view.original.size()) * sizeof(std::uint32_t);
  }
  return sum;
}

}  // namespace fovea
