#include "map_output.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "fovea/base/text.h"
#include "fovea/io/write.h"
#include "fovea/surface/correspondence.h"
#include "input.h"
#include "report.h"

namespace fovea::cli {

namespace {

bool has_extension(const std::filesystem::path& path, std::initializer_list<const char*> extensions) {
  return std::find(extensions.begin(), extensions.end(), lower_extension(path)) != extensions.end();
}

}  // namespace

bool is_picture_name(const std::filesystem::path& path) {
  return has_extension(path, {".png", ".jpg", ".jpeg", ".webp"});
}

bool is_field_name(const std::filesystem::path& path) {
  return has_extension(path, {".npy", ".csv", ".txt"});
}

void check_attribute_output(const std::filesystem::path& path, bool force) {
  if (lower_extension(path) == ".obj") {
    throw Error(ErrorKind::usage, "OBJ files have no place for vertex attributes", path.string(),
                "name the output .glb, .gltf or .ply");
  }
  fovea::check_output(path, force);
}

std::vector<Model> read_poses(Session& session, const Model& first, std::span<const std::string> paths,
                              const ReadOptions& options) {
  std::vector<Model> poses;
  for (const std::string& path : paths) {
    Input pose = read_input(session, path, options);
    session.report["inputs"].push_back(file_json(pose.path, pose.bytes));
    about(pose.path, [&] { surfaces_in(first, pose.model); });
    poses.push_back(std::move(pose.model));
  }
  return poses;
}

}  // namespace fovea::cli
