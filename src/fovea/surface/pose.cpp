#include "fovea/surface/pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fovea/base/error.h"

namespace fovea {

namespace {

// --- Keys of an animation -----------------------------------------------------------------------------

/// Where a time lies among the keys of a sampler.
struct KeySpan {
  std::size_t before = 0, after = 0;  ///< Keys; the same outside of their range.
  double fraction = 0;                ///< From `before` to `after`.
  double seconds = 0;                 ///< Between the two.
};

KeySpan find_span(const std::vector<float>& times, double time_s) {
  const auto after = std::upper_bound(times.begin(), times.end(), time_s);
  if (after == times.begin()) return {};
  const auto k = static_cast<std::size_t>(after - times.begin());
  if (k == times.size()) return {k - 1, k - 1, 0, 0};
  const double t0 = times[k - 1], t1 = times[k];
  return {k - 1, k, (time_s - t0) / (t1 - t0), t1 - t0};
}

/// The `width` numbers of a sampler at a time; none if it has fewer than its keys need.
std::optional<std::vector<double>> sample(const AnimationSampler& sampler, std::size_t width, double time_s) {
  const std::vector<float> times = sampler.input.to_floats(), values = sampler.output.to_floats();
  const bool cubic = sampler.interpolation == Interpolation::cubic_spline;
  const std::size_t per_key = cubic ? 3 * width : width;  // cubic: in-tangent, value, out-tangent
  if (times.empty() || width == 0 || values.size() < times.size() * per_key) return std::nullopt;
  const KeySpan span = find_span(times, time_s);
  const auto at = [&](std::size_t key, std::size_t part, std::size_t i) {
    return static_cast<double>(values[key * per_key + part * width + i]);
  };
  const double t = sampler.interpolation == Interpolation::step ? 0 : span.fraction;
  std::vector<double> result(width);
  for (std::size_t i = 0; i < width; ++i) {
    if (!cubic) {
      result[i] = at(span.before, 0, i) * (1 - t) + at(span.after, 0, i) * t;
      continue;
    }
    // Hermite spline (glTF 2.0, appendix C).
    const double t2 = t * t, t3 = t2 * t;
    result[i] = (2 * t3 - 3 * t2 + 1) * at(span.before, 1, i) +
                span.seconds * (t3 - 2 * t2 + t) * at(span.before, 2, i) +
                (3 * t2 - 2 * t3) * at(span.after, 1, i) + span.seconds * (t3 - t2) * at(span.after, 0, i);
  }
  return result;
}

using Numbers4 = std::array<double, 4>;

Quat unit_quat(const Numbers4& q) {
  const double l = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return l > 0 ? Quat{q[0] / l, q[1] / l, q[2] / l, q[3] / l} : Quat{};
}

/// Spherical between two keys, the short way round.
Quat slerp(const Numbers4& from, Numbers4 to, double t) {
  double cosine = 0;
  for (std::size_t i = 0; i < 4; ++i) cosine += from[i] * to[i];
  if (cosine < 0) {
    cosine = -cosine;
    for (double& x : to) x = -x;
  }
  double w0 = 1 - t, w1 = t;
  if (cosine < 0.9995) {  // else so near that the chord is as good
    const double angle = std::acos(cosine), sine = std::sin(angle);
    w0 = std::sin((1 - t) * angle) / sine;
    w1 = std::sin(t * angle) / sine;
  }
  Numbers4 mixed;
  for (std::size_t i = 0; i < 4; ++i) mixed[i] = w0 * from[i] + w1 * to[i];
  return unit_quat(mixed);
}

std::optional<Quat> sample_rotation(const AnimationSampler& sampler, double time_s) {
  if (sampler.interpolation != Interpolation::linear) {
    const auto q = sample(sampler, 4, time_s);
    if (!q) return std::nullopt;
    return unit_quat({(*q)[0], (*q)[1], (*q)[2], (*q)[3]});
  }
  const std::vector<float> times = sampler.input.to_floats(), values = sampler.output.to_floats();
  if (times.empty() || values.size() < 4 * times.size()) return std::nullopt;
  const KeySpan span = find_span(times, time_s);
  const auto key = [&](std::size_t k) {
    return Numbers4{values[4 * k], values[4 * k + 1], values[4 * k + 2], values[4 * k + 3]};
  };
  return slerp(key(span.before), key(span.after), span.fraction);
}

// --- Surfaces -----------------------------------------------------------------------------------------

/// The matrices of a skin's joints, and which of them move a corner.
class Skinning {
 public:
  Skinning() = default;
  Skinning(const Pose& pose, const Skin& skin, const TriMesh& mesh) {
    const std::vector<float> inverse =
        skin.inverse_bind ? skin.inverse_bind->to_floats() : std::vector<float>{};
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
      Mat4 inverse_bind;
      if (inverse.size() >= 16 * (j + 1)) std::copy_n(inverse.begin() + 16 * j, 16, inverse_bind.m.begin());
      joints_.push_back(pose.node_world[static_cast<std::size_t>(skin.joints[j])] * inverse_bind);
    }
    for (int set = 0;; ++set) {
      const AttributeLayer *joints = mesh.find(Semantic::joints, set),
                           *weights = mesh.find(Semantic::weights, set);
      if (joints == nullptr || weights == nullptr) break;
      sets_.push_back({joints, weights});
    }
  }

