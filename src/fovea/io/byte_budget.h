#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <string>

#include "fovea/base/error.h"

namespace fovea {

/// Counts what a reader puts into memory, before it does, against ReadOptions::max_total_bytes.
class ByteBudget {
 public:
  explicit ByteBudget(std::int64_t max_bytes)
      : max_(max_bytes > 0 ? static_cast<std::uint64_t>(max_bytes) : 0) {}

  /// Takes `count` × `size` bytes. Throws Error(limit) if that would go beyond the limit.
  void charge(std::uint64_t count, std::uint64_t size, const std::string& place) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t bytes = size != 0 && count > kMost / size ? kMost : count * size;
    if (bytes > max_ - used_) {
      throw Error(ErrorKind::limit,
                  fmt::format("{} bytes more would exceed the {} bytes that a model may take", bytes, max_),
                  place, "raise max-total-bytes if the file is to be trusted");
    }
    used_ += bytes;
  }

 private:
  std::uint64_t max_;
  std::uint64_t used_ = 0;
};

}  // namespace fovea
