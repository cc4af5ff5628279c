#pragma once

#include <cstdint>

#include "fovea/lod/split_code.h"

// Private to lod.

namespace fovea {

/// What a file of levels says at first.
struct LevelsHead {
  std::uint32_t steps = 0;      ///< In the whole file,
  std::uint32_t triangles = 0;  ///< and of the original.
};

/// Meshes without triangles: their parts and layers, and how their numbers are coded. For an `Io` as of
/// SplitCode.
template <class Io>
class HeadCode {
 public:
  HeadCode(Io& io, GrowingModel& model) : io_(io), model_(model) {}

  void code(LevelsHead& head) {
    number(head.steps);
    number(head.triangles);
    size(model_.meshes);
    model_.codes.resize(model_.meshes.size());
    for (std::size_t m = 0; m < model_.meshes.size(); ++m) code_mesh(model_.meshes[m], model_.codes[m]);
  }

 private:
  void number(std::uint32_t& x) { io_.symbol(Symbol::head, x); }

  /// Of which each element takes a byte at least.
  template <class List>
  void size(List& list) {
    auto count = static_cast<std::uint32_t>(list.size());
    number(count);
    if constexpr (!Io::kWrites) {
      if (count > io_.left(Symbol::head)) damaged_levels("a count is too large");
      io_.charge(count * sizeof(typename List::value_type));
      list.resize(count);
    }
  }

  template <class Enum>
  void choice(Enum& x, std::uint32_t most) {
    auto value = static_cast<std::uint32_t>(x);
    number(value);
    if (value > most) damaged_levels("there is no such choice");
    x = static_cast<Enum>(value);
  }

  void code_storage(Storage& storage) {
    choice(storage.type, static_cast<std::uint32_t>(ComponentType::f32));
    std::uint32_t normalized = storage.normalized;
    number(normalized);
    storage.normalized = normalized != 0;
    if constexpr (!Io::kWrites) {
      const auto type = static_cast<int>(storage.type);
      if (type < static_cast<int>(ComponentType::i8) || type == 5124)
        damaged_levels("there is no such storage");
    }
  }

  void code_scale(NumberCode& code) {
    double scale = code.scale();
    io_.real(scale);
    if (!(scale >= 0) || !std::isfinite(scale)) damaged_levels("a scale is no number");
    code = NumberCode(scale);
  }

  void code_mesh(GrowingMesh& mesh, MeshCodes& codes) {
    TriMesh& surface = mesh.surface;
    code_storage(surface.position_storage);
    code_scale(codes.position);
    code_scale(codes.position_morph);
    size(surface.position_morphs);
    size(surface.parts);
    for (Part& part : surface.parts) code_part(part);
    size(surface.layers);
    mesh.morphed.resize(surface.layers.size());
    codes.value.resize(surface.layers.size());
    codes.value_morph.resize(surface.layers.size());
    for (std::size_t l = 0; l < surface.layers.size(); ++l) {
      code_layer(surface.layers[l], mesh.morphed[l]);
      code_scale(codes.value[l]);
      code_scale(codes.value_morph[l]);
    }
  }

  /// Those of points and lines are in the GLB.
  void code_part(Part& part) {
    std::uint32_t raw = part.raw.has_value(), material = static_cast<std::uint32_t>(part.material + 1);
    number(raw);
    if (raw != 0) {
      if constexpr (!Io::kWrites) part.raw.emplace();
      return;
    }
    number(material);
    if (material > 0x7FFFFFFF) damaged_levels("a material is not there");
    part.material = static_cast<int>(material) - 1;
    io_.text(part.json);
  }

  void code_layer(AttributeLayer& layer, std::vector<bool>& morphed) {
    constexpr std::uint32_t kMostWidth = 16;
    choice(layer.semantic, static_cast<std::uint32_t>(Semantic::custom));
    auto set = static_cast<std::uint32_t>(layer.set), width = static_cast<std::uint32_t>(layer.width);
    number(set);
    number(width);
    if (width == 0 || width > kMostWidth || set > 0xFFFF) damaged_levels("there is no such layer");
    layer.set = static_cast<int>(set);
    layer.width = static_cast<int>(width);
    io_.text(layer.name);
    code_storage(layer.storage);
    size(layer.morphs);
    morphed.resize(layer.morphs.size());
    for (std::size_t t = 0; t < morphed.size(); ++t) {
      std::uint32_t is_morphed = morphed[t];
      number(is_morphed);
      morphed[t] = is_morphed != 0;
    }
  }

  Io& io_;
  GrowingModel& model_;
};

}  // namespace fovea