  bool empty() const { return joints_.empty() || sets_.empty(); }
  const Mat4& first_joint() const { return joints_.front(); }

  /// The mean of the corner's joints by weight; weights need not add up to one.
  Mat4 at(CornerId corner) const {
    Mat4 sum;
    sum.m.fill(0);
    double total = 0;
    for (const auto& [joints, weights] : sets_) {
      const ValueId j = joints->corner_value[corner.index()], w = weights->corner_value[corner.index()];
      if (!j.valid() || !w.valid()) continue;
      for (int k = 0; k < std::min(joints->width, weights->width); ++k) {
        const float joint = joints->value(j)[k];
        const double weight = static_cast<double>(weights->value(w)[k]);
        const bool is_there = joint >= 0 && joint < static_cast<float>(joints_.size());
        if (!(weight > 0) || !is_there) continue;
        const Mat4& matrix = joints_[static_cast<std::size_t>(joint)];
        for (std::size_t i = 0; i < 16; ++i) sum.m[i] += weight * matrix.m[i];
        total += weight;
      }
    }
    if (!(total > 0)) return joints_.front();
    for (double& x : sum.m) x /= total;
    return sum;
  }

 private:
  struct Set {
    const AttributeLayer *joints, *weights;
  };
  std::vector<Mat4> joints_;
  std::vector<Set> sets_;
};

/// The directions of a layer with its morph targets, [#values].
std::vector<Vec3f> morphed_directions(const AttributeLayer* layer, const std::vector<double>& morph_weights) {
  std::vector<Vec3f> result;
  if (layer == nullptr) return result;
  const auto width = static_cast<std::size_t>(layer->width);
  for (std::size_t v = 0; v < layer->size(); ++v) {
    const float* x = layer->value(ValueId{v});
    result.push_back({x[0], x[1], x[2]});
  }
  for (std::size_t t = 0; t < std::min(layer->morphs.size(), morph_weights.size()); ++t) {
    const std::vector<float>& morph = layer->morphs[t];
    if (morph.empty() || morph_weights[t] == 0) continue;
    const auto weight = static_cast<float>(morph_weights[t]);
    for (std::size_t v = 0; v < result.size(); ++v)
      result[v] += Vec3f{morph[v * width], morph[v * width + 1], morph[v * width + 2]} * weight;
  }
  return result;
}

/// How an instance deforms its mesh: morph targets, then joints or its transform.
class Deformation {
 public:
  Deformation(const Model& model, const Pose& pose, const Instance& instance)
      : mesh_(model.meshes[instance.mesh].surface), world_(instance.world) {
    const std::vector<double>& weights = pose.morph_weights[instance.node];
    for (std::size_t t = 0; t < std::min(mesh_.target_count(), weights.size()); ++t) {
      if (weights[t] == 0 || mesh_.position_morphs[t].empty()) continue;
      targets_.push_back({static_cast<float>(weights[t]), mesh_.position_morphs[t].data()});
    }
    const int skin = model.nodes[instance.node].skin;
    if (skin >= 0) skinning_ = Skinning(pose, model.skins[static_cast<std::size_t>(skin)], mesh_);
  }

