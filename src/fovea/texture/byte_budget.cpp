#include "fovea/texture/byte_budget.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/io/image_codec.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/image_ladder.h"
#include "fovea/texture/importance.h"

namespace fovea {

namespace {

/// Longest side of the maps that losses are measured on, in texels.
constexpr int kMapSide = 512;
/// Of the sides that an image has: the least it may come to, as halves of octaves.
constexpr int kMostHalfOctaves = 10;
/// Most texels of all images that are kept decoded.
constexpr std::int64_t kMostTexels = std::int64_t{1} << 27;
/// Rounds of correcting estimates, and the part of the bytes that may be left over.
constexpr int kRounds = 8;
constexpr double kSlack = 0.02;
/// By how much more than it is over the goal goes down, once rounds are up.
constexpr double kHaste = 0.98;

/// How much of the surface the texels of an atlas show and how much that is looked at; the same everywhere
/// where its images are tiled, or nothing is known of how they lie.
ImageF seen_weights(const Model& model, const Atlas& atlas, std::span<const VertexField> field,
                    const Context& context) {
  if (!atlas.fixed_because.empty()) {
    ImageF even(kMapSide, kMapSide, 1, ColorEncoding::linear);
    std::ranges::fill(even.pixels, 1.0f);
    return even;
  }
  const TextureImportance maps = texture_importance(model, atlas, field, kMapSide, context);
  ImageF weights = maps.coverage;
  for (std::size_t i = 0; i < weights.pixels.size(); ++i) weights.pixels[i] *= maps.saliency.pixels[i];
  return weights;
}

int half_octaves(const WantedImage& limit, const ImageChange::State& before) {
  const double part = static_cast<double>(std::max(limit.width, limit.height)) /
                      static_cast<double>(std::max(before.width, before.height));
  return std::max(0, kMostHalfOctaves + static_cast<int>(std::floor(2 * std::log2(part) + 1e-9)));
}

}  // namespace

ByteBudget::ByteBudget(const Model& model, std::span<const Atlas> atlases,
                       std::span<const WantedImage> limits, const ImageOutputOptions& options,
                       std::span<const VertexField> field, Context& context)
    : model_(model),
      limits_(limits.begin(), limits.end()),
      options_(options),
      context_(context),
      uses_(image_uses(model)) {
  std::int64_t texels = 0;
  for (const EncodedImage& image : model.images) {
    kept_bytes_ += static_cast<double>(image.bytes.size());
    const ImageChange::State state = state_of(image);
    texels += std::int64_t{state.width} * state.height;
  }
  is_roomy_ = texels <= kMostTexels;
  for (std::size_t a = 0; a < atlases.size(); ++a) {
    context.advance_or_throw("sizes", static_cast<double>(a) / static_cast<double>(atlases.size()));
    std::vector<Candidate> found;
    for (const int image : atlases[a].images) {
      if (limits_[static_cast<std::size_t>(image)].width > 0)
        found.push_back({static_cast<std::size_t>(image), &atlases[a]});
    }
    if (found.empty()) continue;
    const ImageF weights = seen_weights(model, atlases[a], field, context);
    const double area = seen_area(model, atlases[a], field);
    parallel_for_or_throw(context, found.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) measure(found[i], weights, area);
    });
    for (Candidate& candidate : found) {
      if (candidate.steps.empty()) continue;
      kept_bytes_ -= static_cast<double>(model.images[candidate.image].bytes.size());
      candidates_.push_back(std::move(candidate));
    }
  }
}

/// What between its charts is filled, if it gets smaller.
Image8 ByteBudget::whole(const Candidate& candidate) const {
  Image8 image =
      without_idle_alpha(decode_image(model_.images[candidate.image].bytes), uses_[candidate.image]);
  fill_between(image, known_faces(candidate), context_);
  return image;
}

std::vector<AtlasFace> ByteBudget::known_faces(const Candidate& candidate) const {
  return candidate.atlas->fixed_because.empty() ? atlas_faces(model_, *candidate.atlas)
                                                : std::vector<AtlasFace>{};
}

Image8 ByteBudget::picture(const Candidate& candidate, int width, int height) const {
  const ImageUse& use = uses_[candidate.image];
  const ImageChange::State before = state_of(model_.images[candidate.image]);
  if (width == before.width && height == before.height)
    return without_idle_alpha(decode_image(model_.images[candidate.image].bytes), use);
  if (!candidate.whole.pixels.empty())
    return resized(candidate.whole, width, height, use.meaning, use.wrap_u, use.wrap_v, context_);
  return resized(whole(candidate), width, height, use.meaning, use.wrap_u, use.wrap_v, context_);
}

