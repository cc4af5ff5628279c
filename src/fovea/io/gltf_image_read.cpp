#include <fmt/format.h>

#include "fovea/base/error.h"
#include "fovea/io/gltf_material_read.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/uri.h"

namespace fovea::gltf {

namespace {

std::vector<std::uint8_t> to_bytes(std::span<const std::byte> bytes) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return {first, first + bytes.size()};
}

/// Fills bytes and, for a file of its own, the path; returns the type that the source declares.
std::string load_uri(ReadState& state, const JsonView& uri, EncodedImage& image) {
  const std::string& text = uri.text();
  try {
    if (is_data_uri(text)) {
      state.budget.charge(text.size(), 1, uri.place());
      DataUri data = decode_data_uri(text);
      image.bytes = to_bytes(data.bytes);
      return std::move(data.mime_type);
    }
    image.uri = relative_path_of_uri(text);
  } catch (const Error& e) {
    throw e.place().empty() ? e.within(uri.place()) : e;
  }
  image.bytes = to_bytes(state.data.side_file(image.uri, uri));
  return {};
}

void load_view(ReadState& state, const JsonView& view, EncodedImage& image) {
  const auto bytes = state.data.view(state.data.view_index(view));
  state.budget.charge(bytes.size(), 1, view.place());
  image.bytes = to_bytes(bytes);
}

/// By content; what is written beside it only counts where the content says nothing.
std::string mime_type(ReadState& state, const EncodedImage& image, const std::string& declared,
                      const JsonView& json) {
  const std::string found = image_info(image.bytes).mime_type;
  if (found.empty()) return declared;
  if (!declared.empty() && declared != found) {
    state.context.report("image-type", fmt::format("an image declared as {} is {}", shown(declared), found),
                         json.place());
  }
  return found;
}

EncodedImage read_image(ReadState& state, const JsonView& json) {
  EncodedImage image;
  image.name = json.text("name");
  std::string declared = json.text("mimeType");
  if (const auto uri = json.find("uri")) {
    const std::string type = load_uri(state, *uri, image);
    if (declared.empty()) declared = type;
  } else {
    load_view(state, json.at("bufferView"), image);
  }
  image.mime_type = mime_type(state, image, declared, json);
  image.json = state.keeper.keep(without(json.raw(), {"uri", "bufferView", "mimeType"}), json);
  return image;
}

}  // namespace

void read_images(ReadState& state) {
  for (const JsonView& json : state.root.elements("images")) {
    state.context.advance_or_throw("read", 0);
    state.add(state.model.images, read_image(state, json), json);
  }
}

}  // namespace fovea::gltf
