#pragma once

namespace fovea {

/// Four numbers that are worked on at once.
using Float4 __attribute__((vector_size(16))) = float;

}  // namespace fovea
