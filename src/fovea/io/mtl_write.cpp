#include "fovea/io/mtl_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "fovea/io/flatten.h"
#include "fovea/io/mtl_read.h"
#include "fovea/model/texture_use.h"

namespace fovea {

namespace {

std::string clean_name(const std::string& name) {
  std::string result = name;
  for (char& c : result) {
    const auto u = static_cast<unsigned char>(c);
    if (u <= ' ' || u == 127 || c == '#' || c == '\\') c = '_';
  }
  return result;
}

void put_numbers(ByteWriter& out, std::string_view key, const double* numbers, std::size_t count) {
  out.put(key);
  for (std::size_t i = 0; i < count; ++i) {
    out.put(" ");
    out.put_number(static_cast<float>(numbers[i]));
  }
  out.put("\n");
}

/// Writes one library; keeps the file names of images already met.
class MtlWriter {
 public:
  MtlWriter(const Model& model, std::map<int, std::string> image_names)
      : model_(model), image_names_(std::move(image_names)) {}

  void add(const Material& m, const std::string& name) {
    out_.put("\nnewmtl " + name + "\n");
    put_numbers(out_, "Kd", m.base_color_factor.data(), 3);
    if (m.alpha_mode == AlphaMode::blend) put_numbers(out_, "d", &m.base_color_factor[3], 1);
    if (m.emissive_factor != std::array<double, 3>{0, 0, 0})
      put_numbers(out_, "Ke", m.emissive_factor.data(), 3);
    const double exponent = exponent_of_roughness(m.roughness_factor);
    put_numbers(out_, "Ns", &exponent, 1);
    put_numbers(out_, "Pr", &m.roughness_factor, 1);
    put_numbers(out_, "Pm", &m.metallic_factor, 1);
    put_map("map_Kd", m.base_color);
    if (m.alpha_mode != AlphaMode::opaque) put_map("map_d", m.base_color);
    const std::string strength = m.normal_scale == 1 ? "" : fmt::format("-bm {} ", m.normal_scale);
    put_map("map_Bump", m.normal, strength);
    put_map("norm", m.normal, strength);
    put_map("map_Ke", m.emissive);
  }
  std::vector<std::byte> take() { return std::move(out_.bytes); }

 private:
  void put_map(const char* key, const std::optional<TextureRef>& ref, const std::string& options = {}) {
    const auto name = image_names_.find(image_of(model_, ref));
    if (name == image_names_.end() || name->second.empty()) return;
    const Texture& texture = model_.textures[static_cast<std::size_t>(ref->texture)];
    const bool clamp = texture.sampler >= 0 &&
                       model_.samplers[static_cast<std::size_t>(texture.sampler)].wrap_u == Wrap::clamp;
    out_.put(fmt::format("{} {}{}{}\n", key, options, clamp ? "-clamp on " : "", name->second));
  }

  const Model& model_;
  std::map<int, std::string> image_names_;  // by image
  ByteWriter out_;
};

std::vector<int> used_images(const Model& model, const std::vector<int>& materials) {
  std::set<int> images;
  for (const int i : materials) {
    const Material& m = model.materials[static_cast<std::size_t>(i)];
    for (const auto* ref : {&m.base_color, &m.normal, &m.emissive}) images.insert(image_of(model, *ref));
  }
  images.erase(-1);
  return {images.begin(), images.end()};
}

}  // namespace

std::vector<std::string> material_names(const Model& model, const std::vector<int>& materials) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const int i : materials) {
    std::string base = clean_name(model.materials[static_cast<std::size_t>(i)].name);
    if (base.empty()) base = fmt::format("material_{}", i);
    std::string name = base;
    for (int n = 2; !taken.insert(name).second; ++n) name = fmt::format("{}_{}", base, n);
    names.push_back(name);
  }
  return names;
}

std::vector<std::byte> write_mtl(const Model& model, const std::vector<int>& materials,
                                 const std::vector<std::string>& names, const std::string& stem,
                                 std::vector<OutputFile>& files) {
  const std::vector<int> images = used_images(model, materials);
  const std::vector<std::string> file_names = add_image_files(model, images, stem, files);
  std::map<int, std::string> name_of_image;
  for (std::size_t i = 0; i < images.size(); ++i) name_of_image[images[i]] = file_names[i];
  MtlWriter writer(model, std::move(name_of_image));
  for (std::size_t i = 0; i < materials.size(); ++i) {
    writer.add(model.materials[static_cast<std::size_t>(materials[i])], names[i]);
  }
  return writer.take();
}

}  // namespace fovea
