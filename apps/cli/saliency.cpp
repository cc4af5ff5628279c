#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <span>

#include "fovea/io/field_file.h"
#include "fovea/io/image_file.h"
#include "fovea/io/write.h"
#include "fovea/render/heat_map.h"
#include "fovea/render/render.h"
#include "fovea/saliency/model_saliency.h"
#include "fovea/saliency/texture_space.h"
#include "fovea/surface/curvature.h"
#include "fovea/surface/scene_surface.h"
#include "fovea/surface/statistics.h"
#include "input.h"
#include "map_output.h"
#include "report.h"
#include "shared_options.h"
#include "sheet.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

/// What is written of a map. The first leaves it to the extension of the output.
enum class OutputKind { by_extension, heat, attribute, field, picture, texture };

constexpr const char* kWhole = "saliency";
constexpr const char* kAll = "all";

class Saliency : public Verb {
 public:
  VerbText text() const override {
    return {
        "saliency",
        "say where people look",
        "Finds how much each part of a model draws the eye, from its shape, its texture and how it stands "
        "before people, and writes that as a heat map, pictures, numbers or a vertex attribute. Several "
        "files are poses of one model.",
        {{"fovea saliency helmet.glb -o heat.glb", "A heat map for any glTF viewer."},
         {"fovea saliency helmet.glb -o heat.png", "A sheet of pictures of it."},
         {"fovea saliency scan.ply -o scan.npy --preset lee", "One number per vertex of the file."},
         {"fovea saliency helmet.glb -o maps.png --map all",
          "All that it was made of: maps-geometry.png, ..."},
         {"fovea saliency fox.glb -o fox-heat.glb --key-poses 8", "Over the poses of its animations."},
         {"fovea saliency helmet.glb -o marked.glb --as attribute",
          "The model with the vertex attribute _SALIENCY."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add({"MODEL", "A model file; further files are other poses of it.", nullptr, true, &inputs_});
    arguments.add("Saliency", describe(options_));
    arguments.add(
        "Output",
        {describe_output(output_),
         {"as",
          "What to write: a heat map (a model), the model with a vertex attribute, a field of numbers, "
          "pictures, "
          "or a map in the space of its texture. By itself as the extension says: .png, .jpg and .webp are "
          "pictures; .npy, .csv and .txt fields; others heat maps.",
          choice(kind_, {"extension", "heat", "attribute", "field", "picture", "texture"}), ""},
         {"map",
          "Which map to write: saliency, or one that it is made of, or \"all\" for a file of each. --json "
          "lists them.",
          &map_, "name"},
         describe_force(force_)});
    add_sheet(arguments, sheet_, [&] { return output_.empty() || kind() == OutputKind::picture; });
    arguments.add("Limits", describe(read_options_));
  }

  int run(Session& session) override {
    check_request();
    const Input first = read_first(session);
    const Model& model = first.model;
    const std::vector<Model> poses = read_poses(session, model, std::span(inputs_).subspan(1), read_options_);
    if (kind_ == OutputKind::texture)
      images_ = about(first.path, [&] { return texture_space_images(model); });
    check_outputs(kWhole);
    ModelSaliency found = session.phase(
        "saliency", first.path, [&] { return model_saliency(model, options_, session.context, poses); });
    found.maps.push_back({kWhole, found.saliency});
    const Json statistics =
        session.phase("statistics", first.path, [&] { return statistics_json(model, found, session); });
    const std::vector<const SaliencyMap*> maps = chosen(found);
    for (const SaliencyMap* map : maps) check_outputs(map->name);
    session.report["outputs"] = Json::array();
    session.phase("write", first.path, [&] {
      for (const SaliencyMap* map : maps) write(model, *map, session);
    });
    tell(session, found, statistics);
    return 0;
  }

 private:
  void check_request() {
    for (const std::string& input : inputs_) check_input(input);
    kind_ = kind();
    // Of several textures each gets a name of its own.
    check_place_of(output_, force_ || kind_ == OutputKind::texture);
  }

  void check_place_of(const std::string& output, bool force) const {
    check_output(output, "heat.glb", inputs_, force, [&](const auto& path) { output_check()(path, force); });
  }

  /// Before anything is written: what stands in the way of any file of a map.
  void check_outputs(const std::string& map) const {
    for (const std::string& path : paths_of(map)) check_place_of(path, force_);
  }

  OutputKind kind() const {
    if (kind_ != OutputKind::by_extension) return kind_;
    if (is_picture_name(output_)) return OutputKind::picture;
    return is_field_name(output_) ? OutputKind::field : OutputKind::heat;
  }

  void (*output_check() const)(const std::filesystem::path&, bool) {
    switch (kind_) {
      case OutputKind::field: return check_field_output;
      case OutputKind::attribute: return check_attribute_output;
      case OutputKind::picture:
      case OutputKind::texture: return check_image_output;
      default: return fovea::check_output;
    }
  }

  Input read_first(Session& session) const {
    Input first = read_input(session, inputs_[0], read_options_);
    session.report["inputs"] = inputs_json({&first, 1});
    need_triangles(first);
    return first;
  }

  std::vector<const SaliencyMap*> chosen(const ModelSaliency& found) const {
    std::vector<const SaliencyMap*> maps;
    std::vector<std::string> names;
    for (const SaliencyMap& map : found.maps) {
      names.push_back(map.name);
      if (map_ == kAll || map_ == map.name) maps.push_back(&map);
    }
    if (maps.empty()) {
      const std::vector<std::string> near = nearest_names(map_, names);
      throw Error(ErrorKind::usage, fmt::format("there is no map \"{}\"", printable(map_)), "--map",
                  fmt::format("{}there are: {}, {}",
                              near.empty() ? "" : fmt::format("did you mean {}? ", near.front()), kAll,
                              fmt::join(names, ", ")));
    }
    return maps;
  }

  /// The files of a map: "out.png"; "out-geometry.png" beside it with --map all; "out-image2.png" of each of
  /// several textures.
  std::vector<std::string> paths_of(const std::string& map) const {
    const std::filesystem::path path(output_);
    const auto with = [&](const std::string& suffix) {
      return (path.parent_path() / (path.stem().string() + suffix + path.extension().string())).string();
    };
    const std::string suffix = map_ == kAll && map != kWhole ? "-" + map : "";
    if (images_.size() < 2) return {suffix.empty() ? output_ : with(suffix)};
    std::vector<std::string> paths;
    for (const int image : images_) paths.push_back(with(fmt::format("{}-image{}", suffix, image)));
    return paths;
  }

  void write(const Model& model, const SaliencyMap& map, Session& session) const {
    const std::vector<std::string> paths = paths_of(map.name);
    switch (kind_) {
      case OutputKind::field:
        write_field(paths[0], field_in_source_order(model, map.fields), map.name, force_);
        break;
      case OutputKind::picture: write_image(picture(model, map, session.context), paths[0], force_); break;
      case OutputKind::texture:
        for (std::size_t i = 0; i < images_.size(); ++i) {
          write_image(texture_space_map(model, scaled(map.fields), images_[i], session.context), paths[i],
                      force_);
        }
        break;
      case OutputKind::attribute:
        return write(with_attribute(model, map.fields, attribute_name(map.name)), paths[0], map, session);
      default: return write(heat_map(model, scaled(map.fields)), paths[0], map, session);
    }
    for (const std::string& path : paths) report_output(file_json(path), map, session);
  }

  void write(const Model& made, const std::string& path, const SaliencyMap& map, Session& session) const {
    WriteOptions options;
    options.force = force_;
    const auto files = write_model(made, path, options, session.context);
    report_output(file_json(path, measure_output(files, made)), map, session);
  }

  static void report_output(Json output, const SaliencyMap& map, Session& session) {
    output["map"] = map.name;
    session.report["outputs"].push_back(std::move(output));
  }

  /// "_SALIENCY", "_CURVATURE_CONTRAST_1".
  static std::string attribute_name(const std::string& map) {
    std::string name = "_" + map;
    for (char& c : name) c = c == '-' ? '_' : static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    return name;
  }

  /// To [0, 1] over all meshes.
  static std::vector<VertexField> scaled(std::vector<VertexField> fields) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (const VertexField& field : fields) {
      for (const float x : field.values()) {
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
    for (VertexField& field : fields) {
      for (float& x : field.values()) x = high > low ? (x - low) / (high - low) : 0.0f;
    }
    return fields;
  }

  Image8 picture(const Model& model, const SaliencyMap& map, Context& context) const {
    RenderOptions options;
    options.pass = Pass::field;
    const std::vector<VertexField> fields = scaled(map.fields);
    // A heat map has no textures to decode.
    return draw_sheet(heat_map(model, fields), options_.pose, sheet_, options, context, fields);
  }

  Json statistics_json(const Model& model, const ModelSaliency& found, Session& session) const {
    SceneSurface scene = scene_surface(model, pose_of(model, options_.pose));
    scale(scene.surface, unit_scale(scene.surface));  // areas are floats
    const VertexField areas =
        vertex_areas(scene.surface, Adjacency(scene.surface, session.context), session.context);
    Json json = Json::object();
    for (const SaliencyMap& map : found.maps) {
      const VertexField field = joined(map.fields);
      const Statistics s = statistics(field.values(), areas.values());
      json[map.name] = {{"min", number_json(s.least)},
                        {"max", number_json(s.greatest)},
                        {"mean", number_json(s.mean)},
                        {"deviation", number_json(s.deviation)},
                        {"quarter", number_json(s.quarter)},
                        {"median", number_json(s.median)},
                        {"three_quarters", number_json(s.three_quarters)}};
    }
    return json;
  }

  void tell(Session& session, const ModelSaliency& found, const Json& statistics) const {
    const Json written = session.report["outputs"];
    session.report["textured"] = found.textured;
    session.report["poses"] = found.poses;
    session.report["maps"] = statistics;
    TextTable table("lrrrr");
    table.row({"map", "mean", "deviation", "median", "range"});
    for (const auto& [name, s] : statistics.items()) {
      if (name.find("contrast") != std::string::npos && !session.verbose()) continue;
      table.row({name, number_text(s["mean"]), number_text(s["deviation"]), number_text(s["median"]),
                 number_text(s["min"]) + " … " + number_text(s["max"])});
    }
    session.print_summary(fmt::format("{} -> {}\n{}{}\n{}\n", printable(inputs_[0]),
                                      written.size() == 1 ? printable(written[0]["path"].get<std::string>())
                                                          : plural(written.size(), "file", "files"),
                                      table.text(0), plural(found.poses.size(), "pose", "poses"),
                                      session.spent_text()));
  }

  std::vector<std::string> inputs_;
  std::string output_;
  std::vector<int> images_;  ///< Whose space maps are drawn in, for OutputKind::texture.
  std::string map_ = kWhole;
  OutputKind kind_ = OutputKind::by_extension;
  bool force_ = false;
  SheetOptions sheet_;
  SaliencyOptions options_;
  ReadOptions read_options_;
};

}  // namespace

std::unique_ptr<Verb> make_saliency() { return std::make_unique<Saliency>(); }

}  // namespace fovea::cli
