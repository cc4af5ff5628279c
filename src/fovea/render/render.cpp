#include "fovea/render/render.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/base/srgb.h"
#include "fovea/render/screen.h"
#include "fovea/render/shade.h"
#include "fovea/render/tile.h"

namespace fovea {

namespace {

/// Shaders of the triangles that were looked at last: neighbouring pixels mostly want the same.
class ShaderCache {
 public:
  ShaderCache(const RenderScene& scene, const Projection& projection, int anisotropy)
      : scene_(scene), projection_(projection), anisotropy_(anisotropy) {}

  const TriangleShader& get(std::uint32_t triangle) {
    Entry& entry = entries_[triangle % kSize];
    if (entry.triangle != triangle) {
      entry.shader.emplace(scene_, projection_, anisotropy_, triangle);
      entry.triangle = triangle;
    }
    return *entry.shader;
  }

 private:
  static constexpr std::size_t kSize = 64;
  struct Entry {
    std::uint32_t triangle = kInvalid;
    std::optional<TriangleShader> shader;
  };
  const RenderScene& scene_;
  const Projection& projection_;
  const int anisotropy_;
  std::array<Entry, kSize> entries_;
};

Rgba grey(float x) { return {x, x, x, 1}; }

/// A colour that tells numbers apart: of well-spread hues, none dark.
Rgba id_color(std::uint32_t id) {
  std::uint32_t x = id * 0x9E3779B1u + 0x7F4A7C15u;
  x = (x ^ x >> 15) * 0x85EBCA6Bu;
  x ^= x >> 13;
  const auto channel = [x](int shift) { return 0.25f + 0.75f * static_cast<float>(x >> shift & 0xFF) / 255; };
  return {channel(0), channel(8), channel(16), 1};
}

/// The other passes show numbers as they are.
bool shows_light(Pass pass) { return pass == Pass::base_color || pass == Pass::lit; }

/// A surface in a pixel: how many samples it has, and where their middle is.
struct Patch {
  std::uint32_t triangle = kInvalid;
  int count = 0;
  int sum_x = 0, sum_y = 0;  // of sample numbers within the pixel
};

using Patches = std::array<Patch, std::size_t{SampleGrid::kMostPerPixel} * SampleGrid::kMostPerPixel>;

class PictureMaker {
 public:
  PictureMaker(const RenderScene& scene, const View& view, std::span<const Pass> passes,
               const RenderOptions& options, const Context& context, std::span<const VertexField> fields)
      : scene_(scene),
        passes_(passes),
        options_(options),
        fields_(fields),
        grid_{static_cast<int>(options.width), static_cast<int>(options.height),
              static_cast<int>(options.samples)},
        projection_(view, grid_),
        bins_(scene, projection_, grid_, context),
        background_{to_light(options.background[0]), to_light(options.background[1]),
                    to_light(options.background[2]), 0} {
    Picture empty{Image8(grid_.width, grid_.height, 3, ColorEncoding::srgb),
                  Image8(grid_.width, grid_.height, 1, ColorEncoding::linear)};
    for (int x = 0; x < grid_.width; ++x)
      std::copy(options.background.begin(), options.background.end(), empty.color.at(x, 0));
    for (int y = 1; y < grid_.height; ++y)
      std::copy_n(empty.color.at(0, 0), 3 * grid_.width, empty.color.at(0, y));
    pictures_.assign(passes.size(), empty);
    const auto tiles = static_cast<std::size_t>(grid_.columns()) * static_cast<std::size_t>(grid_.rows());
    parallel_for(context, tiles, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t tile = begin; tile < end; ++tile) make_tile(tile);
    });
  }

  std::vector<Picture> take() { return std::move(pictures_); }

 private:
  void make_tile(std::size_t tile);
  void draw(TileSamples& samples, std::size_t tile, ShaderCache& shaders) const;
  std::size_t find_patches(const TileSamples& samples, int x, int y, Patches& patches) const;
  void resolve(const TileSamples& samples, int left, int top, ShaderCache& shaders);
  void resolve_blended(const TileSamples& samples, std::span<const BlendedSample> blended, Pass pass,
                       Picture& picture, int left, int top, ShaderCache& shaders) const;
  Rgba shade(Pass pass, const TriangleShader& shader, const SurfacePoint& point, LastLook& last) const;
  SurfacePoint middle(const Patch& patch, const TriangleShader& shader, int x, int y) const;
  void set_pixel(Picture& picture, Pass pass, int x, int y, Rgba light, float coverage) const;

  const RenderScene& scene_;
  std::span<const Pass> passes_;
  const RenderOptions& options_;
  std::span<const VertexField> fields_;
  SampleGrid grid_;
  Projection projection_;
  TileBins bins_;
  Rgba background_;
  std::vector<Picture> pictures_;  // [#passes]
};

