#include "fovea/render/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/io/image_decoder.h"
#include "fovea/model/texture_use.h"

namespace fovea {

namespace {

/// Width over height of a camera that does not say; and at most, or its reciprocal at least.
constexpr double kScreenAspect = 16.0 / 9, kMostAspect = 4;

/// Numbers the images that materials ask for, and decodes them.
class SceneImages {
 public:
  SceneImages(const Model& model, SceneTextures textures)
      : model_(model), textures_(textures), decoder_(model) {}

  std::optional<SceneTexture> use(const Material& material, TextureRole role) {
    const bool is_detail = role != TextureRole::base_color && role != TextureRole::metallic_roughness;
    if (textures_ == SceneTextures::none || (is_detail && textures_ != SceneTextures::all)) return {};
    const std::optional<TextureUse> use = resolve(model_, texture_ref(material, role));
    if (!use) return {};
    const std::pair key{use->image, encoding(role)};
    const auto [entry, is_new] = number_.try_emplace(key, static_cast<int>(wanted_.size()));
    if (is_new) wanted_.push_back(key);
    SceneTexture result;
    result.image = entry->second;
    result.uv_set = use->uv_set;
    result.sampler = use->sampler;
    result.matrix = rounded(use->matrix);
    return result;
  }

  std::vector<SceneImage> make(Context& context, const RenderScene* other) {
    std::vector<SceneImage> images(wanted_.size());
    parallel_for(context, wanted_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        images[i].image = &model_.images[static_cast<std::size_t>(wanted_[i].first)];
        images[i].encoding = wanted_[i].second;
        if (other != nullptr) images[i].map = find(*other, images[i]);
        if (images[i].map == nullptr) images[i].map = decode(images[i], wanted_[i].first, context);
      }
    });
    return images;
  }

 private:
  static std::shared_ptr<const MipMap> find(const RenderScene& scene, const SceneImage& wanted) {
    for (const SceneImage& image : scene.images) {
      if (image.encoding == wanted.encoding && image.image->bytes == wanted.image->bytes) return image.map;
    }
    return nullptr;
  }

  std::shared_ptr<const MipMap> decode(const SceneImage& wanted, int number, Context& context) {
    const std::optional<Image8> image = decoder_.decode(static_cast<std::size_t>(number), context);
    return image ? std::make_shared<MipMap>(*image, wanted.encoding) : std::make_shared<MipMap>();
  }

  const Model& model_;
  const SceneTextures textures_;
  ImageDecoder decoder_;
  std::map<std::pair<int, ColorEncoding>, int> number_;
  std::vector<std::pair<int, ColorEncoding>> wanted_;  // image and encoding of each
};

SceneMaterial scene_material(const Material& m, SceneImages& images) {
  SceneMaterial s;
  const auto f = [](double x) { return static_cast<float>(x); };
  const auto& c = m.base_color_factor;
  s.base_color = {f(c[0]), f(c[1]), f(c[2]), f(c[3])};
  s.base_color_texture = images.use(m, TextureRole::base_color);
  s.metallic = f(m.metallic_factor);
  s.roughness = f(m.roughness_factor);
  s.metallic_roughness_texture = images.use(m, TextureRole::metallic_roughness);
  s.normal_texture = images.use(m, TextureRole::normal);
  s.normal_scale = f(m.normal_scale);
  s.occlusion_texture = images.use(m, TextureRole::occlusion);
  s.occlusion_strength = f(m.occlusion_strength);
  s.emission = {f(m.emissive_factor[0]), f(m.emissive_factor[1]), f(m.emissive_factor[2]), 1};
  s.emissive_texture = images.use(m, TextureRole::emissive);
  s.alpha_mode = m.alpha_mode;
  s.alpha_cutoff = f(m.alpha_cutoff);
  s.double_sided = m.double_sided;
  s.unlit = m.unlit;
  return s;
}

