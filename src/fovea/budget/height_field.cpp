#include "fovea/budget/height_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "fovea/base/error.h"

namespace fovea {

namespace {

constexpr double kUpright = 1e-4;    // Faces that look up less than this are walls.
constexpr double kUneven = 0.01;     // of a step
constexpr int kMostCells = 1 << 14;  // along a side

double along(Vec3d p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
double along(Vec3f p, int axis) { return along(Vec3d(p), axis); }

/// The axes of columns and rows.
std::array<int, 2> ground_axes(int up) { return {up == 0 ? 1 : 0, up == 2 ? 1 : 2}; }

/// The faces of a mesh that look along an axis.
std::vector<std::uint32_t> faces_up(const TriMesh& mesh, int axis, double sign) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const auto& t = mesh.triangles[f];
    const Vec3d a(mesh.positions[t[0].index()]), b(mesh.positions[t[1].index()]),
        c(mesh.positions[t[2].index()]);
    const Vec3d normal = cross(b - a, c - a);
    if (sign * along(normal, axis) > kUpright * length(normal)) faces.push_back(f);
  }
  return faces;
}

/// Evenly spaced numbers behind a list of them, most given many times.
struct Steps {
  double first = 0, step = 0;
  int count = 0;

  int index(double x) const { return static_cast<int>(std::lround((x - first) / step)); }
};

std::optional<Steps> even_steps(std::vector<double> numbers) {
  std::ranges::sort(numbers);
  double widest = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i) widest = std::max(widest, numbers[i] - numbers[i - 1]);
  if (!(widest > 0)) return {};
  int count = 1;
  for (std::size_t i = 1; i < numbers.size(); ++i) count += numbers[i] - numbers[i - 1] > widest / 2 ? 1 : 0;
  const Steps steps{numbers.front(), (numbers.back() - numbers.front()) / std::max(count - 1, 1), count};
  for (const double x : numbers) {
    if (std::abs(x - steps.first - steps.step * steps.index(x)) > kUneven * steps.step) return {};
  }
  return steps;
}

/// Looks for land along one axis.
class Search {
 public:
  Search(const TriMesh& mesh, int up, double sign) : mesh_(mesh), faces_(faces_up(mesh, up, sign)) {
    field_.up = up;
    const auto [u, v] = ground_axes(up);
    Vec3d across, down;
    (u == 0 ? across.x : across.y) = 1;
    (v == 1 ? down.y : down.z) = 1;
    field_.turned = sign * along(cross(across, down), up) < 0;
  }

  std::size_t face_count() const { return faces_.size(); }

  HeightFieldSearch run() {
    if (faces_.empty()) return {{}, "no face looks up"};
    const std::uint32_t part = mesh_.face_part[faces_[0]];
    for (const std::uint32_t f : faces_) {
      if (mesh_.face_part[f] != part) return {{}, "its land has several materials"};
    }
    std::string why_not = find_grid();
    if (why_not.empty()) why_not = check_cells();
    if (why_not.empty()) why_not = take_layers();
    if (!why_not.empty()) return {{}, why_not};
    field_.part = mesh_.parts[part];
    field_.other_faces = mesh_.face_count() - faces_.size();
    return {std::move(field_), {}};
  }