void PictureMaker::make_tile(std::size_t tile) {
  const int column = static_cast<int>(tile) % grid_.columns(), row = static_cast<int>(tile) / grid_.columns();
  const int left = column * grid_.tile_pixels(), top = row * grid_.tile_pixels();
  if (bins_.opaque(tile).empty() && bins_.blended(tile).empty()) return;
  const auto samples = std::make_unique<TileSamples>(grid_, column, row);
  ShaderCache shaders(scene_, projection_, static_cast<int>(options_.anisotropy));
  draw(*samples, tile, shaders);
  std::vector<BlendedSample> blended;
  for (const std::uint32_t entry : bins_.blended(tile)) samples->blend(bins_.at(entry), blended);
  if (blended.empty()) {
    resolve(*samples, left, top, shaders);
    return;
  }
  // By sample, far to near; of equally near ones the first of the scene is below.
  std::sort(blended.begin(), blended.end(), [](const BlendedSample& a, const BlendedSample& b) {
    if (a.sample != b.sample) return a.sample < b.sample;
    if (a.nearness != b.nearness) return a.nearness < b.nearness;
    return a.triangle < b.triangle;
  });
  for (std::size_t i = 0; i < passes_.size(); ++i)
    resolve_blended(*samples, blended, passes_[i], pictures_[i], left, top, shaders);
}

void PictureMaker::draw(TileSamples& samples, std::size_t tile, ShaderCache& shaders) const {
  for (const std::uint32_t entry : bins_.opaque(tile)) {
    const ScreenTriangle triangle = bins_.at(entry);
    const SceneMesh& mesh = scene_.meshes[triangle.mesh];
    const std::uint32_t face = triangle.triangle - mesh.first_triangle;
    const SceneMaterial& material = scene_.materials[mesh.part_material[mesh.mesh->face_part[face]]];
    if (material.alpha_mode != AlphaMode::mask) {
      samples.draw(triangle);
      continue;
    }
    samples.draw_where(triangle, [&](double x, double y) {
      const TriangleShader& shader = shaders.get(triangle.triangle);
      LastLook last;
      return shader.base_color(shader.at(x, y), last).a >= material.alpha_cutoff;
    });
  }
}

Rgba PictureMaker::shade(Pass pass, const TriangleShader& shader, const SurfacePoint& point,
                         LastLook& last) const {
  switch (pass) {
    case Pass::base_color: return shader.base_color(point, last);
    case Pass::lit: return shader.lit(point, last);
    case Pass::normal: {
      const Vec3f n = shader.normal(point, last);
      return {0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0.5f + 0.5f * n.z, 1};
    }
    case Pass::depth: return grey(shader.depth(point));
    case Pass::triangle: return id_color(shader.triangle());
    case Pass::mesh: return id_color(shader.mesh_number());
    case Pass::part:
      return id_color(shader.mesh_number() * 64 + shader.mesh().mesh->face_part[shader.face().index()]);
    case Pass::field:
    case Pass::region: break;
  }
  const std::uint32_t mesh = shader.mesh().mesh_index;
  if (mesh >= fields_.size() || fields_[mesh].empty()) return {0.5f, 0.5f, 0.5f, 1};
  if (pass == Pass::region) return id_color(shader.region(point, fields_[mesh].values()));
  const auto color = heat_color(shader.field(point, fields_[mesh].values()));
  return {static_cast<float>(color[0]) / 255, static_cast<float>(color[1]) / 255,
          static_cast<float>(color[2]) / 255, 1};
}

/// The middle of a patch of the pixel (x, y).
SurfacePoint PictureMaker::middle(const Patch& patch, const TriangleShader& shader, int x, int y) const {
  const double step = 1.0 / grid_.per_pixel, share = step / patch.count;
  return shader.at(x + patch.sum_x * share + 0.5 * step, y + patch.sum_y * share + 0.5 * step);
}

/// The surfaces in pixel (x, y) of a tile.
std::size_t PictureMaker::find_patches(const TileSamples& samples, int x, int y, Patches& patches) const {
  const int n = grid_.per_pixel;
  const std::uint32_t first = samples.triangle(x * n, y * n);
  bool even = true;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) even &= samples.triangle(x * n + i, y * n + j) == first;
  }
  if (even) {
    const int sum = n * n * (n - 1) / 2;
    patches[0] = {first, n * n, sum, sum};
    return first == kInvalid ? 0 : 1;
  }
  std::size_t count = 0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const std::uint32_t triangle = samples.triangle(x * n + i, y * n + j);
      if (triangle == kInvalid) continue;
      std::size_t k = 0;
      while (k < count && patches[k].triangle != triangle) ++k;
      if (k == count) patches[count++] = {triangle, 0, 0, 0};
      ++patches[k].count;
      patches[k].sum_x += i;
      patches[k].sum_y += j;
    }
  }
  return count;
}

