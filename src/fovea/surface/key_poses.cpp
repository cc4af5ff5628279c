#include "fovea/surface/key_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/base/random.h"
#include "fovea/surface/rigid_distance.h"

namespace fovea {

namespace {

constexpr std::size_t kMaxCandidates = 64;
constexpr std::size_t kMaxPoints = 4096;
constexpr double kLeastDistance = 1e-3;  // of the scene's diagonal

/// At most `count` of the items, evenly spread over them.
template <class T>
std::vector<T> evenly_chosen(const std::vector<T>& items, std::size_t count) {
  if (items.size() <= count) return items;
  std::vector<T> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(items[i * items.size() / count]);
  return chosen;
}

// --- What moves ---------------------------------------------------------------------------------------

/// Nodes whose transforms place what is seen: those that show a mesh, or the joints of its skin, and all
/// above them. [#nodes]
std::vector<bool> placing_nodes(const Model& model) {
  std::vector<int> parent(model.nodes.size(), -1);
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    for (const int child : model.nodes[n].children)
      parent[static_cast<std::size_t>(child)] = static_cast<int>(n);
  }
  std::vector<bool> placing(model.nodes.size());
  const auto mark = [&](int node) {
    for (; node >= 0 && !placing[static_cast<std::size_t>(node)];
         node = parent[static_cast<std::size_t>(node)])
      placing[static_cast<std::size_t>(node)] = true;
  };
  const std::vector<bool> shown = shown_nodes(model);
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    const Node& node = model.nodes[n];
    if (node.mesh < 0 || !shown[n]) continue;
    if (node.skin < 0) {
      mark(static_cast<int>(n));
    } else {
      for (const int joint : model.skins[static_cast<std::size_t>(node.skin)].joints) mark(joint);
    }
  }
  return placing;
}

/// Nodes that show a mesh with morph targets. [#nodes]
std::vector<bool> morphing_nodes(const Model& model) {
  std::vector<bool> morphing = shown_nodes(model);
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    const int mesh = model.nodes[n].mesh;
    if (mesh < 0 || model.meshes[static_cast<std::size_t>(mesh)].surface.target_count() == 0)
      morphing[n] = false;
  }
  return morphing;
}

/// What the animations of a model do to what is seen.
struct Motion {
  std::vector<std::vector<double>> key_times_s;  ///< [#animations], each rising; empty if it does nothing.
  std::vector<bool> drives_weights;              ///< [#meshes], by any animation.
};

