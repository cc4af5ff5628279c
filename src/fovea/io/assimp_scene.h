#pragma once

#include <assimp/scene.h>

#include <string>

#include "fovea/io/side_files.h"

namespace fovea {

/// Makes a model of what the import library read. The scene is triangulated and validated.
Model convert_scene(const aiScene& scene, const std::filesystem::path& folder, const std::string& place,
                    const ReadOptions& options, Context& context);

/// Its parts: materials with their textures (into `model`), and node animations. `node_of_name`
/// gives the model's node of a name.
void convert_materials(const aiScene& scene, Model& model, TextureLoader& textures, const std::string& place,
                       Context& context);
void convert_animations(const aiScene& scene, Model& model, const std::map<std::string, int>& node_of_name,
                        const std::string& place, Context& context);

}  // namespace fovea