void PictureMaker::resolve(const TileSamples& samples, int left, int top, ShaderCache& shaders) {
  const int n = grid_.per_pixel;
  Patches patches;
  std::vector<Rgba> sums(passes_.size());
  for (int y = 0; y < samples.height() / n; ++y) {
    for (int x = 0; x < samples.width() / n; ++x) {
      const std::size_t count = find_patches(samples, x, y, patches);
      if (count == 0) continue;
      std::fill(sums.begin(), sums.end(), Rgba{0, 0, 0, 0});
      int covered = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const TriangleShader& shader = shaders.get(patches[k].triangle);
        const SurfacePoint point = middle(patches[k], shader, left + x, top + y);
        LastLook last;
        for (std::size_t i = 0; i < passes_.size(); ++i)
          sums[i] = sums[i] + shade(passes_[i], shader, point, last) * static_cast<float>(patches[k].count);
        covered += patches[k].count;
      }
      const float share = 1.0f / static_cast<float>(n * n);
      for (std::size_t i = 0; i < passes_.size(); ++i) {
        set_pixel(pictures_[i], passes_[i], left + x, top + y, sums[i] * share,
                  static_cast<float>(covered) * share);
      }
    }
  }
}

void PictureMaker::resolve_blended(const TileSamples& samples, std::span<const BlendedSample> blended,
                                   Pass pass, Picture& picture, int left, int top,
                                   ShaderCache& shaders) const {
  const int n = grid_.per_pixel;
  struct Shaded {
    std::uint32_t triangle;
    Rgba light;
  };
  std::vector<Shaded> known;
  const auto first_of = [&](std::uint32_t sample) {
    return std::lower_bound(blended.begin(), blended.end(), sample,
                            [](const BlendedSample& b, std::uint32_t s) { return b.sample < s; });
  };
  for (int y = 0; y < samples.height() / n; ++y) {
    for (int x = 0; x < samples.width() / n; ++x) {
      known.clear();
      const auto light_of = [&](std::uint32_t triangle) {
        for (const Shaded& shaded : known) {
          if (shaded.triangle == triangle) return shaded.light;
        }
        const TriangleShader& shader = shaders.get(triangle);
        LastLook last;
        known.push_back({triangle, shade(pass, shader, shader.at(left + x + 0.5, top + y + 0.5), last)});
        return known.back().light;
      };
      Rgba sum{0, 0, 0, 0};
      float coverage = 0;
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          const int sx = x * n + i, sy = y * n + j;
          const std::uint32_t opaque = samples.triangle(sx, sy);
          Rgba light{0, 0, 0, 0};
          if (opaque != kInvalid) {
            light = light_of(opaque);
            light.a = 1;
          }
          const auto sample = static_cast<std::uint32_t>(sy * SampleGrid::kTileSamples + sx);
          for (auto at = first_of(sample); at != blended.end() && at->sample == sample; ++at) {
            const Rgba over = light_of(at->triangle);
            light = over * over.a + light * (1 - over.a) + Rgba{0, 0, 0, over.a * (1 - over.a)};
          }
          sum = sum + light;
          coverage += light.a;
        }
      }
      const float share = 1.0f / static_cast<float>(n * n);
      if (coverage > 0) set_pixel(picture, pass, left + x, top + y, sum * share, coverage * share);
    }
  }
}

/// `light` is already weighted with coverage.
void PictureMaker::set_pixel(Picture& picture, Pass pass, int x, int y, Rgba light, float coverage) const {
  std::uint8_t* const out = picture.color.at(x, y);
  const float values[3] = {light.r, light.g, light.b};
  const float behind[3] = {background_.r, background_.g, background_.b};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!shows_light(pass)) {
      const float value = 255 * values[k] + static_cast<float>(options_.background[k]) * (1 - coverage);
      out[k] = static_cast<std::uint8_t>(std::clamp(value, 0.0f, 255.0f) + 0.5f);
    } else {
      out[k] = to_display(values[k] + behind[k] * (1 - coverage));
    }
  }
  *picture.coverage.at(x, y) = static_cast<std::uint8_t>(std::clamp(coverage, 0.0f, 1.0f) * 255 + 0.5f);
}

void check(const RenderScene& scene, const RenderOptions& options, std::span<const VertexField> fields) {
  if (options.width < 1 || options.height < 1 || options.width > 1 << 15 || options.height > 1 << 15)
    throw Error(ErrorKind::usage, "a picture has 1 to 32768 pixels along each side");
  if (options.samples < 1 || options.samples > SampleGrid::kMostPerPixel)
    throw Error(ErrorKind::usage, "a pixel has 1 to 8 samples along each axis");
  for (const SceneMesh& mesh : scene.meshes) {
    if (mesh.mesh_index < fields.size() && !fields[mesh.mesh_index].empty() &&
        fields[mesh.mesh_index].size() != mesh.mesh->vertex_count()) {
      throw Error(ErrorKind::usage, "a field has another number of values than its mesh has vertices");
    }
  }
}

}  // namespace

