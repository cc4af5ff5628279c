#include "fovea/render/face_map.h"

#include <algorithm>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/srgb.h"
#include "fovea/render/plain_model.h"

namespace fovea {

namespace {

void check_numbers(const Model& model, const std::vector<FaceNumbers>& numbers) {
  bool fits = numbers.size() == model.meshes.size();
  for (std::size_t m = 0; fits && m < numbers.size(); ++m)
    fits = numbers[m].size() == model.meshes[m].surface.face_count();
  if (!fits) throw Error(ErrorKind::usage, "the numbers are those of another model");
}

/// A layer without values yet in which corners share one if they have the same vertex and number; and the
/// number of each value.
std::pair<AttributeLayer, std::vector<std::uint32_t>> layer_of(const TriMesh& mesh,
                                                               const FaceNumbers& numbers) {
  const auto key = [&](std::uint32_t c) {
    return std::pair(mesh.vertex(CornerId{c}), numbers[face_of(CornerId{c})]);
  };
  std::vector<std::uint32_t> corners(3 * mesh.face_count());
  for (std::uint32_t c = 0; c < corners.size(); ++c) corners[c] = c;
  std::sort(corners.begin(), corners.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  AttributeLayer layer;
  layer.corner_value.resize(corners.size());
  std::vector<std::uint32_t> number_of_value;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i == 0 || key(corners[i]) != key(corners[i - 1])) number_of_value.push_back(key(corners[i]).second);
    layer.corner_value[corners[i]] = ValueId{number_of_value.size() - 1};
  }
  return {std::move(layer), std::move(number_of_value)};
}

AttributeLayer color_layer(const TriMesh& mesh, const FaceNumbers& numbers,
                           std::span<const std::array<std::uint8_t, 3>> colors) {
  constexpr std::array<std::uint8_t, 3> kGrey{128, 128, 128};
  auto [layer, number_of_value] = layer_of(mesh, numbers);
  layer.semantic = Semantic::color;
  layer.width = 3;
  layer.storage = {ComponentType::u16, true};
  for (const std::uint32_t number : number_of_value) {
    for (const std::uint8_t c : number == kInvalid ? kGrey : colors[number])
      layer.values.push_back(to_light(c));
  }
  return std::move(layer);
}

}  // namespace

Model face_map(const Model& model, const std::vector<FaceNumbers>& numbers,
               std::span<const std::array<std::uint8_t, 3>> colors) {
  check_numbers(model, numbers);
  Model result = plain_model(model, "regions");
  for (std::size_t m = 0; m < result.meshes.size(); ++m) {
    TriMesh& mesh = result.meshes[m].surface;
    mesh.layers.push_back(color_layer(mesh, numbers[m], colors));
  }
  return result;
}

Model with_face_attribute(const Model& model, const std::vector<FaceNumbers>& numbers,
                          const std::string& name) {
  check_numbers(model, numbers);
  Model result = model;
  for (std::size_t m = 0; m < result.meshes.size(); ++m) {
    TriMesh& mesh = result.meshes[m].surface;
    remove_attribute(mesh, name);
    auto [layer, number_of_value] = layer_of(mesh, numbers[m]);
    layer.name = name;
    layer.width = 1;
    for (const std::uint32_t number : number_of_value)
      layer.values.push_back(number == kInvalid ? -1.0f : static_cast<float>(number));
    mesh.layers.push_back(std::move(layer));
  }
  return result;
}

}  // namespace fovea
