#include "fovea/texture/regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/srgb.h"
#include "fovea/io/image_decoder.h"
#include "fovea/model/texture_use.h"
#include "fovea/model/wrap.h"
#include "fovea/texture/face_regions.h"

namespace fovea {

namespace {

constexpr std::size_t kNoImage = std::numeric_limits<std::size_t>::max();

/// Whether a layer has a value at the first corner of a face; then it has for the whole part.
bool covers(const AttributeLayer* layer, std::uint32_t face) {
  return layer != nullptr && layer->corner_value[std::size_t{3} * face].valid();
}

/// Mean colour of a triangle's corners times a factor, as display values 0 … 255.
Vec3f mean_color(const AttributeLayer& colors, std::uint32_t face, const std::array<double, 4>& factor) {
  std::array<float, 3> mean{};
  for (std::size_t k = 0; k < 3; ++k) {
    const ValueId id = colors.corner_value[std::size_t{3} * face + k];
    if (!id.valid()) continue;
    for (std::size_t channel = 0; channel < 3; ++channel) mean[channel] += colors.value(id)[channel] / 3;
  }
  const auto display = [&](std::size_t channel) {
    const float light = mean[channel] * static_cast<float>(factor[channel]);
    return light > 0 ? 255 * linear_to_srgb(std::min(light, 1.0f)) : 0;  // 0 for what is not a number
  };
  return {display(0), display(1), display(2)};
}

}  // namespace

/// Finds the regions of a model, kind by kind.
class RegionFinder {
 public:
  RegionFinder(const Model& model, const SegmentOptions& options, Context& context)
      : model_(model), options_(options), context_(context), decoder_(model), result_(model) {
    result_.images_.resize(model.images.size());
    result_.face_labels_.resize(model.meshes.size());
    for (const Mesh& mesh : model.meshes) {
      result_.parts_.emplace_back(mesh.surface.parts.size());
      auto& first_face = first_face_.emplace_back(mesh.surface.parts.size(), kInvalid);
      for (std::size_t f = mesh.surface.face_count(); f-- > 0;)
        first_face[mesh.surface.face_part[f]] = static_cast<std::uint32_t>(f);
    }
  }

  ModelRegions run() {
    segment_images();
    for (std::size_t m = 0; m < model_.meshes.size(); ++m) {
      std::vector<bool> is_colored(result_.parts_[m].size(), false);
      for (std::size_t p = 0; p < is_colored.size(); ++p) is_colored[p] = !set_part(m, p);
      if (std::find(is_colored.begin(), is_colored.end(), true) != is_colored.end())
        color_faces(m, is_colored);
    }
    context_.advance_or_throw("regions", 1);
    return std::move(result_);
  }

 private:
  /// How a part with triangles shows an image; none if it shows none.
  std::optional<TextureUse> texture_use(std::size_t mesh, std::size_t part) const {
    const TriMesh& surface = model_.meshes[mesh].surface;
    const std::uint32_t face = first_face_[mesh][part];
    if (face == kInvalid) return {};
    auto use = resolve(model_, material_of(model_, surface.parts[part]).base_color);
    if (use && !covers(surface.find(Semantic::uv, use->uv_set), face)) use.reset();
    return use;
  }

  void segment_images() {
    std::vector<bool> is_shown(model_.images.size(), false);
    for (std::size_t m = 0; m < model_.meshes.size(); ++m) {
      for (std::size_t p = 0; p < result_.parts_[m].size(); ++p) {
        if (const auto use = texture_use(m, p)) is_shown[static_cast<std::size_t>(use->image)] = true;
      }
    }
    for (std::size_t i = 0; i < is_shown.size(); ++i) {
      context_.advance_or_throw("regions", static_cast<double>(i) / static_cast<double>(is_shown.size()));
      if (is_shown[i]) result_.images_[i] = segmented(i);
    }
  }

  /// Empty if the image cannot be decoded.
  LabelMap segmented(std::size_t image) {
    const std::optional<Image8> decoded = decoder_.decode(image, context_);
    return decoded ? segment_image(*decoded, options_, context_) : LabelMap{};
  }

  /// The first of so many new regions.
  std::uint32_t take(std::uint32_t count) {
    if (count > std::numeric_limits<std::uint32_t>::max() - result_.count_)
      throw Error(ErrorKind::limit, "the model has too many regions");
    const std::uint32_t first = result_.count_;
    result_.count_ += count;
    return first;
  }

