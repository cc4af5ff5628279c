// The experiment of Horbelt, Balmelli and Vetterli (2001) as Markdown, some minutes: one view of land, 60
// meshes and 32 textures of it from a tenth down to a thousandth, all pairs drawn, and what marginal analysis
// finds of them. terrain_bench [--points FILE] [--views FOLDER]
//   --points   all pairs as CSV, with which ways pass them
//   --views    the view of each land, whole, at its smallest and by three pairs of equal bytes, as PNG and
//   WebP
// Land is Fovea's own sample and, if FOVEA_DATA names a folder with terrain/, Puget Sound of it.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/budget/height_field.h"
#include "fovea/budget/marginal.h"
#include "fovea/budget/seen_detail.h"
#include "fovea/budget/wavelet.h"
#include "fovea/io/gltf_write.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/image_file.h"
#include "fovea/io/read.h"
#include "fovea/model/image_error.h"
#include "fovea/render/render.h"
#include "fovea/sample/sample.h"
#include "fovea/simplify/simplify.h"
#include "fovea/texture/shrink.h"
#include "fovea/texture/texture_ladder.h"
#include "measure.h"
#include "subjects.h"
#include "terrain_analysis.h"
#include "words.h"

namespace fovea::bench {
namespace {

constexpr int kMeshes = 60, kTextures = 32;
constexpr double kMost = 0.1, kLeast = 0.001;  // of the vertices and of the coefficients
constexpr int kSize = 512;
constexpr float kStep = 8;

/// Sizes of ladders in geometric progression, from the largest.
double share(int rung, int rungs) {
  return kMost * std::pow(kLeast / kMost, static_cast<double>(rung) / (rungs - 1));
}

/// Land to look at.
struct Land {
  std::string name;
  Model model;  ///< Without walls.
  HeightField field;
  View view;
};

std::uint64_t geometry_bytes(Model model, Context& context) {
  WriteOptions options;
  options.quantize = true;
  options.compression = GeometryCompression::meshopt;
  for (EncodedImage& image : model.images) image.bytes.clear();
  return write_gltf(model, true, "land", options, context).bytes.total();
}

/// Heights of the land's middle part seen from a low flight: about a tenth of it is in the picture.
View view_of(const HeightField& field) {
  Box box;
  for (const Vec3f p : field.points) box.add(transform_point(field.to_world, Vec3d(p)));
  const Vec3d size = box.high - box.low;
  const double side = std::max(size.x, size.z);
  const Vec3d middle = box.center();
  const auto at = [&](double x, double z, double above) {
    return Vec3d{middle.x + x * side, box.low.y + above * side, middle.z + z * side};
  };
  const double top = size.y / side;
  return view_from(at(0.05, 0.36, top + 0.20), at(0, 0.05, top / 3), 30);
}

Land land_of(std::string name, const Model& original) {
  HeightFieldSearch search = find_height_field(original);
  if (!search.field) throw Error(ErrorKind::unsupported, name + " is no height field: " + search.why_not);
  HeightField field = std::move(*search.field);
  // Pictures are of base colour alone: normals would take bytes for nothing.
  std::erase_if(field.layers, [](const AttributeLayer& layer) { return layer.semantic != Semantic::uv; });
  const QuadtreeLevels levels(field, HeightError::largest);
  Model model = with_level(original, field, levels.level(levels.split_count()));
  const View view = view_of(field);
  return {std::move(name), std::move(model), std::move(field), view};
}

/// The scene's image that land shows.
std::size_t image_of(const RenderScene& scene) {
  return static_cast<std::size_t>(scene.materials[0].base_color_texture->image);
}

class Experiment {
 public:
  Experiment(const Land& land, Context& context)
      : land_(land),
        context_(context),
        scene_(make_render_scene(land.model, rest_pose(land.model), context)) {
    options_.pass = Pass::base_color;
    options_.width = options_.height = kSize;
    picture_ = render(scene_, land.view, options_, context_).color;
    weights_ = height_weights(land.field, scene_, std::span(&land.view, 1), kSize, context);
    resolution_ = texel_resolution(scene_, image_of(scene_), std::span(&land.view, 1), kSize, context);
  }

  double seen_share() const {
    const auto seen = std::ranges::count_if(weights_, [](float w) { return w > 0; });
    return static_cast<double>(seen) / static_cast<double>(weights_.size());
  }
  const Image8& picture() const { return picture_; }

