#include "fovea/io/gltf_shared_vertices.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <vector>

#include "fovea/model/key_table.h"

namespace fovea::gltf {

namespace {

/// Calls f(list, width) for each list of numbers that vertices have.
template <class Part, class F>
void for_lists(Part& part, F&& f) {
  for (auto& array : part.attributes) f(array.values, static_cast<std::size_t>(array.width));
  for (auto& target : part.attribute_morphs) {
    for (auto& array : target) f(array.values, static_cast<std::size_t>(array.width));
  }
}

bool same_array(const VertexArray& a, const VertexArray& b) {
  return a.semantic == b.semantic && a.set == b.set && a.name == b.name && a.width == b.width &&
         a.storage == b.storage;
}

bool same_attributes(const SplitPart& a, const SplitPart& b) {
  const auto same_arrays = [](const auto& x, const auto& y) { return std::ranges::equal(x, y, same_array); };
  return a.position_storage == b.position_storage && same_arrays(a.attributes, b.attributes) &&
         std::ranges::equal(a.attribute_morphs, b.attribute_morphs, same_arrays) &&
         std::ranges::equal(a.position_morphs, b.position_morphs,
                            [](const auto& x, const auto& y) { return x.empty() == y.empty(); });
}

/// All numbers of a vertex, one after the other.
void put_numbers(const SplitPart& part, std::size_t v, std::vector<float>& numbers) {
  numbers.clear();
  const auto put = [&](Vec3f p) { numbers.insert(numbers.end(), {p.x, p.y, p.z}); };
  put(part.positions[v]);
  for (const auto& morph : part.position_morphs) {
    if (!morph.empty()) put(morph[v]);
  }
  for_lists(part, [&](const std::vector<float>& list, std::size_t width) {
    const auto from = list.begin() + static_cast<std::ptrdiff_t>(v * width);
    numbers.insert(numbers.end(), from, from + static_cast<std::ptrdiff_t>(width));
  });
}

/// Vertices with what `put_numbers` gives for each.
class SharedVertices {
 public:
  SharedVertices(const SplitPart& like, std::size_t expected, std::size_t width)
      : shared_(like), key_(width), table_(width, expected) {
    shared_.positions.clear();
    for (auto& morph : shared_.position_morphs) morph.clear();
    for_lists(shared_, [](std::vector<float>& list, std::size_t) { list.clear(); });
    for (const auto& morph : like.position_morphs) has_morph_.push_back(!morph.empty());
  }

  std::uint32_t add(const std::vector<float>& numbers) {
    std::ranges::transform(numbers, key_.begin(), KeyTable::word);
    const std::uint32_t number = table_.insert(key_);
    if (number == shared_.positions.size()) append(numbers.data());
    return number;
  }

  /// Gives a part these vertices.
  void give(SplitPart& part) const {
    part.positions = shared_.positions;
    part.position_morphs = shared_.position_morphs;
    part.attributes = shared_.attributes;
    part.attribute_morphs = shared_.attribute_morphs;
  }

 private:
  void append(const float* from) {
    const auto take = [&](std::vector<Vec3f>& list) {
      list.push_back({from[0], from[1], from[2]});
      from += 3;
    };
    take(shared_.positions);
    for (std::size_t t = 0; t < has_morph_.size(); ++t) {
      if (has_morph_[t]) take(shared_.position_morphs[t]);
    }
    for_lists(shared_, [&](std::vector<float>& list, std::size_t width) {
      list.insert(list.end(), from, from + width);
      from += width;
    });
  }

  SplitPart shared_;  // without triangles
  std::vector<bool> has_morph_;
  std::vector<std::uint32_t> key_;
  KeyTable table_;
};

}  // namespace

bool share_vertices(std::span<SplitPart* const> levels) {
  std::vector<SplitPart*> with_triangles;
  std::ranges::copy_if(levels, std::back_inserter(with_triangles),
                       [](const SplitPart* part) { return !part->part.raw && !part->indices.empty(); });
  if (with_triangles.empty()) return true;
  const SplitPart& finest = *with_triangles.front();
  if (!std::ranges::all_of(with_triangles,
                           [&](const SplitPart* part) { return same_attributes(finest, *part); }))
    return false;
  std::vector<float> numbers;
  put_numbers(finest, 0, numbers);
  SharedVertices shared(finest, finest.positions.size(), numbers.size());
  for (auto level = with_triangles.rbegin(); level != with_triangles.rend(); ++level) {
    SplitPart& part = **level;
    meshopt_optimizeVertexCache(part.indices.data(), part.indices.data(), part.indices.size(),
                                part.positions.size());
    std::vector<std::uint32_t> number(part.positions.size(), kInvalid);
    for (std::uint32_t& index : part.indices) {
      if (number[index] == kInvalid) {
        put_numbers(part, index, numbers);
        number[index] = shared.add(numbers);
      }
      index = number[index];
    }
  }
  for (SplitPart* part : with_triangles) shared.give(*part);
  return true;
}

}  // namespace fovea::gltf
