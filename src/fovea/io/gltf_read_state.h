#pragma once

#include <initializer_list>
#include <map>
#include <string>

#include "fovea/base/context.h"
#include "fovea/io/byte_budget.h"
#include "fovea/io/gltf_accessor_read.h"
#include "fovea/io/gltf_json.h"
#include "fovea/io/read.h"
#include "fovea/model/model.h"

// Private to io.

namespace fovea::gltf {

/// Turns what is left of a glTF object into the text that an element keeps (model/model.h), and moves
/// the data that its extensions refer to into the model's carried lists.
class Keeper {
 public:
  Keeper(DataReader& data, ByteBudget& budget, Model& model) : data_(data), budget_(budget), model_(model) {}

  /// The text of `object`, which stood at `at`; indices of accessors and buffer views in it count into
  /// the carried lists.
  std::string keep(Json object, const JsonView& at);

 private:
  std::size_t carry_accessor(const JsonView& reference);
  std::size_t carry_view(const JsonView& reference);

  DataReader& data_;
  ByteBudget& budget_;
  Model& model_;
  std::map<int, std::size_t> carried_accessor_;  // accessor in the file -> in the model
  std::map<int, std::size_t> carried_view_;
};

/// What all parts of reading one file share.
struct ReadState {
  const JsonView& root;
  DataReader& data;
  ByteBudget& budget;
  const ReadOptions& options;
  Context& context;
  Model& model;
  Keeper& keeper;

  /// Number of elements of an array of the root object.
  std::size_t count(const char* array) const {
    const auto it = root.raw().find(array);
    return it != root.raw().end() && it->is_array() ? it->size() : 0;
  }
};

/// A copy of `object` without some of its members.
Json without(const Json& object, std::initializer_list<const char*> members);

}  // namespace fovea::gltf
