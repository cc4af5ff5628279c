#include "fovea/saliency/model_saliency.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fovea/base/error.h"
#include "fovea/saliency/baseline.h"
#include "fovea/saliency/contrast.h"
#include "fovea/saliency/mesh_saliency.h"
#include "fovea/saliency/multi_pose.h"
#include "fovea/saliency/surface_signals.h"
#include "fovea/surface/correspondence.h"
#include "fovea/surface/curvature.h"
#include "fovea/surface/key_poses.h"
#include "fovea/surface/local_order.h"
#include "fovea/surface/scene_surface.h"
#include "fovea/surface/statistics.h"

namespace fovea {

namespace {

constexpr double kLowest = 0.02, kHighest = 0.98;  // percentiles that maps are scaled between

/// What a preset comes to with everything set.
struct Recipe {
  Neighborhood neighborhood;
  bool scales_by_diagonal = true;  ///< Rather than by the mean triangle.
  bool by_peaks = true;            ///< Maps are scaled by Itti's normalisation, rather than by percentiles.
  double geometry = 1, texture = 0, emission = 0, roughness = 0, normal_map = 0;
  double height = 0, visibility = 0, extremity = 0;
  double entropy_share = 0.5;

  bool reads_materials() const { return texture > 0 || emission > 0 || roughness > 0 || normal_map > 0; }
};

Recipe preset_recipe(SaliencyPreset preset) {
  Recipe r;
  switch (preset) {
    case SaliencyPreset::fovea:
      r.by_peaks = false;
      r.geometry = 0.2, r.texture = 0.2, r.height = 0.3, r.visibility = 0.4, r.extremity = 0.1;
      break;
    case SaliencyPreset::yang:
      r.neighborhood = {DistanceKind::window, 1, VertexWeight::one};
      r.scales_by_diagonal = false;
      r.geometry = 0.5, r.texture = 0.5;
      break;
    case SaliencyPreset::lee: r.neighborhood = {DistanceKind::euclidean, 2, VertexWeight::one}; break;
    case SaliencyPreset::munaretti: r.neighborhood = {DistanceKind::geodesic, 1, VertexWeight::one}; break;
  }
  return r;
}

Recipe recipe(const SaliencyOptions& o) {
  Recipe r = preset_recipe(o.preset);
  r.neighborhood.distance = o.distance.value_or(r.neighborhood.distance);
  r.geometry = o.geometry.value_or(r.geometry);
  r.texture = o.texture.value_or(r.texture);
  r.emission = o.emission.value_or(r.emission);
  r.roughness = o.roughness.value_or(r.roughness);
  r.normal_map = o.normal_map.value_or(r.normal_map);
  r.height = o.height.value_or(r.height);
  r.visibility = o.visibility.value_or(r.visibility);
  r.extremity = o.extremity.value_or(r.extremity);
  r.entropy_share = o.entropy_share.value_or(r.entropy_share);
  if (!(r.geometry + r.texture + r.emission + r.roughness + r.normal_map + r.height + r.visibility +
            r.extremity >
        0))
    throw Error(ErrorKind::usage, "every part of saliency has weight 0", {}, "give one a weight above 0");
  return r;
}

std::vector<ScalePair> scale_pairs(const Recipe& recipe, const Surface& surface, double area) {
  std::vector<ScalePair> pairs;
  if (recipe.scales_by_diagonal) {
    const double unit = MeshSaliencyOptions().unit_rel * diagonal(surface);
    for (int i = 2; i <= 6; ++i) pairs.push_back({i * unit, 2 * i * unit});
  } else {
    const double mean = area / static_cast<double>(surface.triangles.size());
    const double circumradius = std::sqrt(4 * mean / (3 * std::sqrt(3.0)));
    for (int l = 1; l <= 4; ++l)
      pairs.push_back({std::ldexp(circumradius, l), std::ldexp(circumradius, l + 1)});
  }
  return pairs;
}

void add(VertexField& sum, const VertexField& field, double weight) {
  for (std::size_t v = 0; v < sum.size(); ++v)
    sum.values()[v] += static_cast<float>(weight) * field.values()[v];
}

VertexField sum_of(std::span<const VertexField> fields) {
  VertexField sum = fields[0];
  for (const VertexField& field : fields.subspan(1)) add(sum, field, 1);
  return sum;
}

/// Scaled so that the least value is 0 and the greatest 1; 0 if all are alike.
void scale_to_one(VertexField& field) {
  if (field.empty()) return;
  const std::span<float> values = field.values();
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const float least = *low, range = *high - least;
  for (float& x : values) x = range > 0 ? (x - least) / range : 0.0f;
}

/// Scaled so that a fiftieth of the area is at 0 or below and as much at 1 or above, and cut there.
VertexField between_percentiles(const VertexField& field, const VertexField& areas) {
  const std::span<const float> values = field.values();
  const double shares[] = {kLowest, kHighest};
  const std::vector<float> ends = percentiles(values, areas.values(), shares);
  const float low = ends[0], high = ends[1];
  VertexField result(field.size());
  for (std::size_t v = 0; v < values.size(); ++v)
    result.values()[v] = high > low ? std::clamp((values[v] - low) / (high - low), 0.0f, 1.0f) : 0.0f;
  return result;
}

/// The work on one model, on its scene in a local order.
class Maker {
 public:
  Maker(const Model& model, const SaliencyOptions& options, Context& context)
      : model_(model), options_(options), context_(context), recipe_(recipe(options)) {}

