#include "fovea/io/draco_decode.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#pragma GCC diagnostic pop

#include "fovea/base/error.h"
#include "fovea/io/format_error.h"

namespace fovea::gltf {

namespace {

draco::DecoderBuffer buffer_of(std::span<const std::byte> stream) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  return buffer;
}

/// No stream packs more: a flat regular grid of a million triangles takes some ten thousand bytes.
constexpr std::size_t kMaxTrianglesPerByte = 4096;

/// What the stream claims before its data: the decoder believes it when it allocates.
struct Claim {
  std::uint32_t triangles = 0;
  std::uint32_t vertices = 0;  // without those that attribute seams add
};

draco::DracoHeader read_header(draco::DecoderBuffer& buffer) {
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) fail("the data is not a Draco stream");
  if (header.version_major != 2 || header.version_minor != 2) {
    throw Error(ErrorKind::unsupported, fmt::format("Draco bitstream {}.{} is not glTF's 2.2",
                                                    header.version_major, header.version_minor));
  }
  if (header.encoder_type != draco::TRIANGULAR_MESH) fail("the Draco stream is not a triangle mesh");
  return header;
}

Claim read_claim(std::span<const std::byte> stream) {
  draco::DecoderBuffer buffer = buffer_of(stream);
  const draco::DracoHeader header = read_header(buffer);
  buffer.set_bitstream_version(static_cast<std::uint16_t>(header.version_major << 8 | header.version_minor));
  if (header.flags & METADATA_FLAG_MASK) {
    draco::GeometryMetadata metadata;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) fail("damaged Draco metadata");
  }
  Claim claim;
  bool complete = true;
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
    std::uint8_t traversal = 0;
    complete = buffer.Decode(&traversal) && draco::DecodeVarint(&claim.vertices, &buffer) &&
               draco::DecodeVarint(&claim.triangles, &buffer);
  } else {
    complete =
        draco::DecodeVarint(&claim.triangles, &buffer) && draco::DecodeVarint(&claim.vertices, &buffer);
  }
  if (!complete) fail("the Draco stream ends early");
  if (claim.triangles / kMaxTrianglesPerByte > stream.size()) {
    fail(fmt::format("{} bytes of Draco data cannot hold {} triangles", stream.size(), claim.triangles));
  }
  return claim;
}

std::unique_ptr<draco::Mesh> decode(std::span<const std::byte> stream) {
  draco::DecoderBuffer buffer = buffer_of(stream);
  draco::Decoder decoder;
  try {
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (result.ok()) return std::move(result).value();
    fail(fmt::format("the Draco data is damaged ({})", result.status().error_msg_string()));
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, "the Draco data needs more memory than there is");
  } catch (const std::length_error&) {
    fail("the Draco data is damaged");
  }
}

template <class T>
void copy_values(const draco::PointAttribute& from, std::size_t count, int width,
                 std::vector<std::byte>& to) {
  T value[4];
  for (std::size_t i = 0; i < count; ++i) {
    const auto entry = from.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
    if (entry.value() >= from.size() ||
        !from.ConvertValue<T>(entry, static_cast<std::int8_t>(width), value)) {
      fail(fmt::format("the Draco data has no value for vertex {}", i));
    }
    std::memcpy(to.data() + i * static_cast<std::size_t>(width) * sizeof(T), value,
                static_cast<std::size_t>(width) * sizeof(T));
  }
}

Accessor read_attribute(const draco::Mesh& mesh, const DracoAttribute& wanted) {
  const draco::PointAttribute* from = mesh.GetAttributeByUniqueId(wanted.id);
  if (!from) fail(fmt::format("the Draco data has no attribute {}", wanted.id));
  if (wanted.shape.matrix || from->num_components() != wanted.shape.width) {
    fail(fmt::format("Draco attribute {} has {} components but its accessor {}", wanted.id,
                     from->num_components(), wanted.shape.width));
  }
  // Read as such, whatever bytes there are: no file has them, as glTF has no such type.
  if (from->data_type() == draco::DT_BOOL)
    fail(fmt::format("Draco attribute {} holds truth values, not numbers", wanted.id));
  Accessor out;
  out.storage = wanted.shape.storage;
  out.width = wanted.shape.width;
  out.count = mesh.num_points();
  out.bytes.resize(out.count * static_cast<std::size_t>(out.width) * size_of(out.storage.type));
  switch (out.storage.type) {
    case ComponentType::i8: copy_values<std::int8_t>(*from, out.count, out.width, out.bytes); break;
    case ComponentType::u8: copy_values<std::uint8_t>(*from, out.count, out.width, out.bytes); break;
    case ComponentType::i16: copy_values<std::int16_t>(*from, out.count, out.width, out.bytes); break;
    case ComponentType::u16: copy_values<std::uint16_t>(*from, out.count, out.width, out.bytes); break;
    case ComponentType::u32: copy_values<std::uint32_t>(*from, out.count, out.width, out.bytes); break;
    case ComponentType::f32: copy_values<float>(*from, out.count, out.width, out.bytes); break;
  }
  return out;
}

void check_counts(std::uint64_t triangles, std::uint64_t vertices, std::size_t max_triangles,
                  std::size_t max_vertices) {
  if (triangles > max_triangles || vertices > max_vertices) {
    fail(fmt::format("the Draco data has {} triangles and {} vertices, the accessors only {} and {}",
                     triangles, vertices, max_triangles, max_vertices));
  }
}

}  // namespace

DracoMesh decode_draco(std::span<const std::byte> stream, std::span<const DracoAttribute> attributes,
                       std::size_t max_triangles) {
  std::size_t max_vertices = std::numeric_limits<std::uint32_t>::max();
  for (const DracoAttribute& a : attributes) max_vertices = std::min(max_vertices, a.shape.count);
  const Claim claim = read_claim(stream);
  check_counts(claim.triangles, claim.vertices, max_triangles, std::max(max_vertices, 3 * max_triangles));
  const auto mesh = decode(stream);
  check_counts(mesh->num_faces(), mesh->num_points(), max_triangles, max_vertices);

  DracoMesh result;
  result.vertex_count = mesh->num_points();
  result.indices.reserve(std::size_t{3} * mesh->num_faces());
  for (std::uint32_t f = 0; f < mesh->num_faces(); ++f) {
    for (const auto& point : mesh->face(draco::FaceIndex(f))) result.indices.push_back(point.value());
  }
  for (const DracoAttribute& a : attributes) result.attributes.push_back(read_attribute(*mesh, a));
  return result;
}

}  // namespace fovea::gltf
