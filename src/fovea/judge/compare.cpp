#include "fovea/judge/compare.h"

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/judge/silhouette.h"
#include "fovea/model/image_error.h"

namespace fovea {

namespace {

constexpr std::array<Pass, 2> kPasses{Pass::base_color, Pass::lit};  // by JudgedPass

/// Means over the views.
void summarize(Comparison& c) {
  if (c.views.empty()) return;
  const auto count = static_cast<double>(c.views.size());
  c.silhouette_iou = 0;
  for (std::size_t p = 0; p < kPasses.size(); ++p) {
    ImageScores sum{0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    for (const ViewComparison& view : c.views) {
      const ImageScores& s = view.passes[p];
      sum.mse += s.mse / count;
      sum.mse_foreground += s.mse_foreground / count;
      sum.ssim += s.ssim / count;
      sum.ssim_foreground += s.ssim_foreground / count;
      sum.ms_ssim += s.ms_ssim / count;
      sum.ms_ssim_foreground += s.ms_ssim_foreground / count;
      sum.flip += s.flip / count;
      sum.flip_foreground += s.flip_foreground / count;
    }
    sum.psnr = psnr(sum.mse);
    sum.psnr_foreground = psnr(sum.mse_foreground);
    c.passes[p] = sum;
  }
  for (const ViewComparison& view : c.views) c.silhouette_iou += view.silhouette_iou / count;
}

/// How far the vertices of each mesh are from a surface, of `unit`; of a mesh that is shown several times, in
/// its first place.
std::vector<VertexField> distance_fields(const RenderScene& scene, const ClosestPoint& surface, double unit,
                                         const Context& context) {
  std::vector<VertexField> fields;
  for (const SceneMesh& mesh : scene.meshes) {
    if (mesh.mesh_index >= fields.size()) fields.resize(mesh.mesh_index + 1);
    VertexField& field = fields[mesh.mesh_index];
    if (!field.empty()) continue;
    const std::vector<Vec3f>& positions = mesh.surface.positions;
    field = VertexField(positions.size());
    parallel_for(context, positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        field.values()[v] = static_cast<float>(surface.nearest(Vec3d(positions[v])).distance / unit);
    });
  }
  return fields;
}

void show_distances(const Surface& reference, const std::vector<RenderScene>& tests,
                    const std::vector<View>& views, RenderOptions options, const Context& context,
                    const CompareObserver& observer) {
  const ClosestPoint surface(reference);
  options.pass = Pass::field;
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const std::vector<VertexField> fields =
        distance_fields(tests[t], surface, kHottestDistance * diagonal(reference), context);
    parallel_for(context, views.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        RenderOptions own = options;
        own.width = picture_width(views[v], own.height);
        observer.distances(v, t, render(tests[t], views[v], own, context, fields));
      }
    });
  }
}

}  // namespace

OptionList describe(CompareOptions& o) {
  OptionList options = describe(o.pose);
  const OptionList views = describe(o.views);
  options.insert(options.end(), views.begin(), views.end());
  options.insert(
      options.end(),
      {{"view-size", "Pixels along the height of a view.", &o.size, "pixels", 11, 8192},
       {"pixels-per-degree", "Of the observer that FLIP stands for: 67 is a 4K screen at arm's length.",
        &o.pixels_per_degree, "", 1, 1000},
       {"distance-samples", "Points on each surface for the distance between them; 0 does not measure it.",
        &o.distance_samples, "", 0, 1e8}});
  // As pictures have it.
  RenderOptions picture;
  for (Option& option : describe(picture)) {
    if (option.name != "samples") continue;
    option.value = &o.samples;
    options.push_back(option);
  }
  return options;
}

Surface triangles_of(const RenderScene& scene) {
  Surface surface;
  for (const SceneMesh& mesh : scene.meshes) append(surface, *mesh.mesh, mesh.surface.positions);
  return surface;
}

std::vector<Comparison> compare(const Model& reference, std::span<const Model* const> tests,
                                const CompareOptions& options, Context& context,
                                const CompareObserver& observer) {
  const Pose pose = pose_of(reference, options.pose);
  const RenderScene scene = make_render_scene(reference, pose, context);
  if (scene.triangle_count == 0)
    throw Error(ErrorKind::unsupported, "the reference has no triangles to compare with");
  std::vector<RenderScene> test_scenes;
  for (const Model* test : tests)
    test_scenes.push_back(make_render_scene(*test, pose_of(*test, options.pose), context, &scene));
  const std::vector<View> views = views_of(options.views, reference, pose, scene.sphere);

  std::vector<Comparison> result(tests.size());
  for (Comparison& comparison : result) comparison.views.resize(views.size());
  if (observer.begin) observer.begin(views.size(), tests.size());
  RenderOptions render_options;
  render_options.height = options.size;
  render_options.samples = options.samples;
  const auto compare_view = [&](std::size_t v) {
    const auto draw = [&](const RenderScene& drawn) {
      RenderOptions own = render_options;
      own.width = picture_width(views[v], own.height);
      return render_passes(drawn, views[v], kPasses, own, context);
    };
    std::vector<ReferencePicture> references;
    for (Picture& picture : draw(scene))
      references.emplace_back(std::move(picture), options.pixels_per_degree);
    const Image8& coverage = references.front().picture().coverage;
    for (std::size_t t = 0; t < tests.size(); ++t) {
      const std::vector<Picture> pictures = draw(test_scenes[t]);
      const Plane mask = foreground(coverage, pictures.front().coverage);
      ViewComparison& view = result[t].views[v];
      view.name = views[v].name;
      view.silhouette_iou = silhouette_iou(coverage, pictures.front().coverage);
      for (std::size_t p = 0; p < kPasses.size(); ++p) {
        const Plane flip = references[p].flip(pictures[p]);
        view.passes[p] = references[p].score(pictures[p], flip, mask);
        if (observer.pictures)
          observer.pictures(v, t, kJudgedPasses[p], references[p].picture(), pictures[p], flip);
      }
    }
  };
  parallel_for(context, views.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end && !context.cancelled(); ++v) compare_view(v);
  });
  context.advance_or_throw("compare", 0.9);

  const Surface surface = triangles_of(scene);
  for (std::size_t t = 0; t < tests.size(); ++t) {
    summarize(result[t]);
    result[t].reference_diagonal = diagonal(surface);
    if (options.distance_samples == 0) continue;
    result[t].distance =
        surface_distance(surface, triangles_of(test_scenes[t]), options.distance_samples, context);
  }
  if (observer.distances) show_distances(surface, test_scenes, views, render_options, context, observer);
  context.advance_or_throw("compare", 1);
  return result;
}

}  // namespace fovea
