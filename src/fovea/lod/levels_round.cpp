#include "fovea/lod/levels_round.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace fovea {

namespace {

/// What numbers of one kind are rounded to.
class Rounding {
 public:
  Rounding() = default;
  explicit Rounding(Storage storage) : storage_(storage) {}
  /// Multiples of a power of two, so many bits for the extent.
  static Rounding to_bits(double extent, std::int64_t bits) {
    Rounding rounding;
    if (extent > 0) {
      const double most = std::ldexp(1.0, static_cast<int>(bits)) - 1;
      rounding.step_ = std::exp2(std::ceil(std::log2(extent / most)));
    }
    return rounding;
  }

  bool rounds() const { return step_ > 0 || storage_.type != ComponentType::f32; }
  /// Between two neighbours.
  double step() const {
    if (step_ > 0 || !rounds()) return step_;
    return static_cast<double>(decode_component(1, storage_)) -
           static_cast<double>(decode_component(0, storage_));
  }
  void round(float& x) const {
    if (step_ > 0) {
      x = static_cast<float>(std::round(static_cast<double>(x) / step_) * step_);
    } else if (rounds()) {
      x = decode_component(encode_component(x, storage_), storage_);
    }
  }
  void round(std::span<float> numbers) const {
    for (float& x : numbers) round(x);
  }
  void round(Vec3f& p) const {
    round(p.x);
    round(p.y);
    round(p.z);
  }

 private:
  double step_ = 0;
  Storage storage_;
};

struct MeshRounding {
  Rounding position, position_morph;
  std::vector<Rounding> value, value_morph;  // [#layers]
};

double extent_of(const AttributeLayer& layer) {
  double largest = 0;
  const auto width = static_cast<std::size_t>(layer.width);
  for (std::size_t i = 0; i < width; ++i) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (std::size_t at = i; at < layer.values.size(); at += width) {
      low = std::min(low, layer.values[at]);
      high = std::max(high, layer.values[at]);
    }
    if (low <= high) largest = std::max(largest, static_cast<double>(high) - static_cast<double>(low));
  }
  return largest;
}

Rounding rounding_of(const AttributeLayer& layer, const WriteOptions& options) {
  if (layer.storage.type != ComponentType::f32) return Rounding(layer.storage);
  if (!options.quantize) return {};
  switch (layer.semantic) {
    case Semantic::uv: return Rounding::to_bits(extent_of(layer), options.uv_bits);
    case Semantic::normal:
    case Semantic::tangent: return Rounding::to_bits(2, options.normal_bits);
    case Semantic::color: return Rounding::to_bits(1, options.color_bits);
    default: return {};  // weights have a sum, and nobody knows about the others
  }
}

MeshRounding rounding_of(const TriMesh& mesh, const WriteOptions& options) {
  MeshRounding rounding;
  if (mesh.position_storage.type != ComponentType::f32) {
    rounding.position = Rounding(mesh.position_storage);
  } else if (options.quantize) {
    const Vec3d size = bounds(mesh).high - bounds(mesh).low;
    rounding.position = rounding.position_morph =
        Rounding::to_bits(std::max({size.x, size.y, size.z}), options.position_bits);
  }
  for (const AttributeLayer& layer : mesh.layers) {
    rounding.value.push_back(rounding_of(layer, options));
    rounding.value_morph.push_back(layer.storage.type == ComponentType::f32 ? rounding.value.back()
                                                                            : Rounding());
  }
  return rounding;
}

bool rounds(const MeshRounding& rounding) {
  const auto is_rounding = [](const Rounding& r) { return r.rounds(); };
  return rounding.position.rounds() || std::ranges::any_of(rounding.value, is_rounding);
}

void round(TriMesh& mesh, const MeshRounding& rounding) {
  for (Vec3f& p : mesh.positions) rounding.position.round(p);
  for (auto& morph : mesh.position_morphs) {
    for (Vec3f& p : morph) rounding.position_morph.round(p);
  }
  for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
    rounding.value[l].round(mesh.layers[l].values);
    for (auto& morph : mesh.layers[l].morphs) rounding.value_morph[l].round(morph);
  }
}

/// Returns where the numbers of the next write begin.
float* round(const TriMesh& mesh, const MeshRounding& rounding, const ValueWrite& write, float* numbers) {
  const auto run = [&](const Rounding& how, std::size_t count) {
    how.round({numbers, count});
    numbers += count;
  };
  if (write.layer == kInvalid) {
    run(rounding.position_morph, 3 * mesh.target_count());
    return numbers;
  }
  const AttributeLayer& layer = mesh.layers[write.layer];
  const auto width = static_cast<std::size_t>(layer.width);
  run(rounding.value[write.layer], width);
  run(rounding.value_morph[write.layer], width * layer.morphs.size());
  return numbers;
}

void round(const Model& model, const std::vector<MeshRounding>& roundings, MultiTessellation& levels) {
  CollapseRecord& record = levels.record;
  const std::vector<double> scales = largest_scales(model);
  std::size_t write = 0;
  float* numbers = record.floats.data();
  for (std::size_t s = 0; s < record.steps.size(); ++s) {
    CollapseStep& step = record.steps[s];
    const MeshRounding& rounding = roundings[step.mesh];
    if (step.moved) rounding.position.round(step.position);
    for (; write < step.writes_end; ++write)
      numbers = round(model.meshes[step.mesh].surface, rounding, record.writes[write], numbers);
    const double scale = scales[step.mesh] > 0 ? scales[step.mesh] : 1;
    levels.error[s] += static_cast<float>(std::sqrt(3.0) / 2 * rounding.position.step() * scale);
  }
}

}  // namespace

std::optional<LeveledModel> rounded_levels(const LeveledModel& leveled, const WriteOptions& options) {
  std::vector<MeshRounding> roundings;
  bool any = false;
  for (const Mesh& mesh : leveled.original.meshes) {
    roundings.push_back(rounding_of(mesh.surface, options));
    any = any || rounds(roundings.back());
  }
  if (!any) return std::nullopt;
  LeveledModel rounded = leveled;
  for (std::size_t m = 0; m < roundings.size(); ++m) round(rounded.original.meshes[m].surface, roundings[m]);
  round(rounded.original, roundings, rounded.levels);
  return rounded;
}

}  // namespace fovea
