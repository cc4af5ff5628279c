#include "fovea/texture/image_use.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "fovea/model/texture_use.h"

namespace fovea {

namespace {

using Json = nlohmann::json;
using Kind = TexelMeaning::Kind;

Kind kind_of(TextureRole role) {
  if (role == TextureRole::normal) return Kind::normal;
  return encoding(role) == ColorEncoding::srgb ? Kind::color : Kind::data;
}

Kind kind_by_name(std::string_view name) {
  constexpr std::array<std::string_view, 5> kColors{"sheenColorTexture", "specularColorTexture",
                                                    "diffuseTexture", "specularGlossinessTexture",
                                                    "diffuseTransmissionColorTexture"};
  if (std::ranges::find(kColors, name) != kColors.end()) return Kind::color;
  return name.find("ormalTexture") != std::string_view::npos ? Kind::normal : Kind::data;
}

class Collector {
 public:
  explicit Collector(const Model& model) : model_(model), uses_(model.images.size()) {}

  void add(const Material& material) {
    for (const auto& [role, ref] : textures_of(material)) {
      const bool alpha = role == TextureRole::base_color && material.alpha_mode != AlphaMode::opaque;
      TexelMeaning meaning{kind_of(role), alpha};
      if (alpha && material.alpha_mode == AlphaMode::mask) meaning.alpha_cutoff = material.alpha_cutoff;
      add(ref.texture, meaning, alpha);
    }
    add_extensions(material);
  }

  std::vector<ImageUse> take() { return std::move(uses_); }

 private:
  void add(int texture, const TexelMeaning& meaning, bool alpha) {
    if (texture < 0 || static_cast<std::size_t>(texture) >= model_.textures.size()) return;
    const Texture& t = model_.textures[static_cast<std::size_t>(texture)];
    if (t.image < 0 || static_cast<std::size_t>(t.image) >= uses_.size()) return;
    ImageUse& use = uses_[static_cast<std::size_t>(t.image)];
    if (!use.is_used) {
      use.meaning = meaning;
    } else if (use.meaning.kind != meaning.kind) {
      use.is_ambiguous = true;
    } else {
      use.meaning.transparent = use.meaning.transparent && meaning.transparent;
      if (!use.meaning.alpha_cutoff) use.meaning.alpha_cutoff = meaning.alpha_cutoff;
    }
    use.is_used = true;
    use.alpha_counts = use.alpha_counts || alpha;
    const bool known = t.sampler >= 0 && static_cast<std::size_t>(t.sampler) < model_.samplers.size();
    const Sampler sampler = known ? model_.samplers[static_cast<std::size_t>(t.sampler)] : Sampler();
    use.wrap_u = stronger(use.wrap_u, sampler.wrap_u);
    use.wrap_v = stronger(use.wrap_v, sampler.wrap_v);
  }

  void add_extensions(const Material& material) {
    const Json json = Json::parse(material.json, nullptr, false);
    if (!json.is_object() || !json.contains("extensions") || !json["extensions"].is_object()) return;
    for (const Json& extension : json["extensions"]) {
      if (!extension.is_object()) continue;
      for (const auto& [name, value] : extension.items()) {
        if (!name.ends_with("Texture") || !value.is_object()) continue;
        const Json index = value.value("index", Json());
        if (index.is_number_integer()) add(index.get<int>(), {kind_by_name(name)}, true);
      }
    }
  }

  static Wrap stronger(Wrap a, Wrap b) {
    if (a == Wrap::repeat || b == Wrap::repeat) return Wrap::repeat;
    return a == Wrap::mirror || b == Wrap::mirror ? Wrap::mirror : Wrap::clamp;
  }

  const Model& model_;
  std::vector<ImageUse> uses_;
};

}  // namespace

std::vector<ImageUse> image_uses(const Model& model) {
  Collector collector(model);
  for (const Material& material : model.materials) collector.add(material);
  return collector.take();
}

}  // namespace fovea
