#include "fovea/simplify/view_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/base/prefetch.h"
#include "fovea/base/wide.h"

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

/// Notes a face at the pixels [begin, end) of a row where it is nearer than what is noted of them from x0 on.
FOVEA_WIDE void lay_span(const NearnessPlane& plane, int y, int x0, int begin, int end, std::uint32_t number,
                         float* __restrict nearness, std::uint32_t* __restrict nearest) {
  const auto row = static_cast<float>(plane.at_0 + plane.dy * y), slope = static_cast<float>(plane.dx);
  const float low = plane.low, high = plane.high;
  for (int x = begin; x < end; ++x) {
    const float n = std::clamp(row + slope * static_cast<float>(x), low, high);
    const float known = nearness[x - x0];
    nearest[x - x0] = n > known ? number : nearest[x - x0];
    nearness[x - x0] = n > known ? n : known;
  }
}

}  // namespace

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
  Scratch(std::size_t shown_faces, std::size_t width, std::size_t value_count)
      : changed_by(shown_faces + 1, 0), local(width), nearness(width), delta(value_count, 0) {}

  /// A face as a view would see it, and the pixels in which it would be in front.
  struct Seen {
    bool before = false, after = false;  // whether the view sees it at all
    std::array<ScreenVertex, 3> corners;
    NearnessPlane plane;
    std::optional<FaceValues::Shading> shading;
    std::vector<FaceValues::Pixel> pixels;
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

  /// What a face covers of a row.
  struct Span {
    int begin = 0, end = 0;
    std::uint32_t face = 0;  // counted from 1; 0: before the collapse
    std::uint32_t next = kInvalid;
  };
  /// What all of them cover.
  struct Row {
    int begin = std::numeric_limits<int>::max(), end = 0;
    std::uint32_t first_span = kInvalid;
  };
  /// A view of the faces.
  struct Sight {
    void add_span(int y, int begin, int end, std::uint32_t face) {
      Row& row = rows[static_cast<std::size_t>(y - top)];
      row.begin = std::min(row.begin, begin);
      row.end = std::max(row.end, end);
      spans.push_back({begin, end, face, row.first_span});
      row.first_span = static_cast<std::uint32_t>(spans.size() - 1);
    }

    std::vector<Seen> seen;  // [#faces] or more
    int top = 0;
    std::vector<Row> rows;    // from there on
    std::vector<Span> spans;  // in each row by face
  };
  Sight& sight(std::size_t view) { return sights[view % 2]; }

  std::vector<std::uint32_t> changed_by;  // [#shown faces + 1], the last collapse that changes them
  std::uint32_t collapse = 0;
  std::vector<LocalFace> faces;                // by shown number
  std::vector<std::optional<FaceLook>> looks;  // [#faces]
  std::array<Sight, 2> sights;                 // of a view and the next
  // Of a row of the view, from the first pixel that is covered:
  std::vector<std::uint32_t> local;      // the nearest face after the collapse, counted from 1,
  std::vector<float> nearness;           // and how near it is
  std::vector<std::uint32_t> values;     // of pixels that are shaded
  std::vector<PlannedCollapse> planned;  // [#showings of the slot]
  std::vector<ScreenVertex> merged;      // [#showings of the slot][#views]
  std::vector<int> delta;                // [#values], pixels more after the collapse (entropy)
  std::vector<std::uint32_t> in_delta;   // where that may not be 0
};

ViewCost::~ViewCost() = default;

ViewCost::ViewCost(const CollapseState& state, ShownSurface& shown, const FaceValues& values,
                   ViewMeasure measure, int size, std::vector<std::vector<std::uint32_t>> originals,
                   const Context& context)
    : state_(state), shown_(shown), values_(values), measure_(measure), context_(context) {
  views_.assign(shown.view_count(), {FragmentLists(size, size, values.background()), {}});
  const std::size_t pixels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
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
        view.count[values.background()] = static_cast<std::uint32_t>(pixels);
      }
      for (const ShownInstance& showing : shown.showings()) {
        const std::uint32_t first = state.slots[showing.slot].first_face;
        const std::uint32_t last = first + state.face_count(showing.slot);
        for (std::uint32_t f = first; f < last; ++f) {
          if (state.mesh.face_alive(f)) put_in(v, showing, f);
        }
      }
      if (measure == ViewMeasure::entropy) continue;
      for (std::size_t p = 0; p < pixels; ++p) {
        const std::uint32_t now = view.lists.front(p).first.value;
        const std::uint32_t first = originals.empty() ? now : originals[v][p];
        view.lists.notes(p) = {first, static_cast<std::uint32_t>(squared_difference(now, first))};
      }
    }
  });
}