/// Takes back textures whose image could not be decoded, and numbers the footprints of the others.
void finish_textures(RenderScene& scene) {
  std::vector<const SceneTexture*> known;
  const auto map = [&](const SceneTexture& t) -> const MipMap& {
    return *scene.images[static_cast<std::size_t>(t.image)].map;
  };
  const auto same_look = [&](const SceneTexture& a, const SceneTexture& b) {
    return a.uv_set == b.uv_set && a.matrix == b.matrix && a.sampler.wrap_u == b.sampler.wrap_u &&
           a.sampler.wrap_v == b.sampler.wrap_v && a.sampler.mag_filter == b.sampler.mag_filter &&
           a.sampler.min_filter == b.sampler.min_filter && map(a).width() == map(b).width() &&
           map(a).height() == map(b).height();
  };
  for (SceneMaterial& m : scene.materials) {
    for (auto* texture : {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                          &m.occlusion_texture, &m.emissive_texture}) {
      if (!*texture) continue;
      if (map(**texture).level_count() == 0) {
        texture->reset();
        continue;
      }
      const auto same = std::find_if(known.begin(), known.end(),
                                     [&](const SceneTexture* other) { return same_look(**texture, *other); });
      (*texture)->look = static_cast<int>(same - known.begin());
      if (same == known.end()) known.push_back(&**texture);
    }
  }
}

/// The layers that shading reads.
void find_layers(SceneMesh& mesh) {
  mesh.normal = mesh.mesh->find(Semantic::normal);
  mesh.tangent = mesh.mesh->find(Semantic::tangent);
  mesh.color = mesh.mesh->find(Semantic::color);
  while (const AttributeLayer* layer = mesh.mesh->find(Semantic::uv, static_cast<int>(mesh.uv.size())))
    mesh.uv.push_back(layer);
}

Sphere sphere_around(const std::vector<SceneMesh>& meshes) {
  Box box;
  for (const SceneMesh& mesh : meshes) {
    for (const Vec3f& p : mesh.surface.positions) box.add(Vec3d(p));
  }
  Sphere sphere;
  sphere.center = box.center();
  double farthest2 = 0;
  for (const SceneMesh& mesh : meshes) {
    for (const Vec3f& p : mesh.surface.positions)
      farthest2 = std::max(farthest2, length_squared(Vec3d(p) - sphere.center));
  }
  sphere.radius = std::sqrt(farthest2);
  return sphere;
}

}  // namespace

RenderScene make_render_scene(const Model& model, const Pose& pose, Context& context,
                              const RenderScene* other, SceneTextures textures) {
  RenderScene scene;
  SceneImages images(model, textures);
  for (const Material& material : model.materials)
    scene.materials.push_back(scene_material(material, images));
  scene.materials.push_back(scene_material(Material{}, images));
  scene.images = images.make(context, other);
  finish_textures(scene);

  const std::vector<Instance> shown = instances(model, pose);
  for (const Instance& instance : shown) {
    SceneMesh mesh;
    mesh.mesh = &model.meshes[instance.mesh].surface;
    find_layers(mesh);
    mesh.mesh_index = static_cast<std::uint32_t>(instance.mesh);
    mesh.first_triangle = static_cast<std::uint32_t>(scene.triangle_count);
    for (const Part& part : mesh.mesh->parts) {
      mesh.part_material.push_back(
          static_cast<std::uint32_t>(part.material >= 0 ? part.material : model.materials.size()));
    }
    scene.triangle_count += mesh.mesh->face_count();
    if (scene.triangle_count >= std::numeric_limits<std::uint32_t>::max())
      throw Error(ErrorKind::limit, "more triangles are shown than can be drawn", "scene");
    scene.meshes.push_back(std::move(mesh));
  }
  parallel_for(context, shown.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) scene.meshes[i].surface = posed_surface(model, pose, shown[i]);
  });
  scene.sphere = sphere_around(scene.meshes);
  return scene;
}

RenderScene make_render_scene(const TriMesh& mesh) {
  RenderScene scene;
  scene.materials.emplace_back().double_sided = true;
  SceneMesh& shown = scene.meshes.emplace_back();
  shown.mesh = &mesh;
  shown.surface.positions = mesh.positions;
  shown.part_material.assign(mesh.parts.size(), 0);
  scene.triangle_count = mesh.face_count();
  scene.sphere = sphere_around(scene.meshes);
  return scene;
}