 private:
  std::string find_grid() {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t f : faces_) {
      for (const VertexId v : mesh_.triangles[f]) vertices.push_back(v.value);
    }
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::array<Steps, 2> steps;
    const std::array<int, 2> axes = ground_axes(field_.up);
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<double> numbers;
      for (const std::uint32_t v : vertices) numbers.push_back(along(mesh_.positions[v], axes[k]));
      const std::optional<Steps> found = even_steps(std::move(numbers));
      if (!found) return "its vertices do not lie on a regular grid";
      steps[k] = *found;
    }
    field_.columns = steps[0].count;
    field_.rows = steps[1].count;
    const std::size_t count =
        static_cast<std::size_t>(field_.columns) * static_cast<std::size_t>(field_.rows);
    if (count != vertices.size()) return "its vertices do not lie on a regular grid";
    point_of_.assign(mesh_.vertex_count(), kInvalid);
    field_.points.resize(count);
    std::vector<bool> is_taken(count, false);
    for (const std::uint32_t v : vertices) {
      const Vec3f p = mesh_.positions[v];
      const auto point = static_cast<std::size_t>(steps[1].index(along(p, axes[1]))) *
                             static_cast<std::size_t>(field_.columns) +
                         static_cast<std::size_t>(steps[0].index(along(p, axes[0])));
      if (is_taken[point]) return "it has two heights at one place";
      is_taken[point] = true;
      field_.points[point] = p;
      point_of_[v] = static_cast<std::uint32_t>(point);
    }
    return {};
  }

  /// Two faces to each cell, on either side of one of its diagonals.
  std::string check_cells() const {
    const int columns = field_.columns;
    constexpr int kNone = 0, kDone = 5;
    std::vector<int> state(field_.points.size(), kNone);  // or 1 + the corner that the one face leaves out
    for (const std::uint32_t f : faces_) {
      std::array<int, 2> low{}, high{};
      std::array<std::array<int, 2>, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto point = static_cast<int>(point_of_[mesh_.triangles[f][i].index()]);
        corners[i] = {point % columns, point / columns};
        for (std::size_t k = 0; k < 2; ++k) {
          low[k] = i == 0 ? corners[i][k] : std::min(low[k], corners[i][k]);
          high[k] = i == 0 ? corners[i][k] : std::max(high[k], corners[i][k]);
        }
      }
      if (high[0] - low[0] != 1 || high[1] - low[1] != 1)
        return "a triangle covers other than half a cell of its grid";
      int missing = 0 + 1 + 2 + 3;
      for (const auto& [x, y] : corners) missing -= (x - low[0]) + 2 * (y - low[1]);
      int& cell = state[static_cast<std::size_t>(low[1]) * static_cast<std::size_t>(columns) +
                        static_cast<std::size_t>(low[0])];
      if (cell != kNone && cell != 1 + (3 - missing)) return "two of its triangles overlap";
      cell = cell == kNone ? 1 + missing : kDone;
    }
    for (int y = 0; y + 1 < field_.rows; ++y) {
      for (int x = 0; x + 1 < columns; ++x) {
        if (state[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(x)] != kDone)
          return "its grid has holes";
      }
    }
    return {};
  }

  std::string take_layers() {
    for (const AttributeLayer& layer : mesh_.layers) {
      AttributeLayer grid = layer;
      grid.corner_value.clear();
      const auto width = static_cast<std::size_t>(layer.width);
      grid.values.assign(field_.points.size() * width, 0.0f);
      std::vector<ValueId> value_of(field_.points.size());
      for (const std::uint32_t f : faces_) {
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t point = point_of_[mesh_.triangles[f][k].index()];
          const ValueId value = layer.corner_value[std::size_t{3} * f + k];
          if (!value.valid()) return "an attribute is missing in places";
          if (!value_of[point].valid()) {
            value_of[point] = value;
            std::copy_n(layer.value(value), width,
                        grid.values.begin() + static_cast<std::ptrdiff_t>(point * width));
          }
          if (value_of[point] != value) return "it has seams inside of its land";
        }
      }
      field_.layers.push_back(std::move(grid));
    }
    return {};
  }

  const TriMesh& mesh_;
  std::vector<std::uint32_t> faces_;
  std::vector<std::uint32_t> point_of_;  // [#V]
  HeightField field_;
};

/// A point of the larger grid.
struct Point {
  int x = 0, y = 0;
};
/// A triangle of the larger grid, counter-clockwise; a – b is its longest edge.
struct Triangle {
  Point a, b, c;

  Point middle() const { return {(a.x + b.x) / 2, (a.y + b.y) / 2}; }
  bool can_split() const { return std::abs(a.x - b.x) > 1 || std::abs(a.y - b.y) > 1; }
  std::array<Triangle, 2> halves() const {
    const Point m = middle();
    return {{{c, a, m}, {b, c, m}}};
  }
};

std::array<Triangle, 2> roots(int side) {
  return {{{{side, side}, {0, 0}, {side, 0}}, {{0, 0}, {side, side}, {0, side}}}};
}

/// Calls f for all triangles `depth` splits below.
template <class F>
void for_each_at(const Triangle& triangle, int depth, F& f) {
  if (depth == 0) {
    f(triangle);
  } else if (triangle.can_split()) {
    for (const Triangle& half : triangle.halves()) for_each_at(half, depth - 1, f);
  }
}