std::shared_ptr<ViewCost::Scratch> ViewCost::make_scratch() const {
  return std::make_shared<Scratch>(shown_.face_count(), static_cast<std::size_t>(views_[0].lists.width()),
                                   measure_ == ViewMeasure::entropy ? values_.value_count() : 0);
}

std::array<ScreenVertex, 3> ViewCost::corners(std::size_t view, const ShownInstance& showing,
                                              std::uint32_t f) const {
  std::array<ScreenVertex, 3> v;
  for (std::size_t k = 0; k < 3; ++k) v[k] = shown_.vertex(showing, state_.mesh.faces[f].vertex[k])[view];
  return v;
}

// --- What is shown ---------------------------------------------------------------------------------------

void ViewCost::swap_value(ViewState& view, std::size_t pixel, const Fragment& before,
                          const Fragment& after) const {
  if (measure_ == ViewMeasure::entropy) {
    --view.count[before.value];
    ++view.count[after.value];
  } else {
    std::array<std::uint32_t, 2>& notes = view.lists.notes(pixel);
    notes[1] = static_cast<std::uint32_t>(squared_difference(after.value, notes[0]));
  }
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
      [&](std::size_t p, const Fragment& before, const Fragment& after) {
        swap_value(view, p, before, after);
      });
}

void ViewCost::take_out(std::size_t v, const ShownInstance& showing, std::uint32_t f) {
  const std::array<ScreenVertex, 3> at = corners(v, showing, f);
  if (!ShownSurface::is_seen(at, shown_.is_double_sided(f), showing.mirrored)) return;
  ViewState& view = views_[v];
  view.lists.remove(shown_.shown_face(showing, f), at,
                    [&](std::size_t p, const Fragment& before, const Fragment& after) {
                      swap_value(view, p, before, after);
                    });
}

/// Calls change(view, showing, face) for all of them, views in parallel if there is enough to do.
template <class Change>
void ViewCost::for_showings(std::span<const std::uint32_t> faces, Change&& change) {
  constexpr double kMuch = 2000;  // fragments, which take some tens of nanoseconds each
  const double depth =
      static_cast<double>(views_[0].lists.size()) / (static_cast<double>(state_.mesh.live_faces) + 1);
  const double fragments = depth * static_cast<double>(faces.size() * views_.size());
  parallel_for(context_, views_.size(), fragments > kMuch ? 1 : views_.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t v = begin; v < end; ++v) {
                   for (const std::uint32_t f : faces) {
                     for (const ShownInstance& showing : shown_.showings(state_.slot_of_face(f)))
                       change(v, showing, f);
                   }
                 }
               });
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
    part.sum += measure_ == ViewMeasure::image ? change_of_image(v, scratch) : change_of_entropy(v, scratch);
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