  ModelSaliency run(std::span<const Model> other_poses) {
    const std::vector<SceneSurface> scenes = pose_scenes(other_poses);
    scene_ = &scenes[0];
    order_ = local_order(scene_->surface);
    unit_ = unit_scale(scene_->surface);
    surface_ = in_work(scene_->surface);
    const Adjacency adjacency(surface_, context_);
    adjacency_ = &adjacency;
    areas_ = vertex_areas(surface_, adjacency, context_);
    sum_ = VertexField(surface_.positions.size());
    if (!surface_.triangles.empty()) {
      add_contrasts(scenes);
      add_viewing();
      const float low = least();
      for (std::uint32_t v = 0; v < sum_.size(); ++v) {
        if (adjacency.corners(v).empty()) sum_.values()[v] = low;
      }
    }
    scale_to_one(sum_);
    if (!surface_.triangles.empty() &&
        std::all_of(sum_.values().begin(), sum_.values().end(), [](float x) { return x == 0; }))
      context_.report("even-saliency", "nothing stands out: saliency is 0 everywhere");
    result_.saliency = per_mesh(sum_);
    return std::move(result_);
  }

 private:
  /// In the order and of the size to work in.
  Surface in_work(const Surface& surface) const {
    Surface result = reordered(surface, order_);
    scale(result, unit_);
    return result;
  }

  /// The scene in every pose that counts.
  std::vector<SceneSurface> pose_scenes(std::span<const Model> others) {
    std::vector<SceneSurface> scenes;
    if (!others.empty()) {
      scenes.push_back(scene_surface(model_, rest_pose(model_)));
      result_.poses.push_back("file 1");
      for (const Model& other : others) {
        scenes.push_back(scenes[0]);
        std::vector<Vec3f>& positions = scenes.back().surface.positions;
        positions.clear();
        for (const Surface& surface : surfaces_in(model_, other))
          positions.insert(positions.end(), surface.positions.begin(), surface.positions.end());
        result_.poses.push_back(fmt::format("file {}", scenes.size()));
      }
    } else if (options_.key_poses > 1) {
      for (const KeyPose& key : key_poses(model_, {options_.key_poses}, context_)) {
        scenes.push_back(scene_surface(model_, key.pose));
        result_.poses.push_back(key.name);
      }
    } else {
      scenes.push_back(scene_surface(model_, pose_of(model_, options_.pose)));
      result_.poses.push_back(pose_name());
    }
    return scenes;
  }

