#include "fovea/texture/image_ladder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "fovea/texture/image_output.h"
#include "fovea/texture/texel_loss.h"

namespace fovea {

namespace {

/// Between qualities, in dB.
constexpr double kPsnrStep = 1;

using Samples = std::vector<EncodingSample>;

/// How a size can be encoded.
struct SizeSamples {
  Samples asked, instead;  // in the format asked for, and in JPEG if that gives way
};

/// What a file takes and loses for each texel.
struct Encoding {
  double bytes = 0, mean_squared_error = 0;
};

double mixed(double a, double b, double t) { return a + (b - a) * t; }
/// In logarithms where there are such.
double mixed_powers(double a, double b, double t) {
  return a > 0 && b > 0 ? std::exp(mixed(std::log(a), std::log(b), t)) : mixed(a, b, t);
}

double best_with_loss(const Samples& samples) {
  double best = 0;
  for (const EncodingSample& s : samples) {
    if (std::isfinite(s.psnr_db)) best = std::max(best, s.psnr_db);
  }
  return best;
}

SizeSamples samples_of(const Image8& image, TextureFormat format, Content content, double psnr_db) {
  SizeSamples samples{encoding_samples(image, format, content), {}};
  if (format == TextureFormat::webp && !image.has_alpha() && best_with_loss(samples.asked) < psnr_db)
    samples.instead = encoding_samples(image, TextureFormat::jpeg, content);
  return samples;
}

/// Halfway between two sizes.
Samples between(const Samples& a, const Samples& b) {
  if (a.size() != b.size()) return a;
  Samples result = a;
  for (std::size_t i = 0; i < result.size(); ++i) {
    EncodingSample& s = result[i];
    if (std::isfinite(s.psnr_db) && std::isfinite(b[i].psnr_db))
      s.psnr_db = mixed(s.psnr_db, b[i].psnr_db, 0.5);
    s.mean_squared_error = mixed_powers(s.mean_squared_error, b[i].mean_squared_error, 0.5);
    s.bytes_per_texel = mixed_powers(s.bytes_per_texel, b[i].bytes_per_texel, 0.5);
  }
  return result;
}

/// The smallest encoding of that quality; none if no sample is as good.
std::optional<Encoding> encoding_at(const Samples& samples, double psnr_db) {
  std::optional<Encoding> best;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const EncodingSample& s = samples[i];
    if (s.psnr_db < psnr_db) continue;
    Encoding found{s.bytes_per_texel, s.mean_squared_error};
    if (i > 0 && std::isfinite(s.psnr_db) && samples[i - 1].psnr_db < psnr_db) {
      const EncodingSample& less = samples[i - 1];
      const double t = (psnr_db - less.psnr_db) / (s.psnr_db - less.psnr_db);
      found = {mixed_powers(less.bytes_per_texel, s.bytes_per_texel, t),
               mixed_powers(less.mean_squared_error, s.mean_squared_error, t)};
    }
    if (!best || found.bytes < best->bytes) best = found;
  }
  return best;
}

std::optional<Encoding> encoding_at(const SizeSamples& samples, double psnr_db) {
  std::optional<Encoding> found = encoding_at(samples.asked, psnr_db);
  if (best_with_loss(samples.asked) >= psnr_db) return found;
  const std::optional<Encoding> instead = encoding_at(samples.instead, psnr_db);
  return instead && (!found || instead->bytes < found->bytes) ? instead : found;
}

/// Where the texels of a map are in an image that lies as it does.
TexelOrigins same_places(const ImageF& weights) {
  TexelOrigins places{weights.width, weights.height, {}, {}};
  for (int y = 0; y < weights.height; ++y) {
    for (int x = 0; x < weights.width; ++x) {
      const double u = (x + 0.5) / weights.width, v = (y + 0.5) / weights.height;
      places.texels.push_back({{static_cast<float>(u), static_cast<float>(v)}, 0, 0});
      places.drawn.push_back(*weights.at(x, y) > 0 ? 1 : 0);
    }
  }
  return places;
}

double weighted_mean(const ImageF& values, const ImageF& weights) {
  double sum = 0, all = 0;
  for (std::size_t i = 0; i < values.pixels.size(); ++i) {
    sum += static_cast<double>(weights.pixels[i]) * static_cast<double>(values.pixels[i]);
    all += static_cast<double>(weights.pixels[i]);
  }
  return all > 0 ? sum / all : 0;
}

/// The sizes of an image, and how each does.
struct Size {
  int width = 0, height = 0;
  double loss = 0;
  SizeSamples samples;
};

std::vector<Size> measured_sizes(const Image8& image, const ImageUse& use, TextureFormat format,
                                 double psnr_db, int half_octaves, const ImageF& weights,
                                 const Context& context) {
  const TexelOrigins places = same_places(weights);
  const Content content = content_of(use);
  std::vector<Size> sizes{{image.width, image.height, 0, samples_of(image, format, content, psnr_db)}};
  Image8 one_up, two_up;  // of the size that comes; empty where that is the image
  for (int k = 1; k <= half_octaves; ++k) {
    const auto side = [&](int whole) {
      return std::max(1, static_cast<int>(std::lround(whole * std::exp2(-0.5 * k))));
    };
    const Image8& from = two_up.pixels.empty() ? image : two_up;
    Image8 next =
        resized(from, side(image.width), side(image.height), use.meaning, use.wrap_u, use.wrap_v, context);
    Size& size = sizes.emplace_back(Size{next.width, next.height, 0, {}});
    size.loss = weighted_mean(texel_losses(image, next, use.meaning, places, context), weights);
    // Others lie between.
    if (k % 2 == 0 || k == half_octaves) size.samples = samples_of(next, format, content, psnr_db);
    two_up = std::exchange(one_up, std::move(next));
  }
  for (std::size_t k = 1; k + 1 < sizes.size(); k += 2) {
    const SizeSamples &a = sizes[k - 1].samples, &b = sizes[k + 1].samples;
    sizes[k].samples = {between(a.asked, b.asked), between(a.instead, b.instead)};
  }
  return sizes;
}

}  // namespace

std::vector<LadderStep> image_steps(const Image8& image, const ImageUse& use, TextureFormat format,
                                    double psnr_db, int half_octaves, const ImageF& weights,
                                    const Context& context) {
  const double channels = use.meaning.transparent ? image.channels : image.color_channels();
  const double encoding_weight = static_cast<double>(loss_weight(use.meaning)) * channels / (255.0 * 255.0);
  std::vector<LadderStep> steps;
  for (const Size& size : measured_sizes(image, use, format, psnr_db, half_octaves, weights, context)) {
    double last_bytes = std::numeric_limits<double>::infinity();
    for (double psnr = psnr_db; psnr >= std::min(psnr_db, kLeastLadderPsnr); psnr -= kPsnrStep) {
      const std::optional<Encoding> found = encoding_at(size.samples, psnr);
      if (!found) continue;
      LadderStep step{size.width, size.height, psnr, false, steps.size(), 0, 0};
      step.bytes = found->bytes * size.width * size.height;
      step.loss = size.loss + encoding_weight * found->mean_squared_error;
      if (step.bytes >= last_bytes) continue;
      last_bytes = step.bytes;
      steps.push_back(step);
    }
    // A format that is never as good is taken at its best.
    if (std::isinf(last_bytes)) {
      const EncodingSample& best = size.samples.asked.back();
      steps.push_back({size.width, size.height, psnr_db, false, steps.size(),
                       best.bytes_per_texel * size.width * size.height,
                       size.loss + encoding_weight * best.mean_squared_error});
    }
  }
  return steps;
}

}  // namespace fovea
