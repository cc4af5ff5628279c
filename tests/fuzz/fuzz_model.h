#pragma once

#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "fovea/base/error.h"
#include "fovea/io/obj_write.h"
#include "fovea/io/ply_write.h"
#include "fovea/io/read.h"
#include "fovea/model/model.h"

namespace fovea::fuzz {

inline std::span<const std::byte> bytes_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const std::byte*>(data), size};
}

/// Small enough that no input may take more than some hundred megabytes.
inline ReadOptions small_limits() {
  ReadOptions options;
  options.max_file_bytes = std::int64_t{1} << 24;
  options.max_elements = std::int64_t{1} << 20;
  options.max_total_bytes = std::int64_t{1} << 28;
  return options;
}

/// Runs `call`; errors are an answer, except those that say that the library is wrong.
template <class Call>
void expect_answer(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::internal) std::abort();
  }
}

/// What every model that was read must stand: its invariants and being written.
inline void use(const Model& model) {
  for (const Mesh& mesh : model.meshes) check(mesh.surface);
  Context context;
  write_obj(model, "out", context);
  write_ply(model, "out", context);
}

}  // namespace fovea::fuzz
