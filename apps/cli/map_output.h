#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fovea/io/read.h"
#include "session.h"

namespace fovea::cli {

// What verbs share that say something of a surface: as pictures, numbers or attributes, over one or more
// poses.

/// Whether a file of that name is a picture: .png, .jpg, .jpeg or .webp.
bool is_picture_name(const std::filesystem::path& path);
/// Or a list of numbers: .npy, .csv or .txt.
bool is_field_name(const std::filesystem::path& path);

/// Throws what `check_output` throws, and Error(usage) for a format that has no attributes.
void check_attribute_output(const std::filesystem::path& path, bool force);

/// Reads further files of a model, and adds them to the report's inputs. Throws Error(unsupported) if one is
/// not the model in another pose.
std::vector<Model> read_poses(Session& session, const Model& first, std::span<const std::string> paths,
                              const ReadOptions& options);

}  // namespace fovea::cli
