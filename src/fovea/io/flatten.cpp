#include "fovea/io/flatten.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "fovea/io/gltf_images_write.h"
#include "fovea/io/uri.h"
#include "fovea/model/texture_use.h"

namespace fovea {

namespace {

/// The matrix of cofactors times `d`: for normals, up to length, the inverse transposed, and good for
/// flattened meshes too.
Vec3d cofactors_times(const Mat4& a, Vec3d d) {
  const auto column = [&](int c) { return Vec3d{a(0, c), a(1, c), a(2, c)}; };
  const Vec3d x = column(0), y = column(1), z = column(2);
  return cross(y, z) * d.x + cross(z, x) * d.y + cross(x, y) * d.z;
}

std::uint64_t count_raw_parts(const Model& model) {
  std::uint64_t count = 0;
  for (const Mesh& mesh : model.meshes) {
    for (const Part& part : mesh.surface.parts) count += part.raw.has_value();
  }
  return count;
}

}  // namespace

Vec3f PlacedMesh::position(Vec3f p) const { return Vec3f(transform_point(transform, Vec3d(p))); }

Vec3f PlacedMesh::normal(Vec3f n) const {
  const Vec3d turned = cofactors_times(transform, Vec3d(n)) * (mirrored ? -1.0 : 1.0);
  const double l = length(turned);
  return l > 0 && std::isfinite(l) ? Vec3f(turned / l) : Vec3f{0, 0, 1};
}

std::vector<PlacedMesh> placed_meshes(const Model& model) {
  std::vector<PlacedMesh> result;
  const auto instances = mesh_instances(model);
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (model.meshes[m].surface.face_count() == 0) continue;
    for (const Mat4& transform : instances[m]) result.push_back({m, transform, determinant3(transform) < 0});
  }
  return result;
}

Vec2f UvSource::apply(const float* uv) const {
  if (matrix == UvMatrixd{}) return {uv[0], 1.0f - uv[1]};
  const Vec2d at = matrix({static_cast<double>(uv[0]), static_cast<double>(uv[1])});
  return {static_cast<float>(at.x), static_cast<float>(1 - at.y)};
}

UvSource uv_source(const Model& model, int material) {
  if (material < 0) return {};
  const auto& base = model.materials[static_cast<std::size_t>(material)].base_color;
  return base ? UvSource{base->uv_set, matrix(*base)} : UvSource{};
}

std::vector<int> used_materials(const Model& model, const std::vector<PlacedMesh>& shown) {
  std::vector<bool> seen(model.materials.size(), false);
  std::vector<int> result;
  for (const PlacedMesh& placed : shown) {
    const TriMesh& mesh = model.meshes[placed.mesh].surface;
    for (const std::uint32_t part : mesh.face_part) {
      const int material = mesh.parts[part].material;
      if (material < 0 || seen[static_cast<std::size_t>(material)]) continue;
      seen[static_cast<std::size_t>(material)] = true;
      result.push_back(material);
    }
  }
  return result;
}

std::vector<std::string> add_image_files(const Model& model, const std::vector<int>& images,
                                         const std::string& stem, std::vector<OutputFile>& files) {
  std::vector<EncodedImage> chosen;
  for (const int i : images) chosen.push_back(model.images[static_cast<std::size_t>(i)]);
  ByteCounts counts;
  const gltf::Json objects = gltf::image_files(chosen, stem, files, counts);
  std::vector<std::string> names;
  for (const auto& object : objects) names.push_back(percent_decode(object.value("uri", std::string())));
  return names;
}

void report_losses(const Model& model, const char* format, std::vector<std::string> more, Context& context) {
  std::vector<std::string> lost;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) lost.push_back(fmt::format("{} {}", count, what));
  };
  std::size_t targets = 0;
  for (const Mesh& mesh : model.meshes) targets += mesh.surface.target_count();
  add(model.skins.size(), "skins");
  add(model.animations.size(), "animations");
  add(targets, "morph targets");
  add(model.cameras.size(), "cameras");
  add(count_raw_parts(model), "parts of points or lines");
  lost.insert(lost.end(), more.begin(), more.end());
  if (lost.empty()) return;
  context.report("lost-on-export", fmt::format("{} has no place for {}", format, fmt::join(lost, ", ")));
}

void ByteWriter::put(std::string_view text) {
  const auto* data = reinterpret_cast<const std::byte*>(text.data());
  bytes.insert(bytes.end(), data, data + text.size());
}

void ByteWriter::put_number(float value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value + 0.0f).ptr;
  put({text.data(), static_cast<std::size_t>(end - text.data())});
}

void ByteWriter::put_number(std::size_t value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  put({text.data(), static_cast<std::size_t>(end - text.data())});
}

}  // namespace fovea