  /// To world space at a corner; where there is none, as for a vertex without triangles, the first joint's.
  Mat4 matrix(CornerId corner) const {
    if (skinning_.empty()) return world_;
    return corner.valid() ? skinning_.at(corner) : skinning_.first_joint();
  }
  /// Whether all vertices have the instance's own matrix.
  bool is_rigid() const { return skinning_.empty() && targets_.empty(); }
  /// What morph targets add to a vertex.
  Vec3f offset(VertexId v) const {
    Vec3f sum;
    for (const Target& target : targets_) sum += target.positions[v.index()] * target.weight;
    return sum;
  }
  Vec3f position(VertexId v, CornerId corner) const {
    Vec3f p = mesh_.positions[v.index()];
    for (const Target& target : targets_) p += target.positions[v.index()] * target.weight;
    return Vec3f(transform_point(matrix(corner), Vec3d(p)));
  }

 private:
  struct Target {
    float weight;
    const Vec3f* positions;  ///< What it adds, [#V].
  };
  const TriMesh& mesh_;
  const Mat4& world_;
  std::vector<Target> targets_;
  Skinning skinning_;
};

/// Calls f(value, corner) once for each value of a layer that a corner uses.
template <class F>
void for_values(const AttributeLayer& layer, F&& f) {
  std::vector<bool> seen(layer.size());
  for (std::size_t c = 0; c < layer.corner_value.size(); ++c) {
    const ValueId value = layer.corner_value[c];
    if (!value.valid() || seen[value.index()]) continue;
    seen[value.index()] = true;
    f(value.index(), CornerId{c});
  }
}

std::vector<std::size_t> target_counts(const Model& model) {
  std::vector<std::size_t> counts;
  for (const Node& node : model.nodes) {
    counts.push_back(
        node.mesh < 0 ? 0 : model.meshes[static_cast<std::size_t>(node.mesh)].surface.target_count());
  }
  return counts;
}

}  // namespace

Vec3f transform_normal(const Mat4& a, Vec3f n) {
  const Vec3d c0{a(0, 0), a(1, 0), a(2, 0)}, c1{a(0, 1), a(1, 1), a(2, 1)}, c2{a(0, 2), a(1, 2), a(2, 2)};
  const double side = determinant3(a) < 0 ? -1 : 1;
  return Vec3f(normalized((cross(c1, c2) * n.x + cross(c2, c0) * n.y + cross(c0, c1) * n.z) * side));
}

Pose rest_pose(const Model& model) {
  Pose pose;
  pose.node_world = world_transforms(model);
  for (const Node& node : model.nodes) {
    std::vector<double> weights = node.morph_weights;
    if (weights.empty() && node.mesh >= 0)
      weights = model.meshes[static_cast<std::size_t>(node.mesh)].morph_weights;
    pose.morph_weights.push_back(std::move(weights));
  }
  return pose;
}

OptionList describe(PoseOptions& o) {
  return {{"animation", "Pose the model by this animation, counted from 0.", &o.animation, "", 0, 1e6},
          {"time", "Moment of the animation.", &o.time_s, "seconds", 0, 1e9}};
}

void check(const PoseOptions& options) {
  if (options.time_s && !options.animation)
    throw Error(ErrorKind::usage, "--time needs --animation", {}, "for example --animation 0");
}

Pose pose_of(const Model& model, const PoseOptions& options) {
  check(options);
  if (!options.animation) return rest_pose(model);
  return pose_at(model, static_cast<std::size_t>(*options.animation), options.time_s.value_or(0));
}

Pose pose_at(const Model& model, std::size_t animation, double time_s) {
  if (animation >= model.animations.size()) {
    const std::size_t count = model.animations.size();
    throw Error(ErrorKind::unsupported, "the model has no animation " + std::to_string(animation), {},
                count == 0 ? "it has none; leave out --animation"
                           : "it has " + std::to_string(count) + ", counted from 0");
  }
  Pose pose = rest_pose(model);
  std::vector<Node> nodes = model.nodes;
  const std::vector<std::size_t> targets = target_counts(model);
  for (const AnimationChannel& channel : model.animations[animation].channels) {
    if (channel.node < 0 || channel.sampler < 0) continue;
    const auto n = static_cast<std::size_t>(channel.node);
    const AnimationSampler& sampler =
        model.animations[animation].samplers[static_cast<std::size_t>(channel.sampler)];
    if (channel.path == "rotation") {
      if (const auto q = sample_rotation(sampler, time_s)) nodes[n].rotation = *q;
    } else if (channel.path == "weights") {
      if (const auto weights = sample(sampler, targets[n], time_s)) pose.morph_weights[n] = *weights;
    } else if (channel.path == "translation" || channel.path == "scale") {
      if (const auto x = sample(sampler, 3, time_s))
        (channel.path == "scale" ? nodes[n].scale : nodes[n].translation) = {(*x)[0], (*x)[1], (*x)[2]};
    } else {
      continue;
    }
    if (channel.path != "weights") nodes[n].matrix.reset();
  }
  pose.node_world = world_transforms(nodes);
  return pose;
}

