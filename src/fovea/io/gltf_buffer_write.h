#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "fovea/io/gltf_json_write.h"
#include "fovea/io/write.h"
#include "fovea/model/accessor.h"

// Private to io: the binary side of a glTF file.

namespace fovea::gltf {

using Bytes = std::vector<std::byte>;

enum class ByteKind { geometry, images, animation, other };

/// Values of bufferView.target; `none` for data that no vertex or index buffer is made of.
enum class ViewTarget : int { none = 0, vertices = 34962, indices = 34963 };

/// A bufferView in the making.
struct View {
  Bytes bytes;
  ViewTarget target = ViewTarget::none;
  std::size_t stride = 0;  ///< Of an element in `bytes`; written as byteStride for vertices.
  std::size_t count = 0;   ///< Elements; needed for compression only.
};

/// An accessor over a view of vertices or indices.
struct ViewAccessor {
  int view = -1;  ///< -1: all zeros.
  std::size_t offset = 0;
  std::size_t count = 0;
  Storage storage;
  int width = 1;
  bool matrix = false;
  std::vector<double> low, high;  ///< Bounds as stored, empty for none.
  /// Set if only some elements differ from zero; `view` is -1 then.
  struct Sparse {
    std::size_t count = 0;
    int index_view = -1;  ///< Which elements, ascending, of type `index_type`.
    ComponentType index_type = ComponentType::u16;
    int value_view = -1;  ///< Their values, tightly packed.
  };
  std::optional<Sparse> sparse;
};

/// Small arrays of one use share a view, for the sake of short JSON; the format forbids to mix uses.
enum class PackedUse { animation, inverse_bind, instances };

/// glTF's "type" for a number of components: SCALAR, VEC2, ..., MAT4.
const char* type_name(int width, bool matrix);

/// Collects views and accessors, equal ones once, and lays them out in one buffer.
class BufferWriter {
 public:
  explicit BufferWriter(GeometryCompression compression) : compression_(compression) {}

  /// Index of a bufferView with these bytes, an earlier equal one if there is one.
  int add_view(View view, ByteKind kind);
  /// Never shared: for data whose index others rely on.
  int add_own_view(const Bytes& bytes);
  /// As `add_view`, compressed if that was asked for; `view` has vertices or triangle indices.
  int add_geometry(View view);
  int add_accessor(const ViewAccessor& accessor);
  /// Never shared: for accessors whose index others rely on.
  int add_own_accessor(const Accessor& accessor);
  /// Points, lines: an accessor with a view of its own, elements padded to 4 bytes for vertices.
  int add_plain(const Accessor& accessor, ViewTarget target, bool with_bounds);
  int add_packed(const Accessor& accessor, PackedUse use, bool with_bounds);

  /// Lays everything out; the members below are complete after it. Padded to 4 bytes.
  void finish();

  Json views = Json::array();
  Json accessors = Json::array();
  Bytes bytes;                     ///< Of buffer 0.
  std::size_t fallback_bytes = 0;  ///< Of buffer 1, which compressed views would unpack to.
  ByteCounts counts;

 private:
  struct Packed {
    int view = -1;
    Bytes bytes;
    std::unordered_multimap<std::uint64_t, std::pair<std::size_t, std::size_t>> places;  // offset, size
  };

  int place_view(Json view, const Bytes& data, ByteKind kind, std::size_t fallback);
  int add_compressed(const View& view);
  int add_accessor_json(Json accessor);
  std::size_t pack(Packed& packed, const Bytes& data);

  GeometryCompression compression_;
  std::unordered_multimap<std::uint64_t, int> view_of_content_;
  std::unordered_map<std::string, int> accessor_of_text_;
  std::map<PackedUse, Packed> packed_;
};

}  // namespace fovea::gltf
