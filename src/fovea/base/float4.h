#pragma once

namespace fovea {

/// Four numbers that are worked on at once.
using Float4 [[gnu::vector_size(16)]] = float;

}  // namespace fovea