double duration_s(const Animation& animation) {
  double end = 0;
  for (const AnimationSampler& sampler : animation.samplers) {
    for (const float time : sampler.input.to_floats()) {
      if (std::isfinite(time)) end = std::max(end, static_cast<double>(time));
    }
  }
  return end;
}

std::vector<Instance> instances(const Model& model, const Pose& pose) {
  std::vector<Instance> result;
  const std::vector<bool> shown = shown_nodes(model);
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    const Node& node = model.nodes[n];
    if (node.mesh < 0 || !shown[n]) continue;
    const auto mesh = static_cast<std::size_t>(node.mesh);
    if (node.skin >= 0 || node.instances.empty()) {
      result.push_back({mesh, n, pose.node_world[n]});
    } else {
      for (const Mat4& instance : node.instances) result.push_back({mesh, n, pose.node_world[n] * instance});
    }
  }
  return result;
}

std::vector<CornerId> first_corners(const TriMesh& mesh) {
  std::vector<CornerId> corners(mesh.vertex_count());
  for (std::size_t c = 3 * mesh.face_count(); c-- > 0;)
    corners[mesh.vertex(CornerId{c}).index()] = CornerId{c};
  return corners;
}

std::vector<Mat4> vertex_transforms(const Model& model, const Pose& pose, const Instance& instance) {
  const Deformation deformation(model, pose, instance);
  if (deformation.is_rigid()) return {};
  const TriMesh& mesh = model.meshes[instance.mesh].surface;
  const std::vector<CornerId> corners = first_corners(mesh);
  std::vector<Mat4> transforms;
  transforms.reserve(corners.size());
  for (std::size_t v = 0; v < corners.size(); ++v) {
    transforms.push_back(deformation.matrix(corners[v]) *
                         compose(Vec3d(deformation.offset(VertexId{v})), {}, {1, 1, 1}));
  }
  return transforms;
}

std::vector<Vec3f> posed_points(const Model& model, const Pose& pose, const Instance& instance,
                                std::span<const CornerId> corners) {
  const TriMesh& mesh = model.meshes[instance.mesh].surface;
  const Deformation deformation(model, pose, instance);
  std::vector<Vec3f> points;
  points.reserve(corners.size());
  for (const CornerId c : corners) points.push_back(deformation.position(mesh.vertex(c), c));
  return points;
}

PosedSurface posed_surface(const Model& model, const Pose& pose, const Instance& instance) {
  const TriMesh& mesh = model.meshes[instance.mesh].surface;
  const std::vector<double>& weights = pose.morph_weights[instance.node];
  const AttributeLayer *normal = mesh.find(Semantic::normal), *tangent = mesh.find(Semantic::tangent);
  const Deformation deformation(model, pose, instance);
  PosedSurface surface;
  surface.mirrored = determinant3(deformation.matrix({})) < 0;
  surface.positions.resize(mesh.vertex_count());
  const std::vector<CornerId> corners = first_corners(mesh);
  for (std::size_t v = 0; v < corners.size(); ++v)
    surface.positions[v] = deformation.position(VertexId{v}, corners[v]);

  surface.normals = morphed_directions(normal, weights);
  if (normal != nullptr) {
    for_values(*normal, [&](std::size_t value, CornerId c) {
      surface.normals[value] = transform_normal(deformation.matrix(c), surface.normals[value]);
    });
  }
  surface.tangents = morphed_directions(tangent, weights);
  if (tangent != nullptr) {
    for_values(*tangent, [&](std::size_t value, CornerId c) {
      Vec3f& t = surface.tangents[value];
      t = Vec3f(normalized(transform_direction(deformation.matrix(c), Vec3d(t))));
    });
  }
  return surface;
}

}  // namespace fovea
