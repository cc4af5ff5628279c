#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <utility>

#include "fovea/base/text.h"
#include "fovea/cluster/cluster_colors.h"
#include "fovea/cluster/cluster_properties.h"
#include "fovea/cluster/clusters.h"
#include "fovea/io/extension.h"
#include "fovea/io/field_file.h"
#include "fovea/io/image_file.h"
#include "fovea/io/write.h"
#include "fovea/render/face_map.h"
#include "fovea/saliency/model_saliency.h"
#include "fovea/surface/scene_surface.h"
#include "input.h"
#include "map_output.h"
#include "report.h"
#include "shared_options.h"
#include "sheet.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

/// What is written. The first leaves it to the extension of the output.
enum class SegmentOutput { by_extension, colors, attribute, ids, properties, local, picture };

constexpr const char* kAttribute = "_CLUSTER";

/// The clusters of a model, with what they were made from.
struct Segments {
  SceneSurface scene;
  VertexField saliency;
  Clusters clusters;
  std::vector<ClusterProperties> properties;
};

void check_properties_output(const std::filesystem::path& path, bool force) {
  check_extension(path, "properties", {".json"});
  check_place(path, force);
}

Json vector_json(Vec3d v) { return {number_json(v.x), number_json(v.y), number_json(v.z)}; }

Json to_json(const ClusterProperties& p) {
  return {{"triangles", p.triangles},
          {"vertices", p.vertices},
          {"total_saliency", number_json(p.total_saliency)},
          {"mean_saliency", number_json(p.mean_saliency)},
          {"peak_saliency", number_json(p.peak_saliency)},
          {"base_saliency", number_json(p.base_saliency)},
          {"area", number_json(p.area)},
          {"mean_normal", vector_json(p.mean_normal)},
          {"peak_deviation_rad", number_json(p.peak_deviation)},
          {"center", vector_json(p.sphere.center)},
          {"radius", number_json(p.sphere.radius)}};
}

Json to_json(const std::vector<ClusterProperties>& properties) {
  Json json = Json::array();
  for (const ClusterProperties& p : properties) json.push_back(to_json(p));
  return json;
}

/// The cluster of each triangle of each mesh; none in meshes that nothing shows.
std::vector<FaceNumbers> per_mesh(const Model& model, const SceneSurface& scene, const Clusters& clusters) {
  std::vector<FaceNumbers> numbers;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    numbers.emplace_back(model.meshes[m].surface.face_count(), kInvalid);
    const std::size_t first = scene.first_triangle[m], end = scene.first_triangle[m + 1];
    for (std::size_t f = first; f < end; ++f) numbers.back()[FaceId{f - first}] = clusters.of_face[FaceId{f}];
  }
  return numbers;
}

std::vector<float> ids_of(const std::vector<FaceNumbers>& numbers) {
  std::vector<float> ids;
  for (const FaceNumbers& mesh : numbers) {
    for (const std::uint32_t number : mesh.values())
      ids.push_back(number == kInvalid ? -1.0f : static_cast<float>(number));
  }
  return ids;
}