  std::string pose_name() const {
    if (!options_.pose.animation) return "rest";
    return fmt::format("animation {} at {:.2f} s", *options_.pose.animation,
                       options_.pose.time_s.value_or(0));
  }

  /// Signals to contrasts to maps.
  void add_contrasts(const std::vector<SceneSurface>& scenes) {
    std::vector<std::string> names;
    std::vector<VertexField> signals;
    if (recipe_.geometry > 0) {
      names.push_back("curvature");
      signals.push_back(mean_curvature(surface_, *adjacency_, context_));
    }
    if (recipe_.reads_materials()) read_materials(names, signals);
    if (signals.empty()) return;
    const double area = std::accumulate(areas_.values().begin(), areas_.values().end(), 0.0);
    const std::vector<ScalePair> pairs = scale_pairs(recipe_, surface_, area);
    if (!(pairs[0].center > 0)) return;  // no area, no surroundings
    const std::vector<std::vector<VertexField>> contrasts = contrasts_of(signals, pairs);
    for (std::size_t i = 0; i < signals.size(); ++i) {
      const double own = names[i] == "curvature" ? unit_ : 1;  // one over a length
      keep(names[i], signals[i], own);
      for (std::size_t k = 0; k < pairs.size(); ++k)
        keep(fmt::format("{}-contrast-{}", names[i], k + 1), contrasts[i][k], own);
    }
    const auto contrast = [&](const std::string& name) -> const std::vector<VertexField>* {
      const auto at = std::find(names.begin(), names.end(), name);
      return at == names.end() ? nullptr : &contrasts[static_cast<std::size_t>(at - names.begin())];
    };
    if (const auto* curvature = contrast("curvature")) add_geometry(*curvature, scenes);
    if (const auto* intensity = contrast("intensity"))
      add_texture(*intensity, *contrast("opponency"), *contrast("entropy"));
    if (const auto* emission = contrast("emission"))
      add_map("emission", promoted(sum_of(*emission)), recipe_.emission);
    if (const auto* roughness = contrast("roughness")) {
      VertexField map = promoted(sum_of(*roughness));
      add(map, promoted(sum_of(*contrast("metalness"))), 1);
      add_map("material", map, recipe_.roughness);
    }
    if (const auto* normals = contrast("normal-detail"))
      add_map("normal-map", promoted(sum_of(*normals)), recipe_.normal_map);
  }

  /// Curvature, if it is there, is the first of the signals; the others are of textures.
  std::vector<std::vector<VertexField>> contrasts_of(std::span<const VertexField> signals,
                                                     std::span<const ScalePair> pairs) const {
    // As published each vertex counts alike in averages of shape, and each texel in those of textures.
    std::vector<VertexField> weights;
    if (recipe_.neighborhood.weight == VertexWeight::one && !texels_.empty()) {
      weights.assign(signals.size(), texels_);
      if (recipe_.geometry > 0) weights[0] = {};
    }
    return center_surround(surface_, *adjacency_, signals, pairs, recipe_.neighborhood, context_, weights);
  }

  void read_materials(std::vector<std::string>& names, std::vector<VertexField>& signals) {
    SurfaceSignalOptions wanted;
    wanted.texture.entropy_window = static_cast<int>(options_.entropy_window);
    wanted.texture.entropy_bins = static_cast<int>(options_.entropy_bins);
    wanted.emission = recipe_.emission > 0;
    wanted.roughness = wanted.metalness = recipe_.roughness > 0;
    wanted.normal_detail = recipe_.normal_map > 0;
    const std::vector<SurfaceSignals> meshes = surface_signals(model_, wanted, context_);
    const auto whole = [&](const VertexField SurfaceSignals::*signal) {
      std::vector<VertexField> parts;
      for (const SurfaceSignals& mesh : meshes) parts.push_back(mesh.*signal);
      return in_order(joined(parts), order_);
    };
    const auto use = [&](const std::string& name, const VertexField SurfaceSignals::*signal) {
      names.push_back(name);
      signals.push_back(whole(signal));
    };
    texels_ = whole(&SurfaceSignals::texels);
    for (const SurfaceSignals& mesh : meshes) result_.textured = result_.textured || mesh.textured;
    if (recipe_.texture > 0 && result_.textured) {
      use("intensity", &SurfaceSignals::intensity);
      use("opponency", &SurfaceSignals::opponency);
      use("entropy", &SurfaceSignals::entropy);
    }
    if (wanted.emission) use("emission", &SurfaceSignals::emission);
    if (wanted.roughness) {
      use("roughness", &SurfaceSignals::roughness);
      use("metalness", &SurfaceSignals::metalness);
    }
    if (wanted.normal_detail) use("normal-detail", &SurfaceSignals::normal_detail);
  }

