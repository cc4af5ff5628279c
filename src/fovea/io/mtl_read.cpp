#include "fovea/io/mtl_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "fovea/io/text_scan.h"

namespace fovea {

namespace {

/// The statement "map_Kd -s 2 2 1 folder/name.png" after its first word.
struct MapStatement {
  std::string name;
  Sampler sampler;
  Vec2d offset{0, 0}, scale{1, 1};
  double bump = 1;
};

/// One material as far as it is read.
struct Draft {
  Material material;
  bool has_diffuse = false, is_black = false;
  bool is_matte = false;       // Ks 0 0 0
  bool has_roughness = false;  // Pr
  std::string color_image, alpha_image;
};

class MtlReader {
 public:
  MtlReader(std::span<const std::byte> bytes, const std::string& place, const std::set<std::string>& wanted,
            TextureLoader& textures, Context& context)
      : scan_(bytes, true), place_(place), wanted_(wanted), textures_(textures), context_(context) {}

  std::vector<Material> run();

 private:
  void read_statement();
  void begin_material(const std::string& name);
  void read_number(const std::function<void(double)>& use);
  bool read_color(double* rgb);
  MapStatement read_map();
  void read_map_option(std::string_view option, MapStatement& map);
  void read_offset_or_scale(Vec2d& value);
  std::optional<TextureRef> use_map(const MapStatement& map);
  void use_normal_map(const MapStatement& map, bool may_be_height);
  void finish();
  std::string here() const { return fmt::format("{}: line {}", place_, scan_.line()); }