/// A height field as the corner of a grid of 2^n cells a side.
class LargerGrid {
 public:
  explicit LargerGrid(const HeightField& field) : field_(field) {
    while (side_ < std::max(field.columns, field.rows) - 1) side_ *= 2;
  }
  int side() const { return side_; }
  std::size_t index(Point p) const {
    return static_cast<std::size_t>(p.y) * static_cast<std::size_t>(side_ + 1) +
           static_cast<std::size_t>(p.x);
  }
  Point clamped(Point p) const { return {std::min(p.x, field_.columns - 1), std::min(p.y, field_.rows - 1)}; }
  Triangle clamped(const Triangle& t) const { return {clamped(t.a), clamped(t.b), clamped(t.c)}; }
  /// Of the field.
  std::size_t point(Point p) const {
    const Point at = clamped(p);
    return static_cast<std::size_t>(at.y) * static_cast<std::size_t>(field_.columns) +
           static_cast<std::size_t>(at.x);
  }
  double height(Point p) const { return along(field_.points[point(p)], field_.up); }
  bool has_area(const Triangle& t) const { return doubled_area(clamped(t)) != 0; }

  /// How far the field is from a triangle with area.
  double error(const Triangle& triangle, HeightError kind, std::span<const float> weights) const {
    const Triangle t = clamped(triangle);
    const auto area = static_cast<double>(doubled_area(t));
    const std::array<double, 3> heights{height(t.a), height(t.b), height(t.c)};
    const auto [left, right] = std::minmax({t.a.x, t.b.x, t.c.x});
    const auto [top, bottom] = std::minmax({t.a.y, t.b.y, t.c.y});
    double result = 0;
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const Point p{x, y};
        const std::int64_t a = doubled_area({p, t.b, t.c}), b = doubled_area({t.a, p, t.c}),
                           c = doubled_area({t.a, t.b, p});
        if (a < 0 || b < 0 || c < 0) continue;
        const double flat = (static_cast<double>(a) * heights[0] + static_cast<double>(b) * heights[1] +
                             static_cast<double>(c) * heights[2]) /
                            area;
        double distance = std::abs(height(p) - flat);
        if (!weights.empty()) distance *= static_cast<double>(weights[point(p)]);
        result = kind == HeightError::largest ? std::max(result, distance) : result + distance * distance;
      }
    }
    return result;
  }

 private:
  static std::int64_t doubled_area(const Triangle& t) {
    return std::int64_t{t.b.x - t.a.x} * (t.c.y - t.a.y) - std::int64_t{t.b.y - t.a.y} * (t.c.x - t.a.x);
  }

  const HeightField& field_;
  int side_ = 1;
};

/// A split and what it is for.
struct Split {
  std::uint32_t point = 0;  ///< Index in the larger grid.
  int depth = 0;
  float error = 0;
  std::uint32_t more = 0;  ///< Triangles that it adds.
};

}  // namespace

HeightFieldSearch find_height_field(const Model& model) {
  const std::vector<std::vector<Mat4>> shown = mesh_instances(model);
  std::optional<std::size_t> mesh;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (shown[m].empty() || model.meshes[m].surface.face_count() == 0) continue;
    if (mesh || shown[m].size() > 1) return {{}, "it shows more than one mesh"};
    mesh = m;
  }
  if (!mesh) return {{}, "it shows no triangles"};
  const TriMesh& surface = model.meshes[*mesh].surface;
  if (surface.target_count() > 0 || !model.skins.empty() || !model.animations.empty())
    return {{}, "it moves"};
  HeightFieldSearch result;
  std::size_t most = 0;
  for (const int up : {1, 2, 0}) {
    for (const double sign : {1.0, -1.0}) {
      Search search(surface, up, sign);
      const std::size_t faces = search.face_count();
      HeightFieldSearch found = search.run();
      if (found.field) {
        found.field->mesh = static_cast<std::uint32_t>(*mesh);
        found.field->to_world = shown[*mesh][0];
        return found;
      }
      // Most is said by the way that most faces look.
      if (faces <= most) continue;
      most = faces;
      result.why_not = std::move(found.why_not);
    }
  }
  return result;
}