/// Notes how a view sees the faces and what they cover, before and after, and starts to load these pixels.
void ViewCost::look_at(std::size_t view, Scratch& scratch) const {
  const FragmentLists& lists = views_[view].lists;
  Scratch::Sight& sight = scratch.sight(view);
  std::int32_t top = std::numeric_limits<std::int32_t>::max(), bottom = 0;
  const auto is_seen = [&](const LocalFace& local, const std::array<ScreenVertex, 3>& v) {
    if (!ShownSurface::is_seen(v, local.double_sided, local.showing->mirrored)) return false;
    const auto [low, high] = std::minmax({v[0].y, v[1].y, v[2].y});
    top = std::min(top, low);
    bottom = std::max(bottom, high);
    return true;
  };
  const auto corners = [&](const std::array<const ScreenVertex*, 3>& v) {
    return std::array<ScreenVertex, 3>{v[0][view], v[1][view], v[2][view]};
  };
  for (std::size_t i = 0; i < scratch.faces.size(); ++i) {
    const LocalFace& local = scratch.faces[i];
    Scratch::Seen& seen = sight.seen[i];
    seen.before = is_seen(local, corners(local.before));
    seen.corners = corners(local.after);
    seen.after = !local.goes && is_seen(local, seen.corners);
    seen.shading.reset();
    seen.pixels.clear();
  }
  sight.top = std::max(top >> kSubsampleBits, 0);
  const int end = std::min((bottom >> kSubsampleBits) + 1, lists.height());
  sight.rows.assign(static_cast<std::size_t>(std::max(end - sight.top, 0)), {});
  sight.spans.clear();
  if (sight.rows.empty()) return;
  for (std::size_t i = scratch.faces.size(); i-- > 0;) {  // the last comes first in a row's list
    Scratch::Seen& seen = sight.seen[i];
    if (seen.before) {
      for_spans(corners(scratch.faces[i].before), lists.rect(),
                [&](int y, int x0, int x1, const NearnessPlane&) { sight.add_span(y, x0, x1, 0); });
    }
    if (!seen.after) continue;
    for_spans(seen.corners, lists.rect(), [&](int y, int x0, int x1, const NearnessPlane& plane) {
      seen.plane = plane;
      sight.add_span(y, x0, x1, static_cast<std::uint32_t>(i + 1));
    });
  }
  constexpr int kPerLine = 2;
  for (std::size_t r = 0; r < sight.rows.size(); ++r) {
    const Scratch::Row& row = sight.rows[r];
    for (int x = row.begin; x < row.end; x += kPerLine)
      prefetch(&lists.front(lists.pixel(x, sight.top + static_cast<int>(r))));
  }
}

/// Finds what is nearest after the collapse in row r of those that are covered.
void ViewCost::lay_row(std::size_t view, std::size_t r, Scratch& scratch) const {
  const Scratch::Sight& sight = scratch.sight(view);
  const Scratch::Row& row = sight.rows[r];
  const int y = sight.top + static_cast<int>(r);
  const auto count = static_cast<std::size_t>(row.end - row.begin);
  std::fill_n(scratch.nearness.data(), count, -std::numeric_limits<float>::infinity());
  std::fill_n(scratch.local.data(), count, 0u);
  for (std::uint32_t s = row.first_span; s != kInvalid; s = sight.spans[s].next) {
    const Scratch::Span& at = sight.spans[s];
    if (at.face == 0) continue;
    const NearnessPlane& plane = sight.seen[at.face - 1].plane;
    if (!scratch.faces[at.face - 1].has_holes) {
      lay_span(plane, y, row.begin, at.begin, at.end, at.face, scratch.nearness.data(), scratch.local.data());
      continue;
    }
    scratch.values.resize(static_cast<std::size_t>(at.end - at.begin));
    shading(scratch, at.face - 1, view).row(y, at.begin, at.end, scratch.values.data());
    plane.for_row(y, at.begin, at.end, [&](int x, float n) {
      if (scratch.values[static_cast<std::size_t>(x - at.begin)] == FragmentLists::kHole) return;
      const auto k = static_cast<std::size_t>(x - row.begin);
      if (!(n > scratch.nearness[k])) return;
      scratch.nearness[k] = n;
      scratch.local[k] = at.face;
    });
  }
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

/// Calls change(pixel as it is, value after) where something else would be in front.
template <class Change>
void ViewCost::for_changes(std::size_t v, Scratch& scratch, Change&& change) const {
  const FragmentLists& lists = views_[v].lists;
  Scratch::Sight& sight = scratch.sight(v);
  for (std::size_t r = 0; r < sight.rows.size(); ++r) {
    const Scratch::Row& row = sight.rows[r];
    if (row.first_span == kInvalid) continue;
    const int y = sight.top + static_cast<int>(r);
    lay_row(v, r, scratch);
    const FrontPixel* const fronts = &lists.front(lists.pixel(0, y));
    for (int x = row.begin; x < row.end; ++x) {
      const auto k = static_cast<std::size_t>(x - row.begin);
      const FrontPixel& front = fronts[x];
      const bool goes = scratch.changes(front.first);
      const float nearness = scratch.nearness[k], bound = goes ? front.second.nearness : front.first.nearness;
      const std::uint32_t local = scratch.local[k];
      bool is_first = nearness > bound;  // whatever of it stays
      if (!is_first && (goes || (nearness == bound && local != 0))) {
        const Fragment stays = !goes ? front.first : nearest_that_stays(lists, lists.pixel(x, y), scratch);
        is_first = local != 0 && Fragment{nearness, scratch.faces[local - 1].shown, 0}.is_before(stays);
        if (!is_first && goes) change(front, stays.value);
      }
      if (is_first)
        sight.seen[local - 1].pixels.push_back(
            {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)});
    }
  }
  for (std::size_t i = 0; i < scratch.faces.size(); ++i) {
    const std::vector<FaceValues::Pixel>& pixels = sight.seen[i].pixels;
    if (pixels.empty()) continue;
    scratch.values.resize(pixels.size());
    shading(scratch, i, v).at(pixels, scratch.values.data());
    for (std::size_t n = 0; n < pixels.size(); ++n)
      change(lists.front(lists.pixel(pixels[n].x, pixels[n].y)), scratch.values[n]);
  }
}

