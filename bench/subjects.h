#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fovea/model/model.h"

namespace fovea::bench {

/// A model to measure with, made when it is needed.
struct Subject {
  std::string name;
  std::function<Model()> make;
};

/// The folder of models that FOVEA_DATA names, if it is set.
std::optional<std::filesystem::path> data_folder();

/// Scans and textured models of the data folder, or Fovea's own samples without one.
std::vector<Subject> speed_subjects();

/// Those of `speed_subjects` and a guitar of 56,000 triangles with a texture of 3276².
std::vector<Subject> saliency_subjects();

/// Scans of the data folder, or Fovea's own samples without one.
std::vector<Subject> scan_subjects();

/// What is drawn: textured models and a scan of the data folder, or Fovea's own samples.
std::vector<Subject> render_subjects();

/// Textured models of many kinds of the data folder, or Fovea's own samples.
std::vector<Subject> textured_subjects();

/// Those of `textured_subjects` and the sample vase.
std::vector<Subject> texture_subjects();

/// A closed, bumpy sphere of about `triangles` triangles (position only) for runs of any size.
Subject noise_sphere(std::size_t triangles);

/// Drops all attribute layers.
void keep_positions_only(Model& model);

/// Gives meshes without any attribute a normal per vertex, so that there is something to carry.
void add_missing_normals(Model& model);

/// Triangles over all meshes.
std::size_t triangle_count(const Model& model);

}  // namespace fovea::bench
