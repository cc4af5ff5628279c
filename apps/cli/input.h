#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "fovea/io/file_bytes.h"
#include "fovea/io/read.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/model/model.h"
#include "session.h"

namespace fovea::cli {

/// A model with the file that it was read from.
struct Input {
  std::string path;
  Model model;
  FileBytes bytes;
  std::optional<MultiTessellation> levels;  ///< If the file has levels of it.
};

/// Reads a model as the phase "read": of a file with levels the finest; one without triangles is told as a
/// note.
Input read_input(Session& session, const std::string& path, const ReadOptions& options);

/// Error(unsupported) if the model shows no triangles: for verbs that have nothing to do then.
void need_triangles(const Input& input);

/// "inputs" of the report.
Json inputs_json(std::span<const Input> inputs);

}  // namespace fovea::cli
