#pragma once

#include <span>
#include <string>

#include "fovea/io/gltf_json.h"
#include "fovea/model/material.h"
#include "fovea/model/model.h"

// Private to io: JSON objects of glTF elements, made from what was read and what has changed since.

namespace fovea::gltf {

/// The object that an element's `json` text holds; an empty object for an empty text.
Json parse_object(const std::string& text);

/// A number without a fraction where it has none: 1, not 1.0.
Json number(double value);
Json numbers(std::span<const double> values);
Json numbers(Vec3d v);

/// Makes `object[key]` mean `value`, where an absent member means `standard`: a member that means it
/// already is not touched, one that need not be there is removed.
void refresh(Json& object, const char* key, const Json& value, const Json& standard = nullptr);
/// As `refresh` for indices, where -1 means absent.
void refresh_index(Json& object, const char* key, int index);

/// `object["extensions"][name]`, or null if there is none. Valid until `object` changes.
const Json* find_extension(const Json& object, const char* name);
/// Removes an extension, and "extensions" with the last one.
void erase_extension(Json& object, const char* name);

/// Text of an object. Strings that are not UTF-8 get replacement characters.
std::string to_text(const Json& json);

Json material_json(const Material& material);
Json sampler_json(const Sampler& sampler);
/// `mime_type` is that of the texture's image; it decides which extension, if any, names the image.
Json texture_json(const Texture& texture, const std::string& mime_type);
Json camera_json(const Camera& camera);
Json scene_json(const Scene& scene);
/// Without EXT_mesh_gpu_instancing, whose numbers live in buffers.
Json node_json(const Node& node);

}  // namespace fovea::gltf
