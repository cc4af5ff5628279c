#include "fovea/simplify/view_cost.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "fovea/base/parallel.h"

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

}  // namespace

std::int64_t squared_difference(PackedColor x, PackedColor y) {
  const auto d = [&](int shift) {
    return static_cast<int>(x >> shift & 255) - static_cast<int>(y >> shift & 255);
  };
  const int r = d(0), g = d(8), b = d(16), coverage = d(24);
  return r * r + g * g + b * b + coverage * coverage / 8;
}

/// A face around the edge, in one showing.
struct ViewCost::LocalFace {
  const Showing* showing = nullptr;
  const PlannedCollapse* planned = nullptr;
  std::uint32_t face = 0, shown = 0;
  std::array<const ScreenVertex*, 3> before{}, after{};  // [#views]
  bool goes = false, double_sided = false, has_holes = false;
};

/// The faces around an edge and the pixels that they cover, before and after its collapse.
struct ViewCost::Scratch {
  Scratch(int view_width, int view_height, std::size_t shown_faces)
      : width(view_width),
        pixels(static_cast<std::size_t>(view_width) * static_cast<std::size_t>(view_height)),
        changed_by(shown_faces, 0),
        touched(pixels.size()) {}

  /// A face as the present view would see it.
  struct Seen {
    std::array<ScreenVertex, 3> corners;
    std::optional<FaceValues::Shading> shading;
  };
  struct Pixel {
    std::uint32_t view = 0;          // in which it was touched last
    std::uint32_t local = kInvalid;  // the nearest face after the collapse ...
    float nearness = 0;              // ... and how near it is
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
  /// Whether the collapse changes a shown face.
  bool changes(std::uint32_t shown) const { return changed_by[shown] == collapse; }

  void begin_view() {
    ++view;
    count = 0;
    seen.resize(faces.size());
  }
  void see(std::uint32_t i, const std::array<ScreenVertex, 3>& corners) {
    seen[i].corners = corners;
    seen[i].shading.reset();
  }
  Pixel& touch(int x, int y) {
    Pixel& p =
        pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    if (p.view != view) {
      p = {view, kInvalid, 0};
      touched[count++] = {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
    }
    return p;
  }

  int width;
  std::vector<Pixel> pixels;
  std::vector<std::uint32_t> changed_by;  // [#shown faces], the last collapse that changes them
  std::uint32_t collapse = 0, view = 0;
  std::vector<LocalFace> faces;
  std::vector<std::optional<FaceLook>> looks;         // [#faces]
  std::vector<Seen> seen;                             // [#faces]
  std::vector<std::array<std::uint16_t, 2>> touched;  // [#pixels], of which `count` count
  std::size_t count = 0;
  std::vector<PlannedCollapse> planned;  // [#showings of the slot]
  std::vector<ScreenVertex> merged;      // [#showings of the slot][#views]
  std::vector<std::pair<std::uint32_t, int>> deltas;
};

ViewCost::~ViewCost() = default;

ViewCost::ViewCost(const CollapseState& state, ShownSurface& shown, const FaceValues& values,
                   ViewMeasure measure, int size, const Context& context)
    : state_(state), shown_(shown), values_(values), measure_(measure) {
  views_.assign(shown.view_count(), {FragmentLists(size, size), {}, {}});
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
      for (const Showing& showing : shown.showings()) {
        const std::uint32_t first = state.slots[showing.slot].first_face;
        const std::uint32_t last = showing.slot + 1 < state.slots.size()
                                       ? state.slots[showing.slot + 1].first_face
                                       : static_cast<std::uint32_t>(state.mesh.faces.size());
        for (std::uint32_t f = first; f < last; ++f) {
          if (state.mesh.face_alive(f)) put_in(v, showing, f);
        }
      }
      if (measure == ViewMeasure::image) view.original = picture(v);
    }
  });
}

std::shared_ptr<ViewCost::Scratch> ViewCost::make_scratch() const {
  const FragmentLists& lists = views_.front().lists;
  return std::make_shared<Scratch>(lists.width(), lists.height(), shown_.face_count());
}

std::array<ScreenVertex, 3> ViewCost::corners(std::size_t view, const Showing& showing,
                                              std::uint32_t f) const {
  std::array<ScreenVertex, 3> v;
  for (std::size_t k = 0; k < 3; ++k) v[k] = shown_.vertex(showing, state_.mesh.faces[f].vertex[k])[view];
  return v;
}

// --- What is shown ---------------------------------------------------------------------------------------

void ViewCost::swap_value(ViewState& view, const Fragment* before, const Fragment* after) const {
  if (measure_ != ViewMeasure::entropy) return;
  --view.count[value_of(before)];
  ++view.count[value_of(after)];
}

