#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

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
class ReadState {
 public:
  ReadState(const JsonView& root_view, DataReader& reader, ByteBudget& byte_budget,
            const ReadOptions& read_options, Context& call_context, Model& target, Keeper& json_keeper);

  /// Number of elements of an array of the root object.
  std::size_t count(const char* array) const;
  std::size_t light_count() const { return light_count_; }

  /// Appends to a list of the model; its size in memory is charged.
  template <class T>
  void add(std::vector<T>& list, T element, const JsonView& at) {
    budget.charge(1, sizeof(T) + kBytesPerElement, at.place());
    list.push_back(std::move(element));
  }

  /// The numbers of an accessor; those that are not finite become 0, which is reported.
  std::vector<float> finite_floats(const Accessor& accessor, const JsonView& at);

  const JsonView& root;
  DataReader& data;
  ByteBudget& budget;
  const ReadOptions& options;
  Context& context;
  Model& model;
  Keeper& keeper;

 private:
  static constexpr std::uint64_t kBytesPerElement = 128;  // Views and names on the way, roughly.

  std::map<std::string, std::size_t, std::less<>> counts_;
  std::size_t light_count_ = 0;
};

/// A copy of `object` without some of its members.
Json without(const Json& object, std::initializer_list<const char*> members);

}  // namespace fovea::gltf
