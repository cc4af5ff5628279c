#include "fovea/io/gltf_references.h"

#include <optional>
#include <string_view>

namespace fovea::gltf {

namespace {

/// Where the walk is: only inside extensions do member names mean something to it.
struct Scope {
  bool extension = false;
  bool attributes = false;
  bool metadata = false;

  Scope below(const std::string& name) const {
    Scope inner = *this;
    inner.attributes = extension && name == "attributes";
    inner.metadata = metadata || (extension && name == "EXT_structural_metadata");
    inner.extension = extension || name == "extensions";
    return inner;
  }
  Scope inside_array() const { return {extension, false, metadata}; }
};

std::optional<DataReference> reference_kind(const Scope& scope, std::string_view name) {
  if (!scope.extension) return std::nullopt;
  if (scope.attributes || name == "accessor" || name.ends_with("Accessor")) return DataReference::accessor;
  if (name == "bufferView" || name.ends_with("BufferView")) return DataReference::buffer_view;
  if (scope.metadata && (name == "values" || name == "arrayOffsets" || name == "stringOffsets")) {
    return DataReference::buffer_view;
  }
  return std::nullopt;
}

void walk(Json& value, const Scope& scope, std::string& pointer, const DataReferenceVisitor& visit) {
  const std::size_t length = pointer.size();
  if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (!value[i].is_structured()) continue;
      pointer.append("/").append(std::to_string(i));
      walk(value[i], scope.inside_array(), pointer, visit);
      pointer.resize(length);
    }
  } else if (value.is_object()) {
    for (auto& [name, member] : value.items()) {
      if (name == "extras") continue;
      pointer.append("/").append(pointer_step(name));
      if (member.is_structured()) {
        walk(member, scope.below(name), pointer, visit);
      } else if (member.is_number_integer()) {
        if (const auto kind = reference_kind(scope, name)) visit(*kind, member, pointer);
      }
      pointer.resize(length);
    }
  }
}

}  // namespace

void visit_data_references(Json& object, const DataReferenceVisitor& visit) {
  std::string pointer;
  walk(object, Scope{}, pointer, visit);
}

}  // namespace fovea::gltf