class Segment : public Verb {
 public:
  VerbText text() const override {
    return {
        "segment",
        "divide a model into connected clusters around what stands out",
        "Divides the triangles of a model into connected clusters that grow from where people look, over "
        "what is alike in saliency and direction, and says of each what it holds. Several files are poses "
        "of one model.",
        {{"fovea segment armadillo.ply -o clusters.glb --clusters 45", "Clusters in colours for any viewer."},
         {"fovea segment armadillo.ply -o clusters.png --clusters 45", "A sheet of pictures of them."},
         {"fovea segment armadillo.ply -o ids.npy", "One number per triangle of the file."},
         {"fovea segment armadillo.ply -o clusters.json", "Area, saliency, mean normal, ... of each."},
         {"fovea segment helmet.glb -o marked.glb --as attribute",
          "The model as it is, with the vertex attribute _CLUSTER."},
         {"fovea segment dragon.ply -o local.npy --as local",
          "Saliency as it counts within clusters, for simplify --importance."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add({"MODEL", "A model file; further files are other poses of it.", nullptr, true, &inputs_});
    arguments.add("Clusters", describe(options_));
    arguments.add(
        "Output",
        {describe_output(output_),
         {"as",
          "What to write: clusters in colours (a model), the model with a vertex attribute, a number per "
          "triangle, properties of each cluster, saliency within clusters as a number per vertex, or "
          "pictures. By itself as the extension says: .png, .jpg and .webp are pictures; .npy, .csv and "
          ".txt numbers of triangles; .json properties; others colours.",
          choice(kind_, {"extension", "colors", "attribute", "ids", "properties", "local", "picture"}), ""},
         describe_force(force_)});
    arguments.add("Saliency", describe(saliency_options_));
    add_sheet(arguments, sheet_, [&] { return output_.empty() || kind() == SegmentOutput::picture; });
    arguments.add("Limits", describe(read_options_));
    arguments.need({{"key-poses"},
                    "all of the animations",
                    [&] { return !saliency_options_.pose.animation; },
                    "leave out --animation, or --key-poses"});
  }

  int run(Session& session) override {
    check_request();
    if (saliency_options_.pose.animation) {
      saliency_options_.key_poses = 1;  // that of the animation
      session.report["options"]["key-poses"] = 1;
    }
    const Input first = read_first(session);
    const Model& model = first.model;
    const std::vector<Model> poses = read_poses(session, model, std::span(inputs_).subspan(1), read_options_);
    const Segments segments = divide(first, poses, session);
    session.report["outputs"] = Json::array();
    session.phase("write", first.path, [&] { write(model, segments, session); });
    tell(session, segments.clusters, segments.properties);
    return 0;
  }

 private:
  void check_request() {
    for (const std::string& input : inputs_) check_input(input);
    kind_ = kind();
    check_output(output_, "clusters.glb", inputs_, force_,
                 [&](const auto& path) { output_check()(path, force_); });
  }

  SegmentOutput kind() const {
    if (kind_ != SegmentOutput::by_extension) return kind_;
    if (is_picture_name(output_)) return SegmentOutput::picture;
    if (lower_extension(output_) == ".json") return SegmentOutput::properties;
    return is_field_name(output_) ? SegmentOutput::ids : SegmentOutput::colors;
  }

  void (*output_check() const)(const std::filesystem::path&, bool) {
    switch (kind_) {
      case SegmentOutput::ids:
      case SegmentOutput::local: return check_field_output;
      case SegmentOutput::properties: return check_properties_output;
      case SegmentOutput::picture: return check_image_output;
      default: return check_attribute_output;
    }
  }

  Input read_first(Session& session) const {
    Input first = read_input(session, inputs_[0], read_options_);
    session.report["inputs"] = inputs_json({&first, 1});
    need_triangles(first);
    return first;
  }

  Segments divide(const Input& input, const std::vector<Model>& poses, Session& session) const {
    const ModelSaliency found = session.phase("saliency", input.path, [&] {
      return model_saliency(input.model, saliency_options_, session.context, poses);
    });
    session.report["poses"] = found.poses;
    Segments result;
    result.scene = scene_surface(input.model, pose_of(input.model, saliency_options_.pose));
    result.saliency = joined(found.saliency);
    result.clusters = session.phase("cluster", input.path, [&] {
      return make_clusters(result.scene, result.saliency, options_, session.context);
    });
    result.properties = session.phase(
        "properties", [&] { return cluster_properties(result.scene, result.saliency, result.clusters); });
    return result;
  }

  void write(const Model& model, const Segments& segments, Session& session) const {
    const auto& [scene, saliency, clusters, properties] = segments;
    const std::vector<FaceNumbers> numbers = per_mesh(model, scene, clusters);
    switch (kind_) {
      case SegmentOutput::ids: write_field(output_, ids_of(numbers), "cluster", force_); break;
      case SegmentOutput::local: {
        const std::vector<VertexField> local = split(scene, local_saliency(scene, saliency, clusters));
        write_field(output_, field_in_source_order(model, local), "local-saliency", force_);
        break;
      }
      case SegmentOutput::properties:
        write_text(output_, dump({{"clusters", to_json(properties)}}) + "\n", force_);
        break;
      case SegmentOutput::picture:
        write_image(draw_sheet(face_map(model, numbers, cluster_colors(scene, clusters)),
                               saliency_options_.pose, sheet_, {}, session.context, {}),
                    output_, force_);
        break;
      case SegmentOutput::attribute: return write(with_face_attribute(model, numbers, kAttribute), session);
      default: {
        const Model colored = face_map(model, numbers, cluster_colors(scene, clusters));
        return write(with_face_attribute(colored, numbers, kAttribute), session);
      }
    }
    session.report["outputs"].push_back(file_json(output_));
  }

  void write(const Model& made, Session& session) const {
    WriteOptions options;
    options.force = force_;
    const auto files = write_model(made, output_, options, session.context);
    session.report["outputs"].push_back(file_json(output_, measure_output(files, made)));
  }

  void tell(Session& session, const Clusters& clusters,
            const std::vector<ClusterProperties>& properties) const {
    session.report["rounds"] = clusters.rounds;
    session.report["end"] = to_string(clusters.end);
    session.report["clusters"] = to_json(properties);
    TextTable table("lrrr");
    table.row({"of each cluster", "least", "median", "most"});
    const auto row = [&](const char* name, const auto& value_of) {
      std::vector<double> values;
      for (const ClusterProperties& p : properties) values.push_back(static_cast<double>(value_of(p)));
      std::sort(values.begin(), values.end());
      table.row({name, number_text(values.front()), number_text(values[values.size() / 2]),
                 number_text(values.back())});
    };
    row("triangles", [](const ClusterProperties& p) { return p.triangles; });
    row("area", [](const ClusterProperties& p) { return p.area; });
    row("mean saliency", [](const ClusterProperties& p) { return p.mean_saliency; });
    session.print_summary(fmt::format("{} -> {}\n{}, {} ({})\n{}{}\n", printable(inputs_[0]),
                                      printable(output_), plural(properties.size(), "cluster", "clusters"),
                                      plural(clusters.rounds, "round", "rounds"), to_string(clusters.end),
                                      table.text(0), session.spent_text()));
  }

  static SaliencyOptions over_poses() {
    SaliencyOptions options;
    options.key_poses = 8;
    return options;
  }

  std::vector<std::string> inputs_;
  std::string output_;
  SegmentOutput kind_ = SegmentOutput::by_extension;
  bool force_ = false;
  SheetOptions sheet_;
  ClusterOptions options_;
  SaliencyOptions saliency_options_ = over_poses();
  ReadOptions read_options_;
};

}  // namespace

std::unique_ptr<Verb> make_segment() { return std::make_unique<Segment>(); }

}  // namespace fovea::cli
