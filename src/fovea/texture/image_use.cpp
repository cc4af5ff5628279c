#include "fovea/texture/image_use.h"

#include "fovea/texture/texture_read.h"

namespace fovea {

namespace {

Wrap stronger(Wrap a, Wrap b) {
  if (a == Wrap::repeat || b == Wrap::repeat) return Wrap::repeat;
  return a == Wrap::mirror || b == Wrap::mirror ? Wrap::mirror : Wrap::clamp;
}

void add(const TextureRead& read, ImageUse& use) {
  if (!use.is_used) {
    use.meaning = read.meaning;
  } else if (use.meaning.kind != read.meaning.kind) {
    use.is_ambiguous = true;
  } else {
    use.meaning.transparent = use.meaning.transparent && read.meaning.transparent;
    if (!use.meaning.alpha_cutoff) use.meaning.alpha_cutoff = read.meaning.alpha_cutoff;
  }
  use.is_used = true;
  use.alpha_counts = use.alpha_counts || read.alpha_counts;
  use.wrap_u = stronger(use.wrap_u, read.wrap_u);
  use.wrap_v = stronger(use.wrap_v, read.wrap_v);
}

}  // namespace

std::vector<ImageUse> image_uses(const Model& model) {
  std::vector<ImageUse> uses(model.images.size());
  for (const Material& material : model.materials) {
    for (const TextureRead& read : texture_reads(model, material))
      add(read, uses[static_cast<std::size_t>(read.image)]);
  }
  return uses;
}

}  // namespace fovea