  /// Quadtree and wavelets, both for the view.
  Ladders paper_ladders() {
    Ladders ladders{"quadtree, wavelets", {}, {}};
    const QuadtreeLevels levels(land_.field, HeightError::squares, weights_);
    const auto triangles = static_cast<double>(levels.triangles_after(levels.split_count()));
    for (int i = 0; i < kMeshes; ++i)
      add_mesh(ladders, with_level(land_.model, land_.field,
                                   levels.level(levels.splits_to(
                                       static_cast<std::uint64_t>(share(i, kMeshes) * triangles)))));
    const Image8 image = decode_image(land_.model.images[0].bytes);
    const WaveletImage wavelets = wavelet_image(image, kStep);
    const auto total = static_cast<double>(wavelets.planes[0].size());
    const auto kept = [&](double octaves) {
      return static_cast<double>(pruned(wavelets, resolution_, octaves).kept) / total;
    };
    const auto octaves_for = [&](double part) {
      double low = -8, high = 16;
      for (int i = 0; i < 24; ++i) (kept((low + high) / 2) > part ? low : high) = (low + high) / 2;
      return high;
    };
    // A view may show less than a tenth of the image at all: then from where the first of it goes.
    const double first = octaves_for(std::min(kMost, 0.999 * kept(-8))), last = octaves_for(kLeast);
    note_ = fmt::format("d from 2^{:.2f} to 2^{:.2f} times that of the view, k = {:.1f}", first, last,
                        (kTextures - 1) / (last - first));
    for (int i = 0; i < kTextures; ++i) {
      const PrunedWavelets rung = pruned(wavelets, resolution_, first + (last - first) * i / (kTextures - 1));
      const std::vector<std::uint8_t> code = encode(rung.image);
      const Image8 shown = reconstructed(decode_wavelets(code));
      add_texture(ladders, shown, code.size(), static_cast<double>(rung.kept) / total);
    }
    return ladders;
  }

  /// Collapses and smaller images, as `fovea fit` has them, for no view.
  Ladders own_ladders() {
    Ladders ladders{"collapses, smaller images", {}, {}};
    SimplifyOptions simplify_options;
    simplify_options.ratio = kLeast;
    simplify_options.metric = Metric::quadric;
    const CollapseRecord record = simplify(land_.model, simplify_options, {}, context_).record;
    const auto triangles = static_cast<double>(record.triangles_before);
    for (int i = 0; i < kMeshes; ++i)
      add_mesh(ladders, replay(land_.model, record,
                               record.steps_to(static_cast<std::uint64_t>(share(i, kMeshes) * triangles))));
    TextureLadderOptions shrink;
    shrink.output.format = TextureOutput::webp;
    shrink.shown_pixels = kSize;
    TextureLadders images(land_.model, shrink, context_);
    const auto whole = static_cast<double>(land_.model.images[0].bytes.size());
    for (int i = 0; i < kTextures; ++i) {
      // From half of the file's bytes on; a smaller one may be all that there is.
      const double bytes = 0.5 * whole * share(i, kTextures) / kMost;
      const std::size_t way = images.within(static_cast<std::uint64_t>(bytes), false)[0];
      if (!ladders.textures.empty() && images.bytes(0, way) >= ladders.textures.back().bytes) continue;
      const Image8 image = decode_image(images.stored(0, way).bytes);
      add_texture(ladders, image, images.bytes(0, way),
                  static_cast<double>(image.width) * image.height /
                      (static_cast<double>(scene_.images[image_of(scene_)].map->width()) *
                       scene_.images[image_of(scene_)].map->height()));
    }
    return ladders;
  }

  /// Meshes with the whole texture and textures on the whole mesh, by kind, at equal triangles and bytes.
  void print_single(const Ladders& paper, const Ladders& own) {
    const Model seen = with_camera();
    const TextureRung whole_texture{scene_.images[image_of(scene_)].map, 0, 1};
    const MeshRung whole_mesh{land_.model, 0};
    const auto db = [&](const MeshRung& mesh, const TextureRung& texture) {
      return psnr(mean_squared_error(picture_, picture(mesh, texture)));
    };
    const QuadtreeLevels squares(land_.field, HeightError::squares, weights_),
        largest(land_.field, HeightError::largest, weights_), surface(land_.field, HeightError::squares);
    fmt::print(
        "| triangles | quadtree by squares, for the view | by the largest, for the view | by squares, for no "
        "view | collapses, for the view | for no view |\n|--:|--:|--:|--:|--:|--:|\n");
    for (std::size_t i = 0; i < paper.meshes.size(); i += 11) {
      const std::size_t triangles = triangle_count(paper.meshes[i].model);
      fmt::print("| {}", triangles);
      for (const QuadtreeLevels* levels : {&squares, &largest, &surface})
        fmt::print(" | {:.2f}",
                   db({with_level(land_.model, land_.field, levels->level(levels->splits_to(triangles))), 0},
                      whole_texture));
      fmt::print(" | {:.2f}", db({for_the_view(seen, triangles), 0}, whole_texture));
      const auto near = std::ranges::find_if(
          own.meshes, [&](const MeshRung& m) { return triangle_count(m.model) <= triangles + 2; });
      fmt::print(" | {:.2f} |\n", near == own.meshes.end() ? 0.0 : db(*near, whole_texture));
    }
    fmt::print("\n| bytes | wavelets, for the view | smaller images, at most so many |\n|--:|--:|--:|\n");
    for (std::size_t i = 0; i < paper.textures.size(); i += 5) {
      const TextureRung& texture = paper.textures[i];
      const auto near =
          std::ranges::find_if(own.textures, [&](const TextureRung& t) { return t.bytes <= texture.bytes; });
      fmt::print("| {} | {:.2f} | {} |\n", texture.bytes, db(whole_mesh, texture),
                 near == own.textures.end() ? "–" : fmt::format("{:.2f}", db(whole_mesh, *near)));
    }
    fmt::print("\n");
  }
  const std::string& note() const { return note_; }