  /// Of the first pose by its contrasts, of the others from their own.
  void add_geometry(const std::vector<VertexField>& contrasts, const std::vector<SceneSurface>& scenes) {
    std::vector<VertexField> poses{geometry(contrasts)};
    if (scenes.size() > 1) keep("geometry-pose-1", poses[0]);
    for (std::size_t i = 1; i < scenes.size(); ++i) {
      context_.advance_or_throw("saliency", static_cast<double>(i) / static_cast<double>(scenes.size()));
      unit_scale(scenes[i].surface);  // throws where it is beyond what floats hold
      const Surface posed = in_work(scenes[i].surface);
      const VertexField curvature = mean_curvature(posed, *adjacency_, context_);
      const VertexField areas = vertex_areas(posed, *adjacency_, context_);
      const double area = std::accumulate(areas.values().begin(), areas.values().end(), 0.0);
      poses.push_back(
          geometry(center_surround(posed, *adjacency_, {&curvature, 1}, scale_pairs(recipe_, posed, area),
                                   recipe_.neighborhood, context_)[0]));
      keep(fmt::format("geometry-pose-{}", i + 1), poses.back());
    }
    add_map("geometry", multi_pose_saliency(poses), recipe_.geometry);
  }

  VertexField geometry(const std::vector<VertexField>& contrasts) const {
    VertexField sum(contrasts[0].size());
    for (const VertexField& contrast : contrasts) add(sum, promoted(contrast), 1);
    return sum;
  }

  void add_texture(const std::vector<VertexField>& intensity, const std::vector<VertexField>& opponency,
                   const std::vector<VertexField>& entropy) {
    VertexField color = promoted(sum_of(intensity));
    add(color, promoted(sum_of(opponency)), 1);
    const VertexField busy = promoted(sum_of(entropy));
    keep("texture-color", color);
    keep("texture-entropy", busy);
    VertexField map(surface_.positions.size());
    add(map, color, 1 - recipe_.entropy_share);
    add(map, busy, recipe_.entropy_share);
    add_map("texture", map, recipe_.texture);
  }

  void add_viewing() {
    if (recipe_.height > 0)
      add_map("height", along(surface_, direction(options_.ring.up), context_), recipe_.height, 1 / unit_);
    if (recipe_.visibility > 0)
      add_map("visibility", visibility(surface_, *adjacency_, options_.ring, context_), recipe_.visibility);
    if (recipe_.extremity > 0)
      add_map("extremity", far_from_center(surface_, context_), recipe_.extremity, 1 / unit_);
  }

  /// `own` as for `keep`.
  void add_map(const std::string& name, const VertexField& map, double weight, double own = 1) {
    keep(name, map, own);
    add(sum_, recipe_.by_peaks ? promoted(map) : between_percentiles(map, areas_), weight);
  }

  VertexField promoted(const VertexField& field) const { return promote_peaks(field, *adjacency_); }

  /// `own` times the field is what it is in the model's own unit.
  void keep(const std::string& name, VertexField field, double own = 1) {
    constexpr double kMost = std::numeric_limits<float>::max();
    for (float& x : field.values())
      x = static_cast<float>(std::clamp(own * static_cast<double>(x), -kMost, kMost));
    result_.maps.push_back({name, per_mesh(field)});
  }
  std::vector<VertexField> per_mesh(const VertexField& field) const {
    return split(*scene_, in_own_order(field, order_));
  }