/// When the samplers in use have keys, rising.
std::vector<double> key_times_s(const Animation& animation, const std::vector<bool>& used) {
  std::vector<double> times;
  for (std::size_t s = 0; s < used.size(); ++s) {
    if (!used[s]) continue;
    for (const float t : animation.samplers[s].input.to_floats()) {
      if (std::isfinite(t)) times.push_back(static_cast<double>(t));
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

Motion find_motion(const Model& model) {
  const std::vector<bool> placing = placing_nodes(model), morphing = morphing_nodes(model);
  Motion motion{{}, std::vector<bool>(model.meshes.size())};
  for (const Animation& animation : model.animations) {
    std::vector<bool> used(animation.samplers.size());  // many channels may share one
    for (const AnimationChannel& channel : animation.channels) {
      if (channel.node < 0 || channel.sampler < 0) continue;
      const auto n = static_cast<std::size_t>(channel.node);
      const bool morphs = morphing[n] && channel.path == "weights";
      const bool moves = placing[n] && (channel.path == "translation" || channel.path == "rotation" ||
                                        channel.path == "scale");
      if (morphs) motion.drives_weights[static_cast<std::size_t>(model.nodes[n].mesh)] = true;
      if (morphs || moves) used[static_cast<std::size_t>(channel.sampler)] = true;
    }
    motion.key_times_s.push_back(key_times_s(animation, used));
  }
  return motion;
}

// --- Candidates ---------------------------------------------------------------------------------------

/// At most `count` times: the keys and as many between each two, or, of more keys, from the first to the
/// last; the middle if one must do.
std::vector<double> spread_times(const std::vector<double>& keys, std::size_t count) {
  std::vector<double> times;
  const auto divide = [&](double first, double last, std::size_t parts) {
    for (std::size_t i = 0; i < parts; ++i)
      times.push_back(first + (last - first) * static_cast<double>(i) / static_cast<double>(parts));
  };
  if (count == 1 || keys.size() == 1) return {(keys.front() + keys.back()) / 2};
  if (keys.size() > count) {
    divide(keys.front(), keys.back(), count - 1);
  } else {
    for (std::size_t k = 1; k < keys.size(); ++k)
      divide(keys[k - 1], keys[k], (count - 1) / (keys.size() - 1));
  }
  times.push_back(keys.back());
  return times;
}

PoseSource moment(const Model& model, std::size_t animation, double time_s) {
  return {fmt::format("animation {} at {:g} s", animation, time_s),
          [&model, animation, time_s] { return pose_at(model, animation, time_s); }};
}

/// The keys and as many times between them that none is farther than `step` from the next; keys nearer than
/// half of that to the one before are left out, but for the last.
std::vector<double> dense_times(const std::vector<double>& keys, double step) {
  std::vector<double> times;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const double gap = times.empty() ? 0 : keys[k] - times.back();
    if (!times.empty() && gap < 0.5 * step && k + 1 < keys.size()) continue;
    const double first = times.empty() ? keys[k] : times.back();
    const double parts = std::max(1.0, std::ceil(gap / step));
    for (double i = 1; i < parts; ++i) times.push_back(first + gap * (i / parts));
    times.push_back(keys[k]);
  }
  return times;
}

/// One for each animation that moves anything, and the others by duration; at most `limit`.
std::vector<PoseSource> moments(const Model& model, const Motion& motion, std::size_t limit) {
  std::vector<std::size_t> moving;
  for (std::size_t a = 0; a < motion.key_times_s.size(); ++a) {
    if (!motion.key_times_s[a].empty()) moving.push_back(a);
  }
  moving = evenly_chosen(moving, limit);
  const auto duration = [&](std::size_t a) {
    return motion.key_times_s[a].back() - motion.key_times_s[a].front();
  };
  double total = 0;
  for (const std::size_t a : moving) total += duration(a);
  std::vector<PoseSource> candidates;
  for (const std::size_t a : moving) {
    const double share = total > 0 ? duration(a) / total : 0;
    const auto extra = static_cast<std::size_t>(share * static_cast<double>(limit - moving.size()));
    for (const double time : spread_times(motion.key_times_s[a], 1 + extra)) {
      candidates.push_back(moment(model, a, time));
    }
  }
  return candidates;
}

Pose target_pose(const Model& model, std::size_t mesh, std::size_t target) {
  Pose pose = rest_pose(model);
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    if (model.nodes[n].mesh != static_cast<int>(mesh)) continue;
    pose.morph_weights[n].assign(model.meshes[mesh].surface.target_count(), 0.0);
    pose.morph_weights[n][target] = 1;
  }
  return pose;
}

/// Every target of the meshes shown whose weights no animation drives; at most `limit`.
std::vector<PoseSource> single_targets(const Model& model, const Motion& motion, std::size_t limit) {
  std::vector<bool> morphing(model.meshes.size());
  const std::vector<bool> nodes = morphing_nodes(model);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (nodes[n]) morphing[static_cast<std::size_t>(model.nodes[n].mesh)] = true;
  }
  std::vector<std::pair<std::size_t, std::size_t>> targets;  // mesh, target
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (!morphing[m] || motion.drives_weights[m]) continue;
    for (std::size_t t = 0; t < model.meshes[m].surface.target_count(); ++t) targets.emplace_back(m, t);
  }
  std::vector<PoseSource> candidates;
  for (const auto& [mesh, target] : evenly_chosen(targets, limit)) {
    candidates.push_back(
        {fmt::format("target {} of mesh {}", target, mesh),
         [&model, mesh = mesh, target = target] { return target_pose(model, mesh, target); }});
  }
  return candidates;
}

PoseSource at_rest(const Model& model) {
  return {"rest", [&model] { return rest_pose(model); }};
}

std::vector<PoseSource> find_candidates(const Model& model) {
  const Motion motion = find_motion(model);
  const bool animated = std::any_of(motion.key_times_s.begin(), motion.key_times_s.end(),
                                    [](const std::vector<double>& times) { return !times.empty(); });
  const std::vector<PoseSource> targets =
      single_targets(model, motion, animated ? kMaxCandidates / 2 : kMaxCandidates - 1);
  std::vector<PoseSource> candidates =
      animated ? moments(model, motion, kMaxCandidates - targets.size()) : std::vector{at_rest(model)};
  candidates.insert(candidates.end(), targets.begin(), targets.end());
  return candidates;
}

// --- The space of poses -------------------------------------------------------------------------------

/// A corner for each vertex in a sample of the vertices of all instances: one out of every stretch of equal
/// length, at random in it, so that no row of a grid falls in step with them. [#instances][#sampled]
std::vector<std::vector<CornerId>> sample_vertices(const Model& model, const std::vector<Instance>& shown) {
  std::vector<std::vector<CornerId>> corners_of(model.meshes.size());  // [#meshes][#vertices with triangles]
  std::size_t total = 0;
  for (const Instance& instance : shown) {
    std::vector<CornerId>& corners = corners_of[instance.mesh];
    if (corners.empty()) {
      corners = first_corners(model.meshes[instance.mesh].surface);
      std::erase(corners, CornerId());
    }
    total += corners.size();
  }
  const std::size_t count = std::min(total, kMaxPoints);
  const double stretch = static_cast<double>(total) / static_cast<double>(std::max<std::size_t>(count, 1));
  Random random(1);
  std::vector<std::vector<CornerId>> sample(shown.size());
  std::size_t instance = 0, first = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = (static_cast<double>(i) + random.uniform()) * stretch;
    const std::size_t v = std::min(static_cast<std::size_t>(place), total - 1);
    while (v - first >= corners_of[shown[instance].mesh].size())
      first += corners_of[shown[instance++].mesh].size();
    sample[instance].push_back(corners_of[shown[instance].mesh][v - first]);
  }
  return sample;
}