  /// [#meshes][#textures] Mean squared differences on the screen.
  std::vector<std::vector<double>> draw(const Ladders& ladders) {
    std::vector<std::vector<double>> losses(ladders.meshes.size());
    parallel_for_or_throw(context_, losses.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t m = begin; m < end; ++m) {
        const Model& model = ladders.meshes[m].model;
        RenderScene scene = make_render_scene(model, rest_pose(model), context_, &scene_);
        for (const TextureRung& texture : ladders.textures) {
          scene.images[image_of(scene)].map = texture.map;
          losses[m].push_back(
              mean_squared_error(picture_, render(scene, land_.view, options_, context_).color));
        }
      }
    });
    return losses;
  }

  Image8 picture(const MeshRung& mesh, const TextureRung& texture) {
    RenderScene scene = make_render_scene(mesh.model, rest_pose(mesh.model), context_, &scene_);
    scene.images[image_of(scene)].map = texture.map;
    return render(scene, land_.view, options_, context_).color;
  }

 private:
  /// The land with the view as a camera of its own.
  Model with_camera() const {
    Model model = land_.model;
    const View& view = land_.view;
    Camera& camera = model.cameras.emplace_back();
    camera.yfov_rad = 2 * std::atan(view.half_height);
    Node node;
    node.camera = static_cast<int>(model.cameras.size()) - 1;
    Mat4& place = node.matrix.emplace();
    const std::array columns{view.right, view.up, view.back, view.eye};
    for (int c = 0; c < 4; ++c) {
      const Vec3d& column = columns[static_cast<std::size_t>(c)];
      place(0, c) = column.x;
      place(1, c) = column.y;
      place(2, c) = column.z;
    }
    model.nodes.push_back(node);
    if (!model.scenes.empty()) model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()) - 1);
    return model;
  }
  /// So many triangles of a land with a camera, its picture deciding about all.
  Model for_the_view(const Model& seen, std::size_t triangles) {
    SimplifyOptions options;
    options.triangles = static_cast<std::int64_t>(triangles);
    options.metric = Metric::image;
    options.metric_from = 1e9;
    options.views.set = ViewSet::cameras;
    options.view_size = kSize;
    options.image_pass = ImagePass::base_color;
    return simplify(seen, options, {}, context_).model;
  }

  void add_mesh(Ladders& ladders, Model model) {
    const std::uint64_t bytes = geometry_bytes(model, context_);
    if (ladders.meshes.empty() || bytes < ladders.meshes.back().bytes)
      ladders.meshes.push_back({std::move(model), bytes});
  }
  static void add_texture(Ladders& ladders, const Image8& image, std::uint64_t bytes, double kept) {
    if (ladders.textures.empty() || bytes < ladders.textures.back().bytes)
      ladders.textures.push_back({std::make_shared<const MipMap>(image, ColorEncoding::srgb), bytes, kept});
  }

  const Land& land_;
  Context& context_;
  RenderScene scene_;
  RenderOptions options_;
  Image8 picture_;
  std::vector<float> weights_;
  ResolutionMap resolution_;
  std::string note_;
};