std::vector<View> camera_views(const Model& model, const Pose& pose) {
  std::vector<View> views;
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    if (model.nodes[n].camera < 0) continue;
    const Camera& camera = model.cameras[static_cast<std::size_t>(model.nodes[n].camera)];
    const Mat4& world = pose.node_world[n];
    View view;
    view.name = camera.name.empty() ? "camera-" + std::to_string(model.nodes[n].camera) : camera.name;
    view.eye = transform_point(world, {});
    // A scale on the node does not change what a camera sees.
    view.back = normalized(transform_direction(world, {0, 0, 1}));
    view.right = normalized(cross(transform_direction(world, {0, 1, 0}), view.back));
    view.up = cross(view.back, view.right);
    view.perspective = camera.perspective;
    view.half_height = camera.perspective ? std::tan(0.5 * camera.yfov_rad) : camera.ymag;
    view.near = camera.znear;
    const double own = camera.perspective ? camera.aspect.value_or(kScreenAspect) : camera.xmag / camera.ymag;
    view.aspect = std::isfinite(own) ? std::clamp(own, 1 / kMostAspect, kMostAspect) : 1;
    views.push_back(view);
  }
  return views;
}

namespace {

bool is_same(const View& a, const View& b) {
  return a.eye == b.eye && a.right == b.right && a.up == b.up && a.back == b.back;
}

/// What the cameras see that an animation moves, at `count` times of it; the others once, at rest.
std::vector<View> views_along(const Model& model, std::vector<View> resting, std::int64_t count) {
  std::vector<std::vector<View>> paths(resting.size());
  for (std::size_t a = 0; a < model.animations.size() && !resting.empty(); ++a) {
    const double duration = duration_s(model.animations[a]);
    std::vector<std::vector<View>> passed(resting.size());
    for (std::int64_t i = 0; i < count; ++i) {
      const double time =
          duration * static_cast<double>(i) / static_cast<double>(std::max<std::int64_t>(count - 1, 1));
      std::vector<View> now = camera_views(model, pose_at(model, a, time));
      for (std::size_t c = 0; c < now.size(); ++c) {
        if (!passed[c].empty() && is_same(passed[c].back(), now[c])) continue;
        now[c].name += fmt::format("-{}-{:.2f}s", a, time);
        passed[c].push_back(std::move(now[c]));
      }
    }
    for (std::size_t c = 0; c < passed.size(); ++c) {
      const bool is_moved =
          passed[c].size() > 1 || (passed[c].size() == 1 && !is_same(passed[c][0], resting[c]));
      if (is_moved) paths[c].insert(paths[c].end(), passed[c].begin(), passed[c].end());
    }
  }
  std::vector<View> views;
  for (std::size_t c = 0; c < resting.size(); ++c) {
    if (paths[c].empty()) paths[c].push_back(std::move(resting[c]));
    views.insert(views.end(), paths[c].begin(), paths[c].end());
  }
  return views;
}

}  // namespace

std::vector<View> views_of(const ViewOptions& options, const Model& model, const Pose& pose,
                           const Sphere& sphere) {
  if (options.set != ViewSet::cameras) return make_views(options, sphere);
  std::vector<View> views = camera_views(model, pose);
  if (pose == rest_pose(model)) views = views_along(model, std::move(views), options.count);
  if (views.empty())
    throw Error(ErrorKind::unsupported, "the model has no cameras", {}, "choose another set with --views");
  return views;
}

TriangleOrigin origin(const RenderScene& scene, std::uint32_t triangle) {
  const auto after =
      std::upper_bound(scene.meshes.begin(), scene.meshes.end(), triangle,
                       [](std::uint32_t t, const SceneMesh& mesh) { return t < mesh.first_triangle; });
  const auto mesh = static_cast<std::uint32_t>(after - scene.meshes.begin()) - 1;
  return {mesh, FaceId{triangle - scene.meshes[mesh].first_triangle}};
}

}  // namespace fovea
