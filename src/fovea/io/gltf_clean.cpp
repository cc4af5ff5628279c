#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "fovea/io/gltf_column.h"

namespace fovea::gltf {

namespace {

Column* find(std::vector<Column>& columns, std::string_view name) {
  for (Column& c : columns) {
    if (c.name == name) return &c;
  }
  return nullptr;
}

Vec3d load(const Column& c, std::size_t v) {
  const float* x = c.values.data() + v * static_cast<std::size_t>(c.width);
  return {x[0], x[1], x[2]};
}

void store(Column& c, std::size_t v, Vec3d d) {
  float* x = c.values.data() + v * static_cast<std::size_t>(c.width);
  x[0] = static_cast<float>(d.x);
  x[1] = static_cast<float>(d.y);
  x[2] = static_cast<float>(d.z);
}

void clean_finite(Column& c, Context& context, const std::string& place) {
  std::uint64_t bad = 0;
  for (float& v : c.values) {
    if (std::isfinite(v)) continue;
    v = 0;
    ++bad;
  }
  if (bad > 0)
    context.report("not-finite", "numbers that are not finite became 0", place + "/" + c.name, bad);
}

/// How far from 1 a length may be: the Khronos validator tolerates 0.0067, which is what rounding to
/// bytes costs; floats are held to more, because nothing excuses them.
double length_tolerance(const Column& c) { return c.storage.type == ComponentType::f32 ? 5e-4 : 6e-3; }

bool is_unit(const Column& c, Vec3d d) { return std::abs(length(d) - 1) <= length_tolerance(c); }

/// Sums of the normals of the triangles around each vertex, weighted by area.
std::vector<Vec3d> triangle_normals(const ColumnPart& part) {
  std::vector<Vec3d> sums(part.vertex_count());
  const Column& positions = part.columns.front();
  for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
    const Vec3d a = load(positions, part.indices[i]);
    const Vec3d n = cross(load(positions, part.indices[i + 1]) - a, load(positions, part.indices[i + 2]) - a);
    for (std::size_t k = 0; k < 3; ++k) sums[part.indices[i + k]] += n;
  }
  return sums;
}

void clean_normals(ColumnPart& part, Column& c, Context& context, const std::string& place) {
  std::vector<Vec3d> substitutes;
  std::uint64_t zeros = 0;
  for (std::size_t v = 0; v < c.size(); ++v) {
    Vec3d n = load(c, v);
    if (is_unit(c, n)) continue;
    if (length(n) < std::numeric_limits<float>::min()) {
      if (substitutes.empty()) substitutes = triangle_normals(part);
      n = length(substitutes[v]) > 0 ? substitutes[v] : Vec3d{0, 0, 1};
      ++zeros;
    }
    store(c, v, normalized(n));
  }
  if (zeros > 0) {
    context.report("zero-normals", "normals without direction were made from the triangles", place, zeros);
  }
}

Vec3d any_perpendicular(Vec3d n) {
  const Vec3d axis = std::abs(n.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  return normalized(cross(n, axis));
}

void clean_tangents(ColumnPart& part, Column& c, Context& context, const std::string& place) {
  const Column* normals = find(part.columns, "NORMAL");
  std::uint64_t zeros = 0;
  for (std::size_t v = 0; v < c.size(); ++v) {
    float& sign = c.values[4 * v + 3];
    if (std::abs(sign) != 1) sign = sign < 0 ? -1.0f : 1.0f;
    Vec3d t = load(c, v);
    if (is_unit(c, t)) continue;
    if (length(t) < std::numeric_limits<float>::min()) {
      t = any_perpendicular(normals ? load(*normals, v) : Vec3d{0, 0, 1});
      ++zeros;
    }
    store(c, v, normalized(t));
  }
  if (zeros > 0) context.report("zero-tangents", "tangents without direction got one", place, zeros);
}

void clean_colors(Column& c, Context& context, const std::string& place) {
  std::uint64_t clamped = 0;
  for (float& v : c.values) {
    if (v >= 0 && v <= 1) continue;
    v = std::clamp(v, 0.0f, 1.0f);
    ++clamped;
  }
  if (clamped > 0) context.report("colors-clamped", "colours beyond 0..1 were clamped", place, clamped);
}

/// The influences of one vertex over all sets.
struct Influences {
  std::vector<double> joints, weights;

  /// Returns whether anything was wrong.
  bool merge_duplicates() {
    bool changed = false;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (weights[i] < 0) weights[i] = 0, changed = true;
      for (std::size_t j = 0; j < i && weights[i] > 0; ++j) {
        if (weights[j] == 0 || joints[j] != joints[i]) continue;
        weights[j] += weights[i];
        weights[i] = 0;
        changed = true;
      }
    }
    return changed;
  }

  double sum() const { return std::accumulate(weights.begin(), weights.end(), 0.0); }

  /// Makes the sum 1 in floats. Returns whether it was so far off that motion looks different.
  bool normalize() {
    const double total = sum();
    const auto used = std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0; });
    // The specification's validator allows 2e-7 for each weight that is not 0; half of it is kept for
    // readers that add up in floats.
    if (std::abs(total - 1) <= 1e-7 * static_cast<double>(used)) return false;
    for (double& w : weights) w = in_single_precision(w / total);
    *std::max_element(weights.begin(), weights.end()) += 1 - sum();
    return std::abs(total - 1) > 1e-3;
  }

  /// Sum exactly `full` in whole numbers: everyone gets the floor, the rest goes by largest remainder.
  void quantize(double full) {
    const double total = sum();
    std::vector<std::size_t> order(weights.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<double> remainder(weights.size());
    double left = full;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double share = weights[i] / total * full;
      weights[i] = std::floor(share);
      remainder[i] = share - weights[i];
      left -= weights[i];
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return remainder[a] > remainder[b]; });
    for (std::size_t i = 0; i < order.size() && left >= 1; ++i, --left) weights[order[i]] += 1;
    for (double& w : weights) w /= full;
  }

  void clear_unused_joints() {
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (weights[i] == 0) joints[i] = 0;
    }
  }
};

