#pragma once

#include <string>
#include <vector>

#include "fovea/io/gltf_buffer_write.h"
#include "fovea/io/gltf_column.h"

// Private to io: triangles as views and accessors.

namespace fovea::gltf {

/// A part ready to be placed in a buffer: bytes of its views, and accessors whose `view` counts into
/// `views`.
struct EncodedPart {
  struct Attribute {
    std::string name;
    ViewAccessor accessor;
  };
  std::vector<View> views;
  std::vector<Attribute> attributes;
  std::vector<std::vector<Attribute>> targets;
  ViewAccessor indices;
  bool quantized = false;  ///< Needs KHR_mesh_quantization.
  std::string json;        ///< Of the part.
  int material = -1;
};

/// Splits nothing and knows no file: pure work on one part, so that parts can be encoded in parallel.
/// `part` has triangles; `ordered`: its triangles and vertices stay in their order.
EncodedPart encode_part(SplitPart part, bool ordered, const WriteOptions& options, const Grid* grid,
                        Context& context, const std::string& place);

/// Puts an encoded part into the buffer and returns its glTF primitive.
Json place_part(EncodedPart part, BufferWriter& buffers);

/// Points and lines, as they came. `quantized` is set if they need KHR_mesh_quantization.
Json place_raw(const Part& part, BufferWriter& buffers, bool& quantized);

}  // namespace fovea::gltf