std::vector<Vec3d> sampled_points(const Model& model, const Pose& pose,
                                  const std::vector<std::vector<CornerId>>& sample) {
  const std::vector<Instance> shown = instances(model, pose);
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (sample[i].empty()) continue;
    for (const Vec3f& p : posed_points(model, pose, shown[i], sample[i])) points.emplace_back(p);
  }
  return points;
}

bool all_finite(const std::vector<Vec3d>& points) {
  return std::all_of(points.begin(), points.end(), [](const Vec3d& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  });
}

/// The sampled points of each candidate. Those with points that are not numbers go.
std::vector<std::vector<Vec3d>> place_candidates(const Model& model, std::vector<PoseSource>& candidates,
                                                 const Context& context) {
  const auto sample = sample_vertices(model, instances(model, rest_pose(model)));
  std::vector<std::vector<Vec3d>> points(candidates.size());
  parallel_for(context, candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) points[c] = sampled_points(model, candidates[c].pose(), sample);
  });
  std::size_t kept = 0;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (!all_finite(points[c])) continue;
    std::swap(candidates[kept], candidates[c]);
    std::swap(points[kept++], points[c]);
  }
  candidates.resize(kept);
  points.resize(kept);
  return points;
}

/// Of every pose to every other. [#poses][#poses]
using Distances = std::vector<std::vector<double>>;

Distances all_distances(const std::vector<std::vector<Vec3d>>& poses, const Context& context) {
  Distances distances(poses.size(), std::vector<double>(poses.size()));
  parallel_for(context, poses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      for (std::size_t b = 0; b < a; ++b) distances[a][b] = rigid_distance(poses[a], poses[b]);
    }
  });
  for (std::size_t a = 0; a < poses.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) distances[b][a] = distances[a][b];
  }
  return distances;
}

/// The pose with the least mean square distance to all.
std::size_t most_typical(const Distances& distances) {
  const auto squares = [](const std::vector<double>& row) {
    return std::inner_product(row.begin(), row.end(), row.begin(), 0.0);
  };
  const auto least = std::min_element(distances.begin(), distances.end(),
                                      [&](const auto& a, const auto& b) { return squares(a) < squares(b); });
  return static_cast<std::size_t>(least - distances.begin());
}

struct Choice {
  std::size_t pose = 0;
  double distance = 0;  ///< To the nearest before it.
};

/// Farthest-point sampling, from the most typical on, while there are poses farther than `least`.
std::vector<Choice> farthest_points(const Distances& distances, std::size_t count, double least) {
  std::vector<Choice> chosen = {{most_typical(distances), 0}};
  std::vector<double> nearest(distances.size(), std::numeric_limits<double>::infinity());
  while (chosen.size() < count) {
    const std::vector<double>& from_last = distances[chosen.back().pose];
    for (std::size_t p = 0; p < nearest.size(); ++p) nearest[p] = std::min(nearest[p], from_last[p]);
    const auto farthest = std::max_element(nearest.begin(), nearest.end());
    if (!(*farthest > least)) break;
    chosen.push_back({static_cast<std::size_t>(farthest - nearest.begin()), *farthest});
  }
  return chosen;
}

}  // namespace

OptionList describe(KeyPoseOptions& o) {
  return {{"key-poses",
           "Most poses of the model's animations and morph targets to look at; 1 looks at one pose alone.",
           &o.count, "", 1, 64}};
}

std::vector<KeyPose> key_poses(const Model& model, const KeyPoseOptions& options, const Context& context) {
  KeyPoseOptions checked = options;
  check(describe(checked));
  std::vector<PoseSource> candidates = find_candidates(model);
  const std::vector<std::vector<Vec3d>> points = place_candidates(model, candidates, context);
  if (candidates.empty()) return {{rest_pose(model), "rest", 0}};
  const double diagonal = bounds(model).diagonal();
  const std::size_t count = diagonal > 0 ? static_cast<std::size_t>(options.count) : 1;
  std::vector<KeyPose> result;
  for (const auto& [pose, distance] :
       farthest_points(all_distances(points, context), count, kLeastDistance * diagonal)) {
    result.push_back(
        {candidates[pose].pose(), candidates[pose].name, distance > 0 ? distance / diagonal : 0});
  }
  return result;
}

std::vector<PoseSource> motion_poses(const Model& model, double step_s, std::size_t most) {
  const Motion motion = find_motion(model);
  std::vector<PoseSource> poses;
  for (std::size_t a = 0; a < motion.key_times_s.size(); ++a) {
    for (const double time : dense_times(motion.key_times_s[a], step_s))
      poses.push_back(moment(model, a, time));
  }
  const std::vector<PoseSource> targets = single_targets(model, motion, most / 2);
  poses = evenly_chosen(poses, most - targets.size());
  poses.insert(poses.end(), targets.begin(), targets.end());
  return poses;
}

}  // namespace fovea