std::vector<Land> lands(Context& context) {
  std::vector<Land> result;
  result.push_back(land_of("fovea sample terrain", make_sample("terrain", 1, context)));
  if (const auto folder = data_folder()) {
    const auto bytes = [&](const char* name) {
      const std::vector<std::byte> file = read_file(*folder / "terrain" / name, ReadOptions().max_file_bytes);
      std::vector<std::uint8_t> out(file.size());
      std::ranges::transform(file, out.begin(), [](std::byte b) { return std::to_integer<std::uint8_t>(b); });
      return out;
    };
    if (std::filesystem::exists(*folder / "terrain/puget_sound_height_512.png")) {
      TerrainMap map;
      map.heights = decode_heights(bytes("puget_sound_height_512.png"));
      map.texture.bytes = bytes("puget_sound_texture_1024.png");
      map.texture.mime_type = "image/png";
      result.push_back(land_of("Puget Sound", make_terrain(map, 1, context)));
    }
  }
  return result;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Draws three pairs of about an eighth of the largest one's bytes, and says what they are.
void write_trades(Experiment& experiment, const Ladders& ladders, const TerrainAnalysis& analysis,
                  const std::string& stem) {
  for (const auto& [kind, pair] : analysis.trades(0.125)) {
    const MeshRung& mesh = ladders.meshes[pair.rungs[0]];
    const TextureRung& texture = ladders.textures[pair.rungs[1]];
    write_image(experiment.picture(mesh, texture), fmt::format("{} {}.jpg", stem, kind), true);
    std::ofstream(fmt::format("{} {}.json", stem, kind))
        << fmt::format(R"({{"mesh_bytes": {}, "texture_bytes": {}, "psnr": {:.4f}}})", mesh.bytes,
                       texture.bytes, psnr(pair.loss));
  }
}

void measure_land(const Land& land, std::ofstream& points, const std::string& views, Context& context) {
  Experiment experiment(land, context);
  fmt::print("### {}\n\n{} x {} points, {:.0f} % of them in the picture.\n\n", land.name, land.field.columns,
             land.field.rows, 100 * experiment.seen_share());
  if (!views.empty()) write_image(experiment.picture(), views + "/" + land.name + ".png", true);
  std::array<Ladders, 2> both;
  std::array<double, 2> making{};
  for (const std::size_t i : {0u, 1u})
    making[i] = seconds_of([&] { both[i] = i == 1 ? experiment.own_ladders() : experiment.paper_ladders(); });
  experiment.print_single(both[0], both[1]);
  for (const bool is_own : {false, true}) {
    const Ladders& ladders = both[is_own ? 1 : 0];

    std::vector<std::vector<double>> losses;
    const double drawing = seconds_of([&] { losses = experiment.draw(ladders); });
    const MeshRung &fine = ladders.meshes.front(), &coarse = ladders.meshes.back();
    const TextureRung &sharp = ladders.textures.front(), &blurred = ladders.textures.back();
    fmt::print(
        "**{}**: {} meshes of {} to {} triangles ({} to {} bytes), {} textures of {:.3g} to {:.2g} % ({} to "
        "{} "
        "bytes){}; ladders {:.0f} s, {} pictures {:.0f} s. The largest pair {:.2f} dB, the smallest {:.2f} "
        "dB.\n\n",
        ladders.name, ladders.meshes.size(), triangle_count(fine.model), triangle_count(coarse.model),
        fine.bytes, coarse.bytes, ladders.textures.size(), 100 * sharp.kept, 100 * blurred.kept, sharp.bytes,
        blurred.bytes, is_own ? "" : ", " + experiment.note(), making[is_own ? 1 : 0],
        ladders.meshes.size() * ladders.textures.size(), drawing, psnr(losses.front().front()),
        psnr(losses.back().back()));
    const TerrainAnalysis analysis(ladders, losses);
    analysis.print();
    if (points.is_open()) analysis.write_points(points, land.name);
    if (!views.empty()) {
      const std::string stem = views + "/" + land.name + (is_own ? " own" : " paper");
      write_image(experiment.picture(fine, sharp), stem + " large.png", true);
      write_image(experiment.picture(coarse, blurred), stem + " small.png", true);
      if (!is_own) write_trades(experiment, ladders, analysis, views + "/" + land.name);
    }
    std::fflush(stdout);
  }
}

int run(int count, char** arguments) {
  try {
    std::vector<std::string> words(arguments + 1, arguments + count);
    const std::string file = take_option(words, "--points").value_or(""),
                      views = take_option(words, "--views").value_or("");
    if (!words.empty()) throw Error(ErrorKind::usage, words[0] + " is no option");
    std::ofstream points;
    if (!file.empty()) {
      points.open(file);
      points << "land,ladders,mesh,texture,mesh_bytes,texture_bytes,bytes,mse,psnr,hull,prune_step,prune_"
                "byte,prune_ahead,grow,prune_ahead_hull\n";
    }
    Context context;
    for (const Land& land : lands(context)) measure_land(land, points, views, context);
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "terrain_bench: {}\n", error.what());
    return exit_code(error.kind());
  }
}

}  // namespace
}  // namespace fovea::bench

int main(int count, char** arguments) { return fovea::bench::run(count, arguments); }