  /// False if the regions of a part are those of its triangles' colours.
  bool set_part(std::size_t mesh, std::size_t part) {
    const std::uint32_t face = first_face_[mesh][part];
    if (face == kInvalid) return true;
    const TriMesh& surface = model_.meshes[mesh].surface;
    const auto& [r, g, b, a] = material_of(model_, surface.parts[part]).base_color_factor;
    PartRegions& regions = result_.parts_[mesh][part];
    const auto use = texture_use(mesh, part);
    const std::size_t image = use ? static_cast<std::size_t>(use->image) : kNoImage;
    if (use && result_.images_[image].count > 0) {
      regions.first_ = first_of({image, {r, g, b}}, result_.images_[image].count);
      set_texture(regions, *use);
      return true;
    }
    const AttributeLayer* const colors = surface.find(Semantic::color);
    if (covers(colors, face) && !is_white(*colors)) return false;
    regions.first_ = first_of({kNoImage, {r, g, b}}, 1);
    return true;
  }

  /// An image, or none, with the factor that multiplies it.
  using Look = std::pair<std::size_t, std::array<double, 3>>;

  /// The first of the `count` regions of a look; new ones if it occurs for the first time.
  std::uint32_t first_of(const Look& look, std::uint32_t count) {
    const auto [entry, is_new] = first_of_look_.try_emplace(look, kBackground);
    if (is_new) entry->second = take(count);
    return entry->second;
  }

  void set_texture(PartRegions& regions, const TextureUse& use) const {
    const LabelMap& map = result_.images_[static_cast<std::size_t>(use.image)];
    regions.uv_set_ = use.uv_set;
    regions.texel_label_ = map.labels;
    regions.width_ = map.width;
    regions.height_ = map.height;
    regions.wrap_u_ = use.sampler.wrap_u;
    regions.wrap_v_ = use.sampler.wrap_v;
    regions.matrix_ = rounded(use.matrix);
  }

  /// Segments the triangles of all parts of a mesh that show vertex colours alone, across parts.
  void color_faces(std::size_t mesh, const std::vector<bool>& is_colored) {
    const TriMesh& surface = model_.meshes[mesh].surface;
    const AttributeLayer& layer = *surface.find(Semantic::color);
    std::vector<std::uint32_t> faces;
    std::vector<Vec3f> colors;
    for (std::uint32_t f = 0; f < surface.face_count(); ++f) {
      const std::uint32_t part = surface.face_part[f];
      if (!is_colored[part]) continue;
      faces.push_back(f);
      colors.push_back(mean_color(layer, f, material_of(model_, surface.parts[part]).base_color_factor));
    }
    const Segmentation found = segment_faces(surface, faces, colors, options_, context_);
    std::vector<std::uint32_t>& labels = result_.face_labels_[mesh];
    labels.resize(surface.face_count());
    for (std::size_t i = 0; i < faces.size(); ++i) labels[faces[i]] = found.label[i];
    const std::uint32_t first = take(found.count);
    for (std::size_t p = 0; p < is_colored.size(); ++p) {
      if (!is_colored[p]) continue;
      result_.parts_[mesh][p].first_ = first;
      result_.parts_[mesh][p].face_label_ = labels;
    }
  }

  const Model& model_;
  const SegmentOptions& options_;
  Context& context_;
  ImageDecoder decoder_;
  ModelRegions result_;
  std::vector<std::vector<std::uint32_t>> first_face_;  // [#meshes][#parts]
  std::map<Look, std::uint32_t> first_of_look_;
};

std::uint32_t ModelRegions::region_at(std::size_t mesh, FaceId face, Vec2f uv) const {
  const PartRegions& regions = part(mesh, model_->meshes[mesh].surface.face_part[face.index()]);
  if (!regions.is_textured()) return regions.region_of(face);
  const WideFloats u = WideFloats{} + uv.x, v = WideFloats{} + uv.y;
  WideWords texels;
  regions.texels_at(u, v, texels);
  return regions.region_of_texel(texels[0]);
}

ModelRegions model_regions(const Model& model, const SegmentOptions& options, Context& context) {
  SegmentOptions checked = options;
  check(describe(checked));
  return RegionFinder(model, options, context).run();
}

}  // namespace fovea