void ByteBudget::measure(Candidate& candidate, const ImageF& weights, double area) const {
  const EncodedImage& file = model_.images[candidate.image];
  const WantedImage& limit = limits_[candidate.image];
  const ImageChange::State before = state_of(file);
  const auto most = static_cast<double>(file.bytes.size());
  try {
    if (is_roomy_) candidate.whole = whole(candidate);
    const Image8 image = picture(candidate, limit.width, limit.height);
    const TextureFormat format = output_format(image, before.mime_type, options_);
    candidate.steps = image_steps(image, uses_[candidate.image], format, options_.psnr_db,
                                  half_octaves(limit, before), weights, context_);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::cancelled) throw;
    return;
  }
  for (LadderStep& step : candidate.steps) {
    step.bytes = std::min(step.bytes, most);
    step.loss *= area;
  }
  if (limit.stays)
    candidate.steps.push_back(
        {limit.width, limit.height, limit.psnr_db, true, candidate.steps.size(), most, 0});
  candidate.exact.resize(candidate.steps.size());
}

double ByteBudget::encoded_bytes(const Candidate& candidate, const LadderStep& step) const {
  const EncodedImage& file = model_.images[candidate.image];
  if (step.is_file) return static_cast<double>(file.bytes.size());
  ImageOutputOptions options = options_;
  options.psnr_db = step.psnr_db;
  const std::optional<ImageOutput> output = encode_output(
      picture(candidate, step.width, step.height), uses_[candidate.image], state_of(file).mime_type,
      file.bytes.size(), options, read_texels(known_faces(candidate), step.width, step.height, context_));
  return static_cast<double>(output ? output->texture.bytes.size() : file.bytes.size());
}

ByteBudget::Numbers ByteBudget::numbers_within(double bytes) const {
  std::vector<std::vector<LadderStep>> ways;
  std::vector<SizeLadder> ladders;
  for (const Candidate& candidate : candidates_) {
    ways.push_back(candidate.steps);
    for (LadderStep& step : ways.back())
      step.bytes = candidate.exact[step.number].value_or(step.bytes * candidate.correction);
    ladders.push_back(lower_hull(ways.back()));
  }
  const std::vector<std::size_t> chosen = choose_steps(ladders, bytes);
  Numbers numbers;
  for (std::size_t c = 0; c < chosen.size(); ++c) numbers.push_back(ladders[c][chosen[c]].number);
  fill_room(ways, bytes, numbers);
  return numbers;
}

/// What files take that are encoded so, those that stay among them.
double ByteBudget::encode(const Numbers& numbers) {
  parallel_for_or_throw(context_, numbers.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      Candidate& candidate = candidates_[c];
      std::optional<double>& exact = candidate.exact[numbers[c]];
      if (exact) continue;
      const LadderStep& step = candidate.steps[numbers[c]];
      exact = encoded_bytes(candidate, step);
      if (!step.is_file) candidate.correction = *exact / step.bytes;
    }
  });
  double sum = kept_bytes_;
  for (std::size_t c = 0; c < numbers.size(); ++c) sum += *candidates_[c].exact[numbers[c]];
  return sum;
}

double ByteBudget::loss(const Numbers& numbers) const {
  double sum = 0;
  for (std::size_t c = 0; c < numbers.size(); ++c) sum += candidates_[c].steps[numbers[c]].loss;
  return sum;
}

std::vector<WantedImage> ByteBudget::wanted(const Numbers& numbers) const {
  std::vector<WantedImage> images = limits_;
  for (std::size_t c = 0; c < numbers.size(); ++c) {
    const LadderStep& step = candidates_[c].steps[numbers[c]];
    WantedImage& image = images[candidates_[c].image];
    const bool is_limit = step.is_file || (!image.stays && step.width == image.width &&
                                           step.height == image.height && step.psnr_db == image.psnr_db);
    if (!is_limit) image = {step.width, step.height, step.psnr_db, false, SizeReason::bytes};
  }
  return images;
}

std::vector<WantedImage> ByteBudget::choose(double bytes) {
  std::optional<Numbers> best;
  double goal = bytes - kept_bytes_;
  for (int round = 0;; ++round) {
    context_.advance_or_throw("sizes", 1);
    const Numbers numbers = numbers_within(goal);
    const double sum = encode(numbers);
    const bool is_known = numbers == numbers_within(goal);
    if (sum <= bytes && (!best || loss(numbers) < loss(*best))) best = numbers;
    if (best && (round >= kRounds || is_known || sum >= (1 - kSlack) * bytes)) break;
    if (sum <= bytes) continue;
    if (is_known) {
      // Nothing is smaller.
      best = numbers;
      break;
    }
    // With a goal below 0 the least is tried already.
    if (round >= kRounds && goal > 0)
      goal *= kHaste * std::min(1.0, (bytes - kept_bytes_) / (sum - kept_bytes_));
  }
  return wanted(*best);
}

}  // namespace fovea