  TextScanner scan_;
  const std::string& place_;
  const std::set<std::string>& wanted_;
  TextureLoader& textures_;
  Context& context_;
  std::vector<Material> materials_;
  std::optional<Draft> draft_;
};

std::vector<Material> MtlReader::run() {
  for (; !scan_.at_end(); scan_.next_line()) {
    if (!scan_.line_done()) read_statement();
  }
  finish();
  return std::move(materials_);
}

void MtlReader::read_statement() {
  const std::string_view word = scan_.word();
  if (word == "newmtl") {
    finish();
    begin_material(std::string(scan_.rest()));
    return;
  }
  if (!draft_) return;
  Material& m = draft_->material;
  if (word == "Kd") {
    draft_->has_diffuse = read_color(m.base_color_factor.data());
    draft_->is_black = m.base_color_factor[0] + m.base_color_factor[1] + m.base_color_factor[2] == 0;
  } else if (word == "Ks") {
    double ks[3];
    draft_->is_matte = read_color(ks) && ks[0] + ks[1] + ks[2] == 0;
  } else if (word == "Ke") {
    read_color(m.emissive_factor.data());
  } else if (word == "d") {
    read_number([&](double d) { m.base_color_factor[3] = std::clamp(d, 0.0, 1.0); });
  } else if (word == "Tr") {
    read_number([&](double tr) { m.base_color_factor[3] = std::clamp(1 - tr, 0.0, 1.0); });
  } else if (word == "Ns") {
    if (!draft_->has_roughness)
      read_number([&](double ns) { m.roughness_factor = roughness_of_exponent(ns); });
  } else if (word == "Pr") {
    read_number([&](double pr) { m.roughness_factor = std::clamp(pr, 0.0, 1.0); });
    draft_->has_roughness = true;
  } else if (word == "Pm") {
    read_number([&](double pm) { m.metallic_factor = std::clamp(pm, 0.0, 1.0); });
  } else if (word == "map_Kd") {
    const MapStatement map = read_map();
    draft_->color_image = map.name;
    m.base_color = use_map(map);
  } else if (word == "map_d") {
    draft_->alpha_image = read_map().name;
  } else if (word == "map_Ke") {
    m.emissive = use_map(read_map());
  } else if (word == "norm") {
    use_normal_map(read_map(), false);
  } else if (word == "map_Bump" || word == "map_bump" || word == "bump") {
    if (!m.normal) use_normal_map(read_map(), true);
  } else if (word.starts_with("map_") || word == "disp" || word == "refl") {
    context_.report("ignored-map", fmt::format("{} has no place in a glTF material", word), here());
  }
}

void MtlReader::begin_material(const std::string& name) {
  if (!wanted_.contains(name)) return;
  draft_.emplace();
  draft_->material.name = name;
  draft_->material.metallic_factor = 0;
}

void MtlReader::read_number(const std::function<void(double)>& use) {
  double value = 0;
  if (scan_.number(value) && std::isfinite(value)) {
    use(value);
  } else {
    context_.report("bad-material", "a number is missing or damaged", here());
  }
}

bool MtlReader::read_color(double* rgb) {
  double c[3];
  int count = 0;
  while (count < 3 && scan_.number(c[count]) && std::isfinite(c[count])) ++count;
  if (count == 0) {
    context_.report("bad-material", "a colour is missing or damaged", here());
    return false;
  }
  // One number stands for grey.
  for (int i = 0; i < 3; ++i) rgb[i] = std::clamp(count == 3 ? c[i] : c[0], 0.0, 1.0);
  return true;
}

MapStatement MtlReader::read_map() {
  MapStatement map;
  for (scan_.skip_blanks(); scan_.skip('-'); scan_.skip_blanks()) read_map_option(scan_.word(), map);
  map.name = scan_.rest();
  return map;
}

void MtlReader::read_map_option(std::string_view option, MapStatement& map) {
  if (option == "s") {
    read_offset_or_scale(map.scale);
  } else if (option == "o") {
    read_offset_or_scale(map.offset);
  } else if (option == "t") {
    Vec2d ignored;
    read_offset_or_scale(ignored);
  } else if (option == "bm") {
    scan_.number(map.bump);
  } else if (option == "clamp") {
    if (scan_.word() == "on") map.sampler.wrap_u = map.sampler.wrap_v = Wrap::clamp;
  } else {
    const int words = option == "mm" ? 2 : 1;  // all others (blendu, boost, imfchan, texres, type) take one
    for (int i = 0; i < words; ++i) scan_.word();
  }
}

/// Up to three numbers follow, the third for depth. The name may begin with a digit: a number must be a word.
void MtlReader::read_offset_or_scale(Vec2d& value) {
  double numbers[3] = {value.x, value.y, 1};
  for (double& x : numbers) {
    TextScanner ahead = scan_;
    double read = 0;
    if (!ahead.number(read) || !std::isfinite(read) || !ahead.at_word_end()) break;
    x = read;
    scan_ = ahead;
  }
  value = {numbers[0], numbers[1]};
}

std::optional<TextureRef> MtlReader::use_map(const MapStatement& map) {
  if (map.name.empty()) return {};
  const auto texture = textures_.texture(map.name, map.sampler, here());
  if (!texture) return {};
  TextureRef ref;
  ref.texture = *texture;
  if (map.scale != Vec2d{1, 1} || map.offset != Vec2d{0, 0}) {
    // v counts from the bottom in this format: 1 - (o + s (1 - v)).
    ref.transform = TextureTransform{{map.offset.x, 1 - map.offset.y - map.scale.y}, 0, map.scale};
  }
  return ref;
}

void MtlReader::use_normal_map(const MapStatement& map, bool may_be_height) {
  if (may_be_height && textures_.is_grey(map.name)) {
    context_.report("ignored-map", "a height map has no place in a glTF material", here());
    return;
  }
  draft_->material.normal = use_map(map);
  if (draft_->material.normal) draft_->material.normal_scale = map.bump;
}

void MtlReader::finish() {
  if (!draft_) return;
  Material& m = draft_->material;
  // Exporters that know only the image leave Kd black, which would multiply it away.
  if (m.base_color && draft_->is_black) std::fill_n(m.base_color_factor.begin(), 3, 1.0);
  if (!m.base_color && !draft_->has_diffuse) std::fill_n(m.base_color_factor.begin(), 3, 0.8);
  if (m.emissive && m.emissive_factor == std::array<double, 3>{0, 0, 0}) m.emissive_factor = {1, 1, 1};
  if (draft_->is_matte && !draft_->has_roughness) m.roughness_factor = 1;
  const bool image_alpha = !draft_->alpha_image.empty() && draft_->alpha_image == draft_->color_image;
  if (m.base_color_factor[3] < 1 || image_alpha) m.alpha_mode = AlphaMode::blend;
  if (!draft_->alpha_image.empty() && !image_alpha) {
    context_.report("ignored-map", "an opacity map apart from the colour map is not supported", place_);
  }
  materials_.push_back(std::move(m));
  draft_.reset();
}

}  // namespace

std::vector<Material> read_mtl(std::span<const std::byte> bytes, const std::string& place,
                               const std::set<std::string>& wanted, TextureLoader& textures,
                               Context& context) {
  return MtlReader(bytes, place, wanted, textures, context).run();
}

double roughness_of_exponent(double exponent) { return std::pow(2 / (std::max(exponent, 0.0) + 2), 0.25); }

double exponent_of_roughness(double roughness) {
  return std::clamp(2 / std::pow(std::max(roughness, 0.01), 4) - 2, 0.0, 1000.0);
}

}  // namespace fovea
