#include "fovea/io/gltf_instances.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fovea::gltf {

namespace {

constexpr const char* kName = "EXT_mesh_gpu_instancing";

/// Translations, rotations and scales as glTF stores them, [#instances × 3, 4, 3].
struct Placements {
  std::vector<float> translations, rotations, scales;
};

Quat rotation_of(const Mat4& m) {
  // Shepperd's method: the largest of the four squares keeps the division safe.
  const double xx = m(0, 0), yy = m(1, 1), zz = m(2, 2);
  const double squares[4] = {1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz, 1 + xx + yy + zz};
  const auto largest = std::max_element(squares, squares + 4) - squares;
  const double s = 0.5 / std::sqrt(squares[largest]);
  switch (largest) {
    case 0:
      return {squares[0] * s, (m(0, 1) + m(1, 0)) * s, (m(0, 2) + m(2, 0)) * s, (m(2, 1) - m(1, 2)) * s};
    case 1:
      return {(m(0, 1) + m(1, 0)) * s, squares[1] * s, (m(1, 2) + m(2, 1)) * s, (m(0, 2) - m(2, 0)) * s};
    case 2:
      return {(m(0, 2) + m(2, 0)) * s, (m(1, 2) + m(2, 1)) * s, squares[2] * s, (m(1, 0) - m(0, 1)) * s};
    default:
      return {(m(2, 1) - m(1, 2)) * s, (m(0, 2) - m(2, 0)) * s, (m(1, 0) - m(0, 1)) * s, squares[3] * s};
  }
}

/// An instance has translation, rotation and scale only; shear is lost.
void decompose(Mat4 m, Placements& to) {
  double scale[3];
  for (int c = 0; c < 3; ++c) scale[c] = length(Vec3d{m(0, c), m(1, c), m(2, c)});
  if (determinant3(m) < 0) scale[0] = -scale[0];
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3 && scale[c] != 0; ++r) m(r, c) /= scale[c];
  }
  const Quat q = rotation_of(m);
  for (int r = 0; r < 3; ++r) to.translations.push_back(static_cast<float>(m(r, 3)));
  for (const double x : {q.x, q.y, q.z, q.w}) to.rotations.push_back(static_cast<float>(x));
  for (const double s : scale) to.scales.push_back(static_cast<float>(s));
}

/// The numbers of an attribute of the extension as it was read; empty if it has none.
std::vector<float> read_attribute(const Json& attributes, const char* name, int width, std::size_t count,
                                  const std::vector<Accessor>& carried) {
  const auto at = attributes.find(name);
  if (at == attributes.end() || !at->is_number_integer()) return {};
  const auto index = at->get<std::int64_t>();
  if (index < 0 || static_cast<std::size_t>(index) >= carried.size()) return {};
  const Accessor& accessor = carried[static_cast<std::size_t>(index)];
  return accessor.width == width && accessor.count == count ? accessor.to_floats() : std::vector<float>{};
}

bool has_places(const Json& extension) {
  const auto attributes = extension.find("attributes");
  if (attributes == extension.end()) return false;
  return attributes->contains("TRANSLATION") || attributes->contains("ROTATION") ||
         attributes->contains("SCALE");
}

bool nearly_equal(const Mat4& a, const Mat4& b) {
  double size = 1;
  for (const double x : a.m) size = std::max(size, std::abs(x));
  // Matrices are made from floats, whose rounding is 6e-8.
  return std::equal(a.m.begin(), a.m.end(), b.m.begin(),
                    [&](double x, double y) { return std::abs(x - y) <= 1e-6 * size; });
}

bool says_already(const Json& extension, const Node& node, const std::vector<Accessor>& carried) {
  const auto attributes = extension.find("attributes");
  if (attributes == extension.end() || !attributes->is_object()) return false;
  const std::size_t count = node.instances.size();
  const auto t = read_attribute(*attributes, "TRANSLATION", 3, count, carried);
  const auto r = read_attribute(*attributes, "ROTATION", 4, count, carried);
  const auto s = read_attribute(*attributes, "SCALE", 3, count, carried);
  if (t.empty() && r.empty() && s.empty()) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d translation = t.empty() ? Vec3d{0, 0, 0} : Vec3d{t[3 * i], t[3 * i + 1], t[3 * i + 2]};
    const Quat rotation = r.empty() ? Quat{} : Quat{r[4 * i], r[4 * i + 1], r[4 * i + 2], r[4 * i + 3]};
    const Vec3d scale = s.empty() ? Vec3d{1, 1, 1} : Vec3d{s[3 * i], s[3 * i + 1], s[3 * i + 2]};
    if (!nearly_equal(compose(translation, rotation, scale), node.instances[i])) return false;
  }
  return true;
}

}  // namespace

void write_instances(Json& object, const Node& node, const std::vector<Accessor>& carried,
                     BufferWriter& buffers) {
  if (node.mesh < 0) erase_extension(object, kName);
  if (node.instances.empty()) {
    const Json* read = find_extension(object, kName);
    // Attributes of other extensions stay, even without places of their own.
    if (read && has_places(*read)) erase_extension(object, kName);
  }
  if (node.mesh < 0 || node.instances.empty()) return;
  const Json* present = find_extension(object, kName);
  if (present && says_already(*present, node, carried)) return;
  Placements placements;
  for (const Mat4& m : node.instances) decompose(m, placements);
  Json& attributes = object["extensions"][kName]["attributes"];
  const auto store = [&](const char* name, const std::vector<float>& values, int width) {
    attributes[name] = buffers.add_packed(Accessor::from_floats(values, width), PackedUse::instances, false);
  };
  store("TRANSLATION", placements.translations, 3);
  store("ROTATION", placements.rotations, 4);
  store("SCALE", placements.scales, 3);
}

}  // namespace fovea::gltf