void ViewCost::put_in(std::size_t v, const Showing& showing, std::uint32_t f) {
  const std::array<ScreenVertex, 3> at = corners(v, showing, f);
  if (!ShownSurface::is_seen(at, shown_.is_double_sided(f), showing.mirrored)) return;
  const FaceLook look = values_.look(showing, f);
  const FaceValues::Shading shading(values_, look, at, v, showing.mirrored);
  ViewState& view = views_[v];
  view.lists.insert(
      shown_.shown_face(showing, f), at,
      [&](int x, int y, std::uint32_t& value) { return shading.at(x, y, value); },
      [&](std::size_t, const Fragment* before, const Fragment* after) { swap_value(view, before, after); });
}

void ViewCost::take_out(std::size_t v, const Showing& showing, std::uint32_t f) {
  const std::array<ScreenVertex, 3> at = corners(v, showing, f);
  if (!ShownSurface::is_seen(at, shown_.is_double_sided(f), showing.mirrored)) return;
  ViewState& view = views_[v];
  view.lists.remove(
      shown_.shown_face(showing, f), at,
      [&](std::size_t, const Fragment* before, const Fragment* after) { swap_value(view, before, after); });
}

void ViewCost::put_in(std::span<const std::uint32_t> faces) {
  for (const std::uint32_t f : faces) {
    for (const Showing& showing : shown_.showings(state_.slot_of_face(f))) {
      for (std::size_t v = 0; v < views_.size(); ++v) put_in(v, showing, f);
    }
  }
}

void ViewCost::take_out(std::span<const std::uint32_t> faces) {
  for (const std::uint32_t f : faces) {
    for (const Showing& showing : shown_.showings(state_.slot_of_face(f))) {
      for (std::size_t v = 0; v < views_.size(); ++v) take_out(v, showing, f);
    }
  }
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
  const Vec3d rounded = in_single_precision(p);  // as the engine keeps it
  scratch.begin_collapse();
  gather(a, b, rounded, merge, scratch);
  return change(scratch);
}

double ViewCost::change_without(std::span<const std::uint32_t> faces, Scratch& scratch) const {
  scratch.begin_collapse();
  scratch.planned.assign(1, {});
  for (const std::uint32_t f : faces) {
    for (const Showing& showing : shown_.showings(state_.slot_of_face(f))) {
      LocalFace local = local_face(showing, f, scratch.planned[0], nullptr);
      local.goes = true;
      scratch.add(local);
    }
  }
  return change(scratch);
}

/// The change by the faces that are gathered.
double ViewCost::change(Scratch& scratch) const {
  std::int64_t sum = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (!lay_over(v, scratch)) continue;
    sum += measure_ == ViewMeasure::image ? change_of_image(views_[v], scratch)
                                          : change_of_entropy(views_[v], scratch);
  }
  if (measure_ == ViewMeasure::image) return static_cast<double>(sum);
  return static_cast<double>(sum) / (log_scale_ * static_cast<double>(n_log_n_.size() - 1));
}