/// JOINTS_n and WEIGHTS_n of all n.
struct SkinColumns {
  std::vector<Column*> joints, weights;

  void load(std::size_t v, Influences& to) const {
    for (std::size_t s = 0; s < joints.size(); ++s) {
      for (std::size_t k = 0; k < 4; ++k) {
        to.joints[4 * s + k] = joints[s]->values[4 * v + k];
        to.weights[4 * s + k] = weights[s]->values[4 * v + k];
      }
    }
  }
  void store(std::size_t v, const Influences& from) const {
    for (std::size_t s = 0; s < joints.size(); ++s) {
      for (std::size_t k = 0; k < 4; ++k) {
        joints[s]->values[4 * v + k] = static_cast<float>(from.joints[4 * s + k]);
        weights[s]->values[4 * v + k] = static_cast<float>(from.weights[4 * s + k]);
      }
    }
  }
};

SkinColumns find_skin(std::vector<Column>& columns) {
  SkinColumns skin;
  for (int set = 0;; ++set) {
    Column* joints = find(columns, "JOINTS_" + std::to_string(set));
    Column* weights = find(columns, "WEIGHTS_" + std::to_string(set));
    if (!joints || !weights || joints->width != 4 || weights->width != 4) return skin;
    skin.joints.push_back(joints);
    skin.weights.push_back(weights);
  }
}

double full_scale(const Column& weights) {
  return weights.storage.type == ComponentType::f32  ? 0
         : weights.storage.type == ComponentType::u8 ? 255
                                                     : 65535;
}

void clean_skin(ColumnPart& part, Context& context, const std::string& place) {
  const SkinColumns skin = find_skin(part.columns);
  if (skin.joints.empty()) return;
  const double full = full_scale(*skin.weights.front());
  Influences influences{std::vector<double>(4 * skin.joints.size()),
                        std::vector<double>(4 * skin.joints.size())};
  std::uint64_t repaired = 0;
  for (std::size_t v = 0; v < part.vertex_count(); ++v) {
    skin.load(v, influences);
    bool changed = influences.merge_duplicates();
    if (influences.sum() == 0) {
      influences.weights[0] = 1;
      changed = true;
    }
    if (full > 0) {
      influences.quantize(full);
    } else {
      changed = influences.normalize() || changed;
    }
    influences.clear_unused_joints();
    skin.store(v, influences);
    repaired += changed ? 1 : 0;
  }
  if (repaired > 0) {
    context.report("weights-repaired", "joint weights were made to sum to 1 with each joint once", place,
                   repaired);
  }
}

}  // namespace

void clean_values(ColumnPart& part, Context& context, const std::string& place) {
  for (Column& c : part.columns) clean_finite(c, context, place);
  for (auto& target : part.targets) {
    for (Column& c : target) clean_finite(c, context, place);
  }
  for (Column& c : part.columns) {
    if (c.name == "NORMAL" && c.width == 3) clean_normals(part, c, context, place);
    if (c.name.starts_with("COLOR_")) clean_colors(c, context, place);
  }
  for (Column& c : part.columns) {
    if (c.name == "TANGENT" && c.width == 4) clean_tangents(part, c, context, place);
  }
  clean_skin(part, context, place);
}

}  // namespace fovea::gltf