QuadtreeLevels::QuadtreeLevels(const HeightField& field, HeightError error, std::span<const float> weights)
    : field_(field) {
  if (std::max(field.columns, field.rows) > kMostCells + 1)
    throw Error(ErrorKind::limit,
                fmt::format("a height field of {} x {} points is too large", field.columns, field.rows));
  if (!weights.empty() && weights.size() != field.points.size())
    throw Error(ErrorKind::usage, "weights of another height field");
  const LargerGrid grid(field);
  side_ = grid.side();
  const std::size_t count = grid.index({side_, side_}) + 1;
  std::vector<double> errors(count, 0.0);
  std::vector<std::uint8_t> more(count, 0);
  std::vector<Split> splits;
  int depths = 0;
  while ((1 << depths) < side_) ++depths;
  for (int depth = 2 * depths - 1; depth >= 0; --depth) {
    const auto visit = [&](auto&& f) {
      const auto with_area = [&](const Triangle& t) {
        if (grid.has_area(t)) f(t);
      };
      for (const Triangle& root : roots(side_)) for_each_at(root, depth, with_area);
    };
    visit([&](const Triangle& t) {
      const std::size_t m = grid.index(t.middle());
      const double own = grid.error(t, error, weights);
      errors[m] = error == HeightError::largest ? std::max(errors[m], own) : errors[m] + own;
    });
    // By now the errors of this depth are all there, and those below are final.
    visit([&](const Triangle& t) {
      const std::size_t m = grid.index(t.middle());
      int halves = 0;
      for (const Triangle& half : t.halves()) {
        halves += grid.has_area(half) ? 1 : 0;
        if (half.can_split()) errors[m] = std::max(errors[m], errors[grid.index(half.middle())]);
      }
      if (more[m] == 0) splits.push_back({static_cast<std::uint32_t>(m), depth, 0, 0});
      more[m] = static_cast<std::uint8_t>(more[m] + halves);  // of which one was there before
    });
    visit([&](const Triangle& t) { --more[grid.index(t.middle())]; });
  }
  for (Split& split : splits) {
    split.error = static_cast<float>(errors[split.point]);
    split.more = more[split.point];
  }
  // What a split needs comes before it: its error is as large at least, and it lies higher.
  std::ranges::sort(splits, [](const Split& a, const Split& b) {
    return std::tuple(-a.error, a.depth, a.point) < std::tuple(-b.error, b.depth, b.point);
  });
  rank_.assign(count, kInvalid);
  errors_.reserve(splits.size());
  triangles_.reserve(splits.size() + 1);
  triangles_.push_back(2);
  for (std::size_t i = 0; i < splits.size(); ++i) {
    rank_[splits[i].point] = static_cast<std::uint32_t>(i);
    errors_.push_back(splits[i].error);
    triangles_.push_back(triangles_.back() + splits[i].more);
  }
}

std::size_t QuadtreeLevels::splits_to(std::uint64_t triangles) const {
  const auto after = std::ranges::upper_bound(triangles_, triangles);
  return after == triangles_.begin() ? 0 : static_cast<std::size_t>(after - triangles_.begin()) - 1;
}

std::size_t QuadtreeLevels::splits_for(double error) const {
  const auto enough =
      std::ranges::partition_point(errors_, [&](float e) { return static_cast<double>(e) > error; });
  return static_cast<std::size_t>(enough - errors_.begin());
}

TriMesh QuadtreeLevels::level(std::size_t splits) const {
  const LargerGrid grid(field_);
  std::vector<std::uint32_t> vertex_of(field_.points.size(), kInvalid);
  std::vector<std::uint32_t> point_of;
  TriMesh mesh;
  mesh.parts = {field_.part};
  const auto vertex = [&](Point p) {
    const std::size_t point = grid.point(p);
    if (vertex_of[point] == kInvalid) {
      vertex_of[point] = static_cast<std::uint32_t>(point_of.size());
      point_of.push_back(static_cast<std::uint32_t>(point));
      mesh.positions.push_back(field_.points[point]);
    }
    return VertexId{vertex_of[point]};
  };
  const auto add = [&](const auto& self, const Triangle& t) -> void {
    if (!grid.has_area(t)) return;
    if (t.can_split() && rank_[grid.index(t.middle())] < splits) {
      for (const Triangle& half : t.halves()) self(self, half);
      return;
    }
    const VertexId a = vertex(t.a), b = vertex(t.b), c = vertex(t.c);
    mesh.triangles.push_back(field_.turned ? std::array{a, c, b} : std::array{a, b, c});
  };
  for (const Triangle& root : roots(side_)) add(add, root);
  mesh.face_part.assign(mesh.face_count(), 0);
  for (const AttributeLayer& source : field_.layers) {
    AttributeLayer layer = source;
    layer.values.clear();
    for (const std::uint32_t point : point_of) {
      const float* value = source.value(ValueId{point});
      layer.values.insert(layer.values.end(), value, value + source.width);
    }
    for (const auto& triangle : mesh.triangles) {
      for (const VertexId v : triangle) layer.corner_value.push_back(ValueId{v.index()});
    }
    mesh.layers.push_back(std::move(layer));
  }
  return mesh;
}

Model with_level(const Model& model, const HeightField& field, TriMesh level) {
  Model result = model;
  level.position_storage = model.meshes[field.mesh].surface.position_storage;
  result.meshes[field.mesh].surface = std::move(level);
  return result;
}

}  // namespace fovea
