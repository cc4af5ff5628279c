#pragma once

#include <cassert>
#include <span>
#include <utility>
#include <vector>

#include "fovea/model/ids.h"

namespace fovea {

/// One value per element of a mesh, indexed by the element's id and by nothing else.
template <class IdType, class T = float>
class Field {
 public:
  Field() = default;
  explicit Field(std::size_t size, T value = {}) : values_(size, value) {}
  explicit Field(std::vector<T> values) : values_(std::move(values)) {}

  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  T operator[](IdType id) const {
    assert(id.index() < values_.size());
    return values_[id.index()];
  }
  T& operator[](IdType id) {
    assert(id.index() < values_.size());
    return values_[id.index()];
  }
  std::span<const T> values() const { return values_; }
  std::span<T> values() { return values_; }
  friend bool operator==(const Field&, const Field&) = default;

 private:
  std::vector<T> values_;
};

using VertexField = Field<VertexId>;  ///< [#V]
using FaceField = Field<FaceId>;      ///< [#F]
using CornerField = Field<CornerId>;  ///< [#F × 3]

}  // namespace fovea
