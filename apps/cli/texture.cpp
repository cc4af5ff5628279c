#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include "field_source.h"
#include "fovea/budget/picture_loss.h"
#include "fovea/io/extension.h"
#include "fovea/io/file_form.h"
#include "fovea/io/image_file.h"
#include "fovea/io/write.h"
#include "fovea/render/scene.h"
#include "fovea/render/texel_density.h"
#include "fovea/render/view.h"
#include "fovea/saliency/model_saliency.h"
#include "fovea/simplify/salient.h"
#include "fovea/texture/shrink.h"
#include "input.h"
#include "report.h"
#include "saliency_source.h"
#include "shared_options.h"
#include "shrink_text.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

/// Pixels along the pictures in which texels are counted.
constexpr int kDensitySize = 256;

class TextureVerb : public Verb {
 public:
  VerbText text() const override {
    return {
        "texture",
        "make the textures of a model smaller",
        "Reads a model and makes its images smaller, in texels and in bytes, each as its materials use it: "
        "colours are mixed as light, normals keep their length, alpha masks their coverage, and seams of "
        "repeating textures close. No image's file grows; what cannot be made smaller stays as it was, with "
        "a "
        "word why. The shape is not touched. Exit code 8 says that all images together take more than "
        "--texture-bytes; the output is written all the same, but not if it takes more than --bytes.",
        {{"fovea texture helmet.glb -o helmet-web.glb --max-texture 1024 --texture-format webp",
          "No side above 1,024 texels, as WebP."},
         {"fovea texture chair.glb -o chair-half.glb --texture-scale 0.5",
          "Half the texels along each side."},
         {"fovea texture chair.glb -o chair-512.glb --texture-size 512",
          "Each image as large as it takes where the model is 512 pixels high."},
         {"fovea texture helmet.glb -o helmet-300k.glb --texture-bytes 300000 --texture-format webp",
          "All images in 300 kB, as WebP, each as large as it is worth."},
         {"fovea texture room.gltf -o room-jpeg.gltf --texture-format jpeg --texture-psnr 36",
          "JPEG, as small as 36 dB allow."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add(model_argument(input_));
    arguments.add("Textures", describe(options_));
    arguments.add(
        "Textures",
        {{"texture-size",
          "The height in pixels at which the model will be shown: each image is halved while it has a texel "
          "for each pixel that shows it, as seen from the views; --texture-bytes looks at such pictures.",
          &shown_height_, "pixels", 1, 1 << 16},
         describe_bytes(
             "Bytes of the whole .glb or .gltf at most, such as 500KB: --texture-bytes of what is left "
             "beside the geometry.",
             bytes_),
         {"allow-miss", "Exit with 0 even if --texture-bytes or --bytes are not kept to.", &allow_miss_,
          ""}});
    arguments.add("Views", describe(views_));
    arguments.add("Warp", describe(options_.warp));
    arguments.add(
        "Warp",
        {{"saliency",
          "Give texels to where people look, by a preset of \"fovea saliency\"; yang by default with --warp "
          "saliency.",
          choice(saliency_, saliency_sources(false)), ""},
         describe_field("importance", "How much each vertex is looked at (0 is not at all)", importance_),
         {"maps",
          "Also write what steered the warp as grey pictures: MAPS-saliency.png, -distortion, -coverage, "
          "-detail and -importance, with the number of an image if there are several atlases.",
          &maps_, "MAPS.png"}});
    arguments.add("Output", {describe_output(output_)});
    arguments.add("Output", describe(write_options_));
    arguments.add("Limits", describe(read_options_));
    need_format(arguments, write_options_);
    arguments.need({{"allow-miss"}, "--texture-bytes or --bytes", [&] {
                      return options_.max_bytes.has_value() || !bytes_.empty();
                    }});
    arguments.need({{"views", "view-count", "elevation", "fov", "margin"},
                    "--texture-size, --texture-bytes or --bytes",
                    [&] { return shown_height_ || options_.max_bytes || !bytes_.empty(); }});
    need_views(arguments, views_);
    arguments.need({{"warp-cells", "warp-rigidity", "warp-floor", "warp-rounds", "warp-tolerance", "saliency",
                     "importance", "maps"},
                    "a --warp other than none",
                    [&] { return options_.moves != TexelMoves::none; }});
  }

  int run(Session& session) override {
    check_request();
    const Input input = read_input(session, input_, read_options_);
    const Snapshot before = snapshot(input.model, input.bytes);
    session.report["inputs"] = inputs_json({&input, 1});
    session.report["before"] = to_json(before);
    const std::vector<VertexField> field =
        session.phase("saliency", input_, [&] { return looked_at(input, session); });
    const std::vector<TexelDensity> densities =
        session.phase("views", input_, [&] { return texels_seen(input.model, session.context); });
    if (shown_height_) options_.shown_pixels = static_cast<double>(*shown_height_);
    if (!densities.empty()) options_.scales = needed_scales(densities, static_cast<double>(*shown_height_));
    const Shrunk result = session.phase("textures", input_, [&] {
      if (budget_ || options_.max_bytes)
        options_.lost = loss_by_pictures(input.model, views_, options_.shown_pixels, session.context);
      return budget_ ? shrink_textures_within(input.model, *budget_, file_form(output_, write_options_),
                                              options_, field, session.context)
                     : shrink_textures(input.model, options_, field, session.context);
    });
    if (budget_ && !allow_miss_) {
      const std::uint64_t taken = bytes_of(result.model);
      if (taken > *budget_)
        return too_many_bytes(session, *budget_, taken, "\"fovea fit\" takes triangles off, too");
    }
    const std::vector<MapFile> maps = maps_.empty() ? std::vector<MapFile>{} : map_files(result.atlases);
    for (const MapFile& map : maps) check_image_output(map.path, write_options_.force);
    const auto files = session.phase(
        "write", [&] { return write_model(result.model, output_, write_options_, session.context); });
    for (const MapFile& map : maps) write_image(map.picture, map.path, write_options_.force);
    return tell(session, before, snapshot(result.model, measure_output(files, result.model)), result,
                densities);
  }

 private:
  std::uint64_t bytes_of(const Model& model) const {
    Context quiet;
    return written_bytes(model, file_form(output_, write_options_), quiet).total();
  }

  /// None if nobody asks.
  std::vector<TexelDensity> texels_seen(const Model& model, Context& context) const {
    if (!shown_height_) return {};
    const Pose pose = rest_pose(model);
    const RenderScene scene = make_render_scene(model, pose, context, nullptr, SceneTextures::none);
    return texel_densities(model, scene, views_of(views_, model, pose, scene.sphere), kDensitySize, context);
  }

  struct MapFile {
    std::string path;
    Image8 picture;
  };

  /// 255 stands for the greatest.
  static Image8 grey(const ImageF& map) {
    Image8 result(map.width, map.height, 1, ColorEncoding::linear);
    float greatest = 0;
    for (const float x : map.pixels) greatest = std::max(greatest, x);
    for (std::size_t i = 0; greatest > 0 && i < map.pixels.size(); ++i)
      result.pixels[i] = static_cast<std::uint8_t>(std::lround(255 * map.pixels[i] / greatest));
    return result;
  }

  std::vector<MapFile> map_files(const std::vector<AtlasChange>& atlases) const {
    const std::filesystem::path path(maps_);
    std::vector<MapFile> files;
    for (const AtlasChange& atlas : atlases) {
      if (atlas.importance.pixels.empty()) continue;
      const std::string number = atlases.size() > 1 ? fmt::format("-image{}", atlas.images.front()) : "";
      const auto add = [&](const char* name, const ImageF& map) {
        const std::string file = path.stem().string() + "-" + name + number + path.extension().string();
        files.push_back({(path.parent_path() / file).string(), grey(map)});
      };
      add("saliency", atlas.maps.saliency);
      add("distortion", atlas.maps.distortion);
      add("coverage", atlas.maps.coverage);
      add("detail", atlas.maps.detail);
      add("importance", atlas.importance);
    }
    if (files.empty())
      throw Error(ErrorKind::unsupported, "there is no map: no texels could have moved", maps_,
                  "the lines about texels without --maps say why");
    return files;
  }

  /// How much each vertex is looked at, 0 … 1; nothing for alike.
  std::vector<VertexField> looked_at(const Input& input, Session& session) const {
    std::vector<VertexField> field;
    if (!importance_.empty()) {
      NamedFields found = load_fields(importance_, input, read_options_);
      about(found.path, [&] { check(found.fields); });
      field = std::move(found.fields);
    }
    SaliencySource source = saliency_;
    if (source == SaliencySource::none && options_.moves == TexelMoves::saliency)
      source = SaliencySource::yang;
    if (const auto preset = preset_of(source)) {
      SaliencyOptions options;
      options.preset = *preset;
      field = product(field, model_saliency(input.model, options, session.context).saliency);
    }
    float greatest = 0;
    for (const VertexField& mesh : field)
      for (const float x : mesh.values()) greatest = std::isfinite(x) ? std::max(greatest, x) : greatest;
    for (VertexField& mesh : field)
      for (float& x : mesh.values()) x = greatest > 0 ? std::min(x / greatest, 1.0f) : 1.0f;
    return field;
  }

  void check_request() {
    if (options_.scale == 1 && options_.max_side == 0 && !options_.max_bytes && !shown_height_ &&
        bytes_.empty() && options_.output.format == TextureOutput::keep) {
      throw Error(ErrorKind::usage, "nothing is asked for", {},
                  "give --texture-size, --texture-bytes, --bytes, --texture-scale, --max-texture or "
                  "--texture-format, "
                  "for example --max-texture 1024");
    }
    check_input(input_);
    check_output(output_, "small.glb", {input_}, write_options_.force, [&](const auto& path) {
      if (!bytes_.empty()) check_extension(path, "models of so many bytes", {".glb", ".gltf"});
      fovea::check_output(path, write_options_);
    });
    if (!bytes_.empty()) budget_ = parse_bytes("--bytes", bytes_);
    if (budget_ && options_.max_bytes)
      throw Error(ErrorKind::usage, "--texture-bytes and --bytes are both given", {}, "give one of them");
    if (!maps_.empty()) check_image_output(maps_, true);
  }

  bool reached(const Shrunk& result) const {
    if (budget_) return bytes_of(result.model) <= *budget_;
    return !options_.max_bytes || result.bytes <= static_cast<std::uint64_t>(*options_.max_bytes);
  }

  /// Texels to a pixel at the height asked for, before anything changes; none if no pixel shows the image.
  std::optional<double> texels_per_pixel(const std::vector<TexelDensity>& densities,
                                         std::size_t image) const {
    if (densities.empty() || densities[image].pixels() == 0) return std::nullopt;
    return densities[image].quantile(kCoarsePixels) / static_cast<double>(*shown_height_);
  }

  int tell(Session& session, const Snapshot& before, const Snapshot& after, const Shrunk& result,
           const std::vector<TexelDensity>& densities) const {
    session.report["outputs"] = Json::array({file_json(output_, after.bytes)});
    session.report["after"] = to_json(after);
    std::vector<std::optional<double>> per_pixel;
    for (std::size_t i = 0; i < densities.size(); ++i) per_pixel.push_back(texels_per_pixel(densities, i));
    session.print_summary(fmt::format("{} -> {}\n{}{}time     {}\n", printable(input_), printable(output_),
                                      comparison_text(before, after),
                                      tell_shrunk(session, result, false, per_pixel), session.spent_text()));
    session.report["reached"] = reached(result);
    return target_code(session, reached(result), allow_miss_);
  }

  std::string input_;
  std::string output_;
  std::string importance_;
  std::string maps_;
  SaliencySource saliency_ = SaliencySource::none;
  std::optional<std::int64_t> shown_height_;
  bool allow_miss_ = false;
  std::string bytes_;
  std::optional<std::uint64_t> budget_;
  ViewOptions views_;
  ShrinkOptions options_;
  ReadOptions read_options_;
  WriteOptions write_options_;
};

}  // namespace

std::unique_ptr<Verb> make_texture() { return std::make_unique<TextureVerb>(); }

}  // namespace fovea::cli