/// What is nearest at a pixel of all that the collapse does not change.
Fragment ViewCost::nearest_that_stays(const FragmentLists& lists, std::size_t pixel, const Scratch& scratch) {
  const FrontPixel& front = lists.front(pixel);
  if (!scratch.changes(front.second)) return front.second;
  for (const Fragment& fragment : lists.behind(pixel)) {
    if (!scratch.changes(fragment)) return fragment;
  }
  return lists.background();
}

std::int64_t ViewCost::change_of_image(std::size_t v, Scratch& scratch) const {
  std::int64_t sum = 0;
  for_changes(v, scratch, [&](const FrontPixel& pixel, std::uint32_t after) {
    sum += squared_difference(after, original(pixel)) - error(pixel);
  });
  return sum;
}

std::int64_t ViewCost::change_of_entropy(std::size_t v, Scratch& scratch) const {
  const ViewState& view = views_[v];
  const auto add = [&](std::uint32_t region, int pixels) {
    if (scratch.delta[region] == 0) scratch.in_delta.push_back(region);
    scratch.delta[region] += pixels;
  };
  // Neighbours mostly change alike.
  std::uint32_t from = 0, to = 0;
  int alike = 0;
  for_changes(v, scratch, [&](const FrontPixel& pixel, std::uint32_t after) {
    if (pixel.first.value != from || after != to) {
      add(from, -alike);
      add(to, alike);
      from = pixel.first.value;
      to = after;
      alike = 0;
    }
    ++alike;
  });
  add(from, -alike);
  add(to, alike);
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
  std::vector<std::uint32_t> values(static_cast<std::size_t>(lists.width()) *
                                    static_cast<std::size_t>(lists.height()));
  for (std::size_t p = 0; p < values.size(); ++p) values[p] = lists.front(p).first.value;
  return values;
}

double ViewCost::total() const {
  std::int64_t sum = 0;
  double bits = 0;
  for (const ViewState& view : views_) {
    if (measure_ == ViewMeasure::image) {
      const std::size_t pixels =
          static_cast<std::size_t>(view.lists.width()) * static_cast<std::size_t>(view.lists.height());
      for (std::size_t p = 0; p < pixels; ++p) sum += error(view.lists.front(p));
    } else {
      std::int64_t logs = 0;
      for (const std::uint32_t n : view.count) logs += n_log_n_[n];
      const std::size_t pixels = n_log_n_.size() - 1;
      bits += static_cast<double>(n_log_n_[pixels] - logs) / (log_scale_ * static_cast<double>(pixels));
    }
  }
  return measure_ == ViewMeasure::image ? static_cast<double>(sum) : bits;
}

std::size_t ViewCost::bytes() const {
  std::size_t sum = shown_.bytes() + n_log_n_.size() * sizeof(std::int64_t);
  for (const ViewState& view : views_) {
    sum += view.lists.bytes() + view.count.size() * sizeof(std::uint32_t);
  }
  return sum;
}

}  // namespace fovea
