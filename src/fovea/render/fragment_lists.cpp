#include "fovea/render/fragment_lists.h"

namespace fovea {

std::size_t FragmentLists::bytes() const {
  std::size_t sum = pool_.capacity() * sizeof(Fragment) + behind_.size() * sizeof(List) +
                    fronts_.size() * (sizeof(FrontBlock) + sizeof(SecondBlock));
  for (const auto& rooms : free_) sum += rooms.capacity() * sizeof(rooms[0]);
  return sum;
}

/// Gives the list room for another number of fragments; as many as fit are kept.
void FragmentLists::resize(List& list, std::uint32_t size) {
  const std::uint32_t kept = std::min(list.size, size);
  const bool fits = list.size > 0 && size > 0 && room_class(list.size) == room_class(size);
  if (!fits) {
    std::uint32_t begin = 0;
    if (size > 0) {
      std::vector<std::uint32_t>& rooms = free_[room_class(size)];
      if (rooms.empty()) {
        begin = static_cast<std::uint32_t>(pool_.size());
        pool_.resize(pool_.size() + std::bit_ceil(size));
      } else {
        begin = rooms.back();
        rooms.pop_back();
      }
      std::copy_n(pool_.begin() + list.begin, kept, pool_.begin() + begin);
    }
    if (list.size > 0) free_[room_class(list.size)].push_back(list.begin);
    list.begin = begin;
  }
  list.size = size;
}

std::vector<Fragment> FragmentLists::at(std::size_t pixel) const {
  std::vector<Fragment> all;
  for (const Fragment& fragment : {first(pixel), second(pixel)}) {
    if (fragment.triangle != kInvalid) all.push_back(fragment);
  }
  const std::span<const Fragment> others = behind(pixel);
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

void FragmentLists::add_behind(std::size_t pixel, const Fragment& fragment) {
  List& list = behind_[pixel];
  std::uint32_t at = list.size;
  resize(list, list.size + 1);
  Fragment* const fragments = pool_.data() + list.begin;
  for (; at > 0 && fragment.is_before(fragments[at - 1]); --at) fragments[at] = fragments[at - 1];
  fragments[at] = fragment;
}

/// False if it is not there.
bool FragmentLists::drop_behind(std::size_t pixel, std::uint32_t triangle) {
  List& list = behind_[pixel];
  Fragment* const fragments = pool_.data() + list.begin;
  std::uint32_t at = 0;
  while (at < list.size && fragments[at].triangle != triangle) ++at;
  if (at == list.size) return false;
  std::copy(fragments + at + 1, fragments + list.size, fragments + at);
  resize(list, list.size - 1);
  return true;
}

/// Takes the nearest out, which is the background if there is none.
Fragment FragmentLists::take_behind(std::size_t pixel) {
  List& list = behind_[pixel];
  if (list.size == 0) return background_;
  Fragment* const fragments = pool_.data() + list.begin;
  const Fragment nearest = fragments[0];
  std::copy(fragments + 1, fragments + list.size, fragments);
  resize(list, list.size - 1);
  return nearest;
}

}  // namespace fovea
