#pragma once

#include <functional>
#include <string>

#include "fovea/io/gltf_json.h"

// Private to io: what reading and writing glTF must agree on.

namespace fovea::gltf {

/// What a number inside an extension counts: accessors or buffer views.
enum class DataReference { accessor, buffer_view };

/// Called with the kind, the number itself (to read or replace) and its JSON pointer below the object
/// that was visited ("/extensions/EXT_x/attributes/_ID").
using DataReferenceVisitor = std::function<void(DataReference, Json&, const std::string& pointer)>;

/// Visits every accessor and buffer view index inside the extensions of a glTF object, at any depth,
/// in the order of the file. The one rule that reading and writing share (Model::json and all
/// other `json` texts): below an "extensions" member, outside of "extras", an integer is an index if
/// its member is called "accessor" or "bufferView" or ends in "Accessor" or "BufferView", if it is a
/// member of an object called "attributes" (an accessor), or if EXT_structural_metadata defines it so
/// ("values", "arrayOffsets" and "stringOffsets" of a property table: buffer views).
///
/// Recursive: the depth of `object` must be limited (gltf_json.h does).
void visit_data_references(Json& object, const DataReferenceVisitor& visit);

}  // namespace fovea::gltf
