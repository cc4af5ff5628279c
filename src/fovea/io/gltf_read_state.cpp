#include "fovea/io/gltf_read_state.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "fovea/io/gltf_references.h"

namespace fovea::gltf {

std::string Keeper::keep(Json object, const JsonView& at) {
  visit_data_references(object, [&](DataReference kind, Json& number, const std::string& pointer) {
    const Json value = number;
    const JsonView reference = at.inner(value, pointer);
    number = kind == DataReference::accessor ? carry_accessor(reference) : carry_view(reference);
  });
  std::string text = object.dump();
  budget_.charge(text.size(), 1, at.place());
  return text;
}

std::size_t Keeper::carry_accessor(const JsonView& reference) {
  const auto [entry, is_new] =
      carried_accessor_.emplace(data_.accessor_index(reference), model_.carried_accessors.size());
  if (is_new) model_.carried_accessors.push_back(data_.read(entry->first));
  return entry->second;
}

std::size_t Keeper::carry_view(const JsonView& reference) {
  const auto [entry, is_new] =
      carried_view_.emplace(data_.view_index(reference), model_.carried_buffer_views.size());
  if (is_new) {
    const auto bytes = data_.view(entry->first);
    budget_.charge(bytes.size(), 1, reference.place());
    model_.carried_buffer_views.emplace_back(bytes.begin(), bytes.end());
  }
  return entry->second;
}

ReadState::ReadState(const JsonView& root_view, DataReader& reader, ByteBudget& byte_budget,
                     const ReadOptions& read_options, Context& call_context, Model& target,
                     Keeper& json_keeper)
    : root(root_view),
      data(reader),
      budget(byte_budget),
      options(read_options),
      context(call_context),
      model(target),
      keeper(json_keeper) {
  for (const auto& [name, member] : root.members()) {
    if (member.raw().is_array()) counts_.emplace(name, member.raw().size());
  }
  const auto lights = root.extension("KHR_lights_punctual");
  if (lights) light_count_ = lights->elements("lights").size();
}

std::size_t ReadState::count(const char* array) const {
  const auto known = counts_.find(array);
  return known == counts_.end() ? 0 : known->second;
}

std::vector<float> ReadState::finite_floats(const Accessor& accessor, const JsonView& at) {
  budget.charge(accessor.count, sizeof(float) * static_cast<std::uint64_t>(accessor.width), at.place());
  std::vector<float> values = accessor.to_floats();
  std::uint64_t bad = 0;
  for (float& value : values) {
    if (std::isfinite(value)) continue;
    value = 0;
    ++bad;
  }
  if (bad > 0) {
    context.report("non-finite-values", "numbers that are not finite were replaced by 0", at.place(), bad);
  }
  return values;
}

Json without(const Json& object, std::initializer_list<const char*> members) {
  Json rest = Json::object();
  for (const auto& [name, member] : object.get_ref<const Json::object_t&>()) {
    const bool dropped = std::any_of(members.begin(), members.end(),
                                     [&name = name](const char* m) { return std::string_view(m) == name; });
    // Appended as it is: names are distinct already, and looking for doubles would be quadratic.
    if (!dropped) rest.get_ref<Json::object_t&>().emplace_back(name, member);
  }
  return rest;
}

}  // namespace fovea::gltf