  /// The least value at a vertex with triangles.
  float least() const {
    float low = std::numeric_limits<float>::infinity();
    for (const auto& t : surface_.triangles) {
      for (const std::uint32_t v : t) low = std::min(low, sum_.values()[v]);
    }
    return low;
  }

  const Model& model_;
  const SaliencyOptions& options_;
  Context& context_;
  Recipe recipe_;
  const SceneSurface* scene_ = nullptr;  // the first pose
  LocalOrder order_;
  double unit_ = 1;  // makes the first pose about 1 large
  Surface surface_;
  const Adjacency* adjacency_ = nullptr;
  VertexField areas_;
  VertexField texels_;  // that a vertex stands for; empty if no materials were read
  VertexField sum_;
  ModelSaliency result_;
};

}  // namespace

OptionList describe(SaliencyOptions& o) {
  const Option::Choice distance{
      {"preset", "euclidean", "geodesic", "window", "diffusion"},
      [&o] { return o.distance ? static_cast<int>(*o.distance) + 1 : 0; },
      [&o](int i) { o.distance = i == 0 ? std::nullopt : std::optional(static_cast<DistanceKind>(i - 1)); }};
  const auto weight = [](const char* name, const char* help, std::optional<double>& value) {
    return Option{name, help, &value, "", 0, 1000};
  };
  KeyPoseOptions poses;
  Option key_poses = describe(poses).front();
  key_poses.value = &o.key_poses;
  OptionList list{
      {"preset", "How to tell where people look; what is not given besides is as it has it.",
       choice(o.preset, {"fovea", "yang", "lee", "munaretti"}), ""},
      {"distance", "How far apart vertices are that are averaged.", distance, ""},
      weight("geometry-weight", "What contrast of curvature counts for in the whole.", o.geometry),
      weight("texture-weight", "What contrast of colour and its entropy counts for.", o.texture),
      weight("emission-weight", "What contrast of emitted light counts for.", o.emission),
      weight("material-weight", "What contrast of roughness and metalness counts for.", o.roughness),
      weight("normal-map-weight", "What contrast of the detail in normal maps counts for.", o.normal_map),
      weight("height-weight", "What height along the upright axis counts for.", o.height),
      weight("visibility-weight", "What being seen from places around the model counts for.", o.visibility),
      weight("extremity-weight", "What distance from the middle counts for.", o.extremity),
      {"entropy-share", "What entropy counts for within the texture; colour the rest.", &o.entropy_share, "",
       0, 1},
      {"entropy-window", "Texels along a side of the window of entropy; odd.", &o.entropy_window, "texels", 3,
       63},
      {"entropy-bins", "Greys that entropy tells apart.", &o.entropy_bins, "", 2, 256},
      {"up", "Which way is up.", choice(o.ring.up, {"x", "y", "z", "-x", "-y", "-z"}), ""},
      {"ring-count", "Places around the model that visibility is seen from.", &o.ring.count, "", 1, 360},
      {"ring-elevation", "How high above the horizon they are.", &o.ring.elevation_deg, "degrees", -89, 89},
      key_poses};
  const OptionList pose = describe(o.pose);
  list.insert(list.end(), pose.begin(), pose.end());
  return list;
}

ModelSaliency model_saliency(const Model& model, const SaliencyOptions& options, Context& context,
                             std::span<const Model> poses) {
  SaliencyOptions checked = options;
  check(describe(checked));
  if (options.entropy_window % 2 == 0)
    throw Error(ErrorKind::usage, "the window of entropy has an even side", "--entropy-window");
  check(options.pose);
  if (options.pose.animation && (options.key_poses > 1 || !poses.empty()))
    throw Error(ErrorKind::usage, "one moment of an animation and several poses are asked for", "--animation",
                "leave out --animation, or --key-poses and further files");
  return Maker(model, options, context).run(poses);
}

}  // namespace fovea