/// Notes the faces around the edge in all showings, as they are and as they would be.
void ViewCost::gather(std::uint32_t a, std::uint32_t b, Vec3d p, const ValueMerge& merge,
                      Scratch& scratch) const {
  const auto [low, high] = std::minmax(a, b);
  const double t = along(low, high, p);
  const std::span<const Showing> showings = shown_.showings(state_.slot_of_vertex(a));
  scratch.merged.resize(showings.size() * views_.size());
  scratch.planned.clear();
  for (const Showing& showing : showings)
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

ViewCost::LocalFace ViewCost::local_face(const Showing& showing, std::uint32_t f,
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

/// Finds the pixels of a view that the faces cover before or after, and the nearest after. False if there are
/// none.
bool ViewCost::lay_over(std::size_t view, Scratch& scratch) const {
  scratch.begin_view();
  const FragmentLists& lists = views_[view].lists;
  for (std::uint32_t i = 0; i < scratch.faces.size(); ++i) {
    const LocalFace& local = scratch.faces[i];
    const auto in_view = [&](const std::array<const ScreenVertex*, 3>& v) {
      return std::array<ScreenVertex, 3>{v[0][view], v[1][view], v[2][view]};
    };
    const std::array<ScreenVertex, 3> before = in_view(local.before);
    if (ShownSurface::is_seen(before, local.double_sided, local.showing->mirrored)) {
      for_spans(before, lists.rect(), [&](int y, int x0, int x1, const NearnessPlane&) {
        for (int x = x0; x < x1; ++x) scratch.touch(x, y);
      });
    }
    if (local.goes) continue;
    const std::array<ScreenVertex, 3> after = in_view(local.after);
    if (!ShownSurface::is_seen(after, local.double_sided, local.showing->mirrored)) continue;
    scratch.see(i, after);
    for_spans(after, lists.rect(), [&](int y, int x0, int x1, const NearnessPlane& plane) {
      plane.for_row(y, x0, x1, [&](int x, float nearness) {
        Scratch::Pixel& pixel = scratch.touch(x, y);
        if (pixel.local != kInvalid &&
            (nearness < pixel.nearness ||
             (nearness == pixel.nearness && local.shown > scratch.faces[pixel.local].shown)))
          return;
        std::uint32_t value = 0;
        if (local.has_holes && !shading(scratch, i, view).at(x, y, value)) return;
        pixel.nearness = nearness;
        pixel.local = i;
      });
    });
  }
  return scratch.count > 0;
}

/// What face i would show, made when it is first asked for.
const FaceValues::Shading& ViewCost::shading(Scratch& scratch, std::uint32_t i, std::size_t view) const {
  Scratch::Seen& seen = scratch.seen[i];
  if (!seen.shading) {
    const LocalFace& local = scratch.faces[i];
    std::optional<FaceLook>& look = scratch.looks[i];
    if (!look) look = values_.look(*local.showing, local.face, local.planned);
    seen.shading.emplace(values_, *look, seen.corners, view, local.showing->mirrored);
  }
  return *seen.shading;
}

/// Calls change(pixel, value before, value after) where something else would be in front.
template <class Change>
void ViewCost::for_changes(const ViewState& view, Scratch& scratch, Change&& change) const {
  const auto number = static_cast<std::size_t>(&view - views_.data());
  for (const auto& [x, y] : std::span(scratch.touched).first(scratch.count)) {
    const std::size_t p = view.lists.pixel(x, y);
    const std::span<const Fragment> list = view.lists.at(p);
    const Scratch::Pixel& pixel = scratch.pixels[p];
    std::size_t stays = 0;
    while (stays < list.size() && scratch.changes(list[stays].triangle)) ++stays;
    const bool is_new =
        pixel.local != kInvalid &&
        (stays == list.size() ||
         Fragment{pixel.nearness, scratch.faces[pixel.local].shown, 0}.is_before(list[stays]));
    if (!is_new && stays == 0) continue;
    std::uint32_t after = values_.background();
    if (is_new) {
      if (!shading(scratch, pixel.local, number).at(x, y, after)) continue;
    } else if (stays < list.size()) {
      after = list[stays].value;
    }
    change(p, value_of(list.empty() ? nullptr : list.data()), after);
  }
}

std::int64_t ViewCost::change_of_image(const ViewState& view, Scratch& scratch) const {
  std::int64_t sum = 0;
  for_changes(view, scratch, [&](std::size_t p, std::uint32_t before, std::uint32_t after) {
    if (before == after) return;
    sum += squared_difference(after, view.original[p]) - squared_difference(before, view.original[p]);
  });
  return sum;
}

std::int64_t ViewCost::change_of_entropy(const ViewState& view, Scratch& scratch) const {
  auto& deltas = scratch.deltas;
  deltas.clear();
  const auto add = [&](std::uint32_t region, int pixels) {
    for (auto& [known, count] : deltas) {
      if (known != region) continue;
      count += pixels;
      return;
    }
    deltas.emplace_back(region, pixels);
  };
  for_changes(view, scratch, [&](std::size_t, std::uint32_t before, std::uint32_t after) {
    if (before == after) return;
    add(before, -1);
    add(after, 1);
  });
  std::int64_t sum = 0;
  for (const auto& [region, pixels] : deltas) {
    const std::uint32_t count = view.count[region];
    sum += n_log_n_[count + static_cast<std::uint32_t>(pixels)] - n_log_n_[count];
  }
  return std::abs(sum);
}

std::vector<std::uint32_t> ViewCost::picture(std::size_t view) const {
  const FragmentLists& lists = views_[view].lists;
  std::vector<std::uint32_t> values(static_cast<std::size_t>(lists.width()) *
                                    static_cast<std::size_t>(lists.height()));
  for (std::size_t p = 0; p < values.size(); ++p)
    values[p] = value_of(lists.at(p).empty() ? nullptr : lists.at(p).data());
  return values;
}

double ViewCost::total() const {
  std::int64_t sum = 0;
  double bits = 0;
  for (const ViewState& view : views_) {
    if (measure_ == ViewMeasure::image) {
      const std::vector<std::uint32_t> now = picture(static_cast<std::size_t>(&view - views_.data()));
      for (std::size_t p = 0; p < now.size(); ++p) sum += squared_difference(now[p], view.original[p]);
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
    sum += view.lists.bytes() + (view.original.size() + view.count.size()) * sizeof(std::uint32_t);
  }
  return sum;
}

}  // namespace fovea
