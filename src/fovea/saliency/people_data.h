#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/saliency/agreement.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// A model and where people looked on it, as files.
struct PeopleFiles {
  std::string name;  ///< Of the model's file, without folder and extension.
  std::filesystem::path model, map;
};

/// Models (.obj, .off, .ply, .stl, .glb, .gltf) in a folder and those inside it, each with the map (.npy,
/// .txt, .csv, .val) of the same name: the one beside it, else the one anywhere. Upper and lower case are the
/// same. Models without a map and maps without a model are left out. By name.
///
/// Throws Error(input) if there is no folder or no pair in it, Error(usage) if two maps fit a model or two
/// models a map.
std::vector<PeopleFiles> find_people_files(const std::filesystem::path& folder);

/// Where people looked on a model.
struct PeopleMap {
  enum class Over { vertices, faces };
  Over over = Over::vertices;
  std::vector<float> values;  ///< [#V] or [#F] of `scene_surface` at rest.
  std::size_t points = 0;     ///< Of a list of points, else 0 ...
  std::size_t strays = 0;     ///< ... and how many of these lie at no vertex.
};

/// Reads the map of `files` for the model that was read from them. The number of values says what they belong
/// to: vertices of the file, of the model (as `field_from_source_order`), or the file's triangles. Those of
/// an OBJ are known even if reading sorted them by material and dropped some that have no area; in other
/// formats the numbers have to be the same.
///
/// Or a list of points, text with eight numbers a line: x y z nx ny nz seconds binary. The seconds go to the
/// nearest vertex that is no farther than 10⁻⁵ of the diagonal, of several the largest; other vertices get 0.
///
/// Throws Error(format) if the sizes do not fit or no point is at a vertex, Error(unsupported) for triangles
/// whose order is not known, and what `read_field` throws. The place is the map's file.
PeopleMap read_people_map(const PeopleFiles& files, const Model& model);

/// Compares a prediction, [#V] of `surface` (that of the scene), with a map by vertices and their areas, or
/// by faces with the mean of their corners.
Agreement agreement(const VertexField& predicted, const PeopleMap& observed, const Surface& surface,
                    const Context& context);

}  // namespace fovea
