#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "fovea/base/error.h"
#include "fovea/io/read.h"

namespace fovea {

/// Counts what a reader puts into memory, before it does, against ReadOptions::max_total_bytes and
/// ReadOptions::max_expansion.
class ByteBudget {
 public:
  /// Only the total is limited: for formats that do not expand.
  explicit ByteBudget(std::int64_t max_total_bytes)
      : max_total_(positive(max_total_bytes)), max_expansion_(kMost), input_(0) {}

  /// For a model whose file has `input_bytes`.
  ByteBudget(const ReadOptions& options, std::uint64_t input_bytes)
      : max_total_(positive(options.max_total_bytes)),
        max_expansion_(positive(options.max_expansion)),
        input_(input_bytes) {}

  /// Another file belongs to the model.
  void add_input(std::uint64_t bytes) { input_ += std::min(bytes, kMost - input_); }

  /// How much may be taken in all.
  std::uint64_t limit() const { return std::min(max_total_, max_expanded()); }

  /// Takes `count` × `size` bytes. Throws Error(limit) if that would go beyond a limit.
  void charge(std::uint64_t count, std::uint64_t size, const std::string& place) {
    const std::uint64_t bytes = product(count, size);
    if (bytes > max_total_ - used_) {
      throw Error(
          ErrorKind::limit,
          fmt::format("{} bytes more would exceed the {} bytes that a model may take", bytes, max_total_),
          place, "raise --max-total-bytes if the file is to be trusted");
    }
    if (used_ + bytes > max_expanded()) {
      throw Error(ErrorKind::limit,
                  fmt::format("{} bytes more would exceed the {} bytes that a file of {} may expand to",
                              bytes, max_expanded(), input_),
                  place, "raise --max-expansion if the file is to be trusted");
    }
    used_ += bytes;
  }

 private:
  static constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  static constexpr std::uint64_t kSmallFile = std::uint64_t{1} << 20;  // Files below count as this.

  static std::uint64_t positive(std::int64_t x) { return x > 0 ? static_cast<std::uint64_t>(x) : 0; }
  static std::uint64_t product(std::uint64_t a, std::uint64_t b) {
    return b != 0 && a > kMost / b ? kMost : a * b;
  }
  std::uint64_t max_expanded() const { return product(std::max(input_, kSmallFile), max_expansion_); }

  std::uint64_t max_total_;
  std::uint64_t max_expansion_;
  std::uint64_t input_;
  std::uint64_t used_ = 0;
};

}  // namespace fovea