OptionList describe(RenderOptions& o) {
  return {{"pass", "What to show of the surface.",
           choice(o.pass,
                  {"base-color", "lit", "normal", "depth", "triangle", "mesh", "part", "field", "region"}),
           ""},
          {"width", "Width of a view.", &o.width, "pixels", 1, 32768},
          {"height", "Height of a view.", &o.height, "pixels", 1, 32768},
          {"samples", "Places per pixel and axis where the nearest surface is looked for.", &o.samples, "", 1,
           SampleGrid::kMostPerPixel},
          {"anisotropy", "Most looks into a texture where a surface is seen at an angle.", &o.anisotropy, "",
           1, 16}};
}

Picture render(const RenderScene& scene, const View& view, const RenderOptions& options,
               const Context& context, std::span<const VertexField> fields) {
  return std::move(render_passes(scene, view, {&options.pass, 1}, options, context, fields).front());
}

std::vector<Picture> render_passes(const RenderScene& scene, const View& view, std::span<const Pass> passes,
                                   const RenderOptions& options, const Context& context,
                                   std::span<const VertexField> fields) {
  check(scene, options, fields);
  return PictureMaker(scene, view, passes, options, context, fields).take();
}

std::vector<Picture> render_views(const RenderScene& scene, std::span<const View> views,
                                  const RenderOptions& options, const Context& context,
                                  std::span<const VertexField> fields) {
  check(scene, options, fields);
  std::vector<Picture> pictures(views.size());
  parallel_for_or_throw(context, views.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) pictures[i] = render(scene, views[i], options, context, fields);
  });
  return pictures;
}

VisibleSurface visible_surface(const RenderScene& scene, const View& view, int width, int height,
                               const Context& context) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  check(scene, options, {});
  const SampleGrid grid{width, height, 1};
  const Projection projection(view, grid);
  const TileBins bins(scene, projection, grid, context);
  VisibleSurface surface;
  surface.width = width;
  surface.height = height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  surface.triangle.assign(pixels, kInvalid);
  surface.distance.assign(pixels, std::numeric_limits<float>::infinity());
  const auto tiles = static_cast<std::size_t>(grid.columns()) * static_cast<std::size_t>(grid.rows());
  parallel_for(context, tiles, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t tile = begin; tile < end; ++tile) {
      const int column = static_cast<int>(tile) % grid.columns(),
                row = static_cast<int>(tile) / grid.columns();
      const auto samples = std::make_unique<TileSamples>(grid, column, row);
      for (const std::uint32_t entry : bins.opaque(tile)) samples->draw(bins.at(entry));
      for (const std::uint32_t entry : bins.blended(tile)) samples->draw(bins.at(entry));
      for (int y = 0; y < samples->height(); ++y) {
        for (int x = 0; x < samples->width(); ++x) {
          if (samples->triangle(x, y) == kInvalid) continue;
          const std::size_t at =
              static_cast<std::size_t>(row * grid.tile_pixels() + y) * static_cast<std::size_t>(width) +
              static_cast<std::size_t>(column * grid.tile_pixels() + x);
          surface.triangle[at] = samples->triangle(x, y);
          const float nearness = samples->nearness(x, y);
          surface.distance[at] = view.perspective ? 1 / nearness : -nearness;
        }
      }
    }
  });
  return surface;
}

std::array<std::uint8_t, 3> heat_color(float x) {
  x = std::clamp(x, 0.0f, 1.0f);
  // Sixth-degree polynomials through matplotlib's viridis, one per channel.
  static constexpr float kRed[7] = {0.2777273f, 0.1050930f, -0.3308618f, -4.6342305f,
                                    6.2282698f, 4.7763850f, -5.4354559f};
  static constexpr float kGreen[7] = {0.0054073f,  1.4046135f,   0.2148476f, -5.7991010f,
                                      14.1799334f, -13.7451454f, 4.6458526f};
  static constexpr float kBlue[7] = {0.3340998f,  1.3845902f,   0.0950952f, -19.3324410f,
                                     56.6905526f, -65.3530326f, 26.3124353f};
  const auto at = [x](const float* c) {
    float sum = c[6];
    for (int i = 5; i >= 0; --i) sum = sum * x + c[i];
    return static_cast<std::uint8_t>(std::clamp(sum, 0.0f, 1.0f) * 255 + 0.5f);
  };
  return {at(kRed), at(kGreen), at(kBlue)};
}

}  // namespace fovea
