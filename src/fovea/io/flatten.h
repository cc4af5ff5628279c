#pragma once

#include <bit>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/write.h"
#include "fovea/model/model.h"

// Private to io: what the writers of formats without a node hierarchy have in common.

namespace fovea {

/// A mesh as an instance shows it, and how that turns the mesh's numbers into the scene's.
struct PlacedMesh {
  std::size_t mesh = 0;
  Mat4 transform;
  bool mirrored = false;  ///< Winding must be turned.

  Vec3f position(Vec3f p) const;
  /// Unit vector (0, 0, 1 for one without a direction).
  Vec3f normal(Vec3f n) const;
};

/// Every instance of every mesh, mesh by mesh.
std::vector<PlacedMesh> placed_meshes(const Model& model);

/// Which texture coordinates a material's base colour reads.
struct UvSource {
  int set = 0;
  UvMatrixd matrix;
  friend bool operator==(const UvSource&, const UvSource&) = default;

  /// The coordinates with the transform worked in and the origin at the bottom left.
  Vec2f apply(const float* uv) const;
};
UvSource uv_source(const Model& model, int material);

/// Indices of the materials that triangles of shown meshes use, in order of first use; -1 left out.
std::vector<int> used_materials(const Model& model, const std::vector<PlacedMesh>& shown);

/// Names that image files beside the output get [as many as `images`], their content in `files`.
std::vector<std::string> add_image_files(const Model& model, const std::vector<int>& images,
                                         const std::string& stem, std::vector<OutputFile>& files);

/// Reports as "lost-on-export" what the format has no place for. `more` is added to what all such
/// formats lose.
void report_losses(const Model& model, const char* format, std::vector<std::string> more, Context& context);

/// Text and numbers into bytes.
class ByteWriter {
 public:
  void put(std::string_view text);
  /// The shortest text that reads back as the same float.
  void put_number(float value);
  void put_number(std::size_t value);
  template <class T>
  void put_little_endian(T value) {
    static_assert(std::endian::native == std::endian::little);
    const auto* data = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), data, data + sizeof value);
  }
  std::vector<std::byte> bytes;
};

}  // namespace fovea
