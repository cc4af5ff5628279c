#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace fovea {

/// The most triangles, up to `most`, with which `bytes_at` gives no more than `bytes`; none if it gives more
/// even with the fewest. To about a hundredth of the bytes: `bytes_at`, which should rise nearly in a
/// straight line, is asked four times or so, at most 12, and never twice for the same number.
std::optional<std::uint64_t> most_triangles(
    std::uint64_t bytes, std::uint64_t most,
    const std::function<std::uint64_t(std::uint64_t triangles)>& bytes_at);

}  // namespace fovea
