#include "fovea/lod/lod_chain_files.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "fovea/base/error.h"
#include "fovea/base/text.h"
#include "fovea/io/gltf_write.h"
#include "fovea/texture/image_output.h"

namespace fovea {

namespace {

using Json = nlohmann::ordered_json;

/// Version of the JSON: goes up when a key changes its meaning or goes.
constexpr int kSchema = 1;

bool is_plain(const WriteOptions& options) {
  return !options.quantize && options.compression == GeometryCompression::none;
}

LodFile encoded(const LodLevel& level, const std::string& name, const WriteOptions& options,
                Context& context) {
  GltfOutput output = write_gltf(level.model, true, name, options, context);
  return {name, std::move(output.files.front().bytes), output.bytes};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(); }

Json scores_json(const ImageScores& scores) {
  return {{"flip", number(scores.flip)},
          {"flip_foreground", number(scores.flip_foreground)},
          {"psnr_db", number(scores.psnr)},
          {"psnr_foreground_db", number(scores.psnr_foreground)}};
}

Json textures_json(const Model& model) {
  Json list = Json::array();
  for (const EncodedImage& image : model.images) {
    const ImageChange::State state = state_of(image);
    list.push_back({{"name", image.name},
                    {"mime_type", state.mime_type},
                    {"width", state.width},
                    {"height", state.height},
                    {"bytes", state.bytes}});
  }
  return list;
}

Json error_json(const LodLevel& level, double diagonal) {
  return {{"max_abs", level.error.max},
          {"mean_abs", level.error.mean},
          {"max_rel", level.error.max / diagonal},
          {"mean_rel", level.error.mean / diagonal},
          {"pixels", number(level.pixels)}};
}

Json level_json(const LodChain& chain, std::size_t i, const LodFile& file) {
  const LodLevel& level = chain.levels[i];
  const ModelCounts sizes = counts(level.model);
  Json json = {{"level", i},
               {"file", file.name},
               {"triangles", sizes.triangles},
               {"vertices", sizes.vertices},
               {"split_vertices", sizes.split_vertices},
               {"bytes",
                {{"file", file.glb.size()},
                 {"geometry", file.bytes.geometry},
                 {"images", file.bytes.images},
                 {"animation", file.bytes.animation},
                 {"other", file.bytes.other}}},
               {"switch_distance", level.distance},
               {"screen_coverage", i > 0 ? number(level.coverage) : Json()},
               {"screen_area", i > 0 ? number(area_of(level.coverage, chain.screen)) : Json()},
               {"error", error_json(level, chain.diagonal)},
               {"pictures", Json()},
               {"textures", textures_json(level.model)}};
  if (level.picture_size > 0) {
    json["pictures"] = {{"size", level.picture_size},
                        {"base_color", scores_json(level.pictures[0])},
                        {"lit", scores_json(level.pictures[1])}};
  }
  return json;
}

}  // namespace

std::string lod_name(const std::string& pattern, const std::string& name, std::size_t level) {
  if (pattern.find("{i}") == std::string::npos)
    throw Error(ErrorKind::usage, fmt::format("'{}' gives all levels one name", pattern), "--name",
                "put {i} where the level's number goes: {name}_LOD{i}");
  if (pattern.find('/') != std::string::npos)
    throw Error(ErrorKind::usage, fmt::format("'{}' names a folder", pattern), "--name",
                "name the folder with -o");
  // The name last: it may hold anything.
  const std::string numbered = replaced(pattern, "{i}", std::to_string(level));
  const std::string file = replaced(numbered, "{name}", name);
  return lower_extension(file) == ".glb" ? file : file + ".glb";
}

std::vector<LodFile> make_lod_files(LodChain& chain, const std::string& pattern, const std::string& name,
                                    const std::optional<LodFile>& original, const WriteOptions& options,
                                    Context& context) {
  std::vector<LodFile> files;
  for (std::size_t i = 0; i < chain.levels.size();) {
    const std::string file_name = lod_name(pattern, name, i);
    if (i == 0 && original && is_plain(options)) {
      files.push_back(*original);
      files.back().name = file_name;
    } else {
      files.push_back(encoded(chain.levels[i], file_name, options, context));
    }
    if (i > 0 && files[i].glb.size() >= files[i - 1].glb.size()) {
      context.report("lod-not-smaller",
                     "a level was left out: its file is no smaller than that of the one before it",
                     fmt::format("level of {} triangles", chain.levels[i].triangles));
      files.pop_back();
      chain.levels.erase(chain.levels.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  return files;
}

std::string lod_sidecar(const LodChain& chain, const std::vector<LodFile>& files, const std::string& source) {
  Json json = {{"schema_version", kSchema},
               {"source", source},
               {"screen",
                {{"fov_deg", chain.screen.fov_deg},
                 {"width", chain.screen.width},
                 {"height", chain.screen.height},
                 {"pixel_error", chain.screen.pixel_error}}},
               {"model",
                {{"center", {chain.sphere.center.x, chain.sphere.center.y, chain.sphere.center.z}},
                 {"radius", chain.sphere.radius},
                 {"diagonal", chain.diagonal}}},
               {"levels", Json::array()}};
  for (std::size_t i = 0; i < chain.levels.size(); ++i)
    json["levels"].push_back(level_json(chain, i, files.at(i)));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace fovea
