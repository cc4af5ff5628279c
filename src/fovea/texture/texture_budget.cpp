#include "fovea/texture/texture_budget.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/io/image_codec.h"
#include "fovea/texture/importance.h"
#include "fovea/texture/size_ladder.h"

namespace fovea {

namespace {

/// How often sums of losses become the weights that find the next.
constexpr int kRounds = 6;

/// What is left is spent on a file if it is so much of that.
constexpr double kLeastFill = 0.005;

/// How near images that are all stored as near may be: from so many dB on, in so many steps of so many.
constexpr double kLeastAlikeDb = 24, kAlikeStepDb = 0.25;
constexpr int kAlikeSteps = 128;

/// How much of a squared difference lit pictures tell. With half as much for all but colours, as
/// `loss_weight` has it, colours took too many bytes: DamagedHelmet at a quarter of its sides was 0.4 dB
/// worse with light.
double lit_weight(const TexelMeaning& meaning) {
  switch (meaning.kind) {
    case TexelMeaning::Kind::color:
    case TexelMeaning::Kind::normal: return 1;
    case TexelMeaning::Kind::data: break;
  }
  return 0.5;
}

}  // namespace

TextureBudget::TextureBudget(const Model& model, std::span<const ImageChange::State> files,
                             std::span<const Atlas> atlases, std::span<const WantedImage> limits,
                             const ImageOutputOptions& options, std::span<const VertexField> field,
                             std::vector<double> pixels, double bytes, Context& context,
                             const ImageViewers* viewers)
    : model_(model),
      files_(files),
      limits_(limits.begin(), limits.end()),
      field_(field),
      pixels_(std::move(pixels)),
      most_bytes_(bytes),
      options_(options),
      context_(context),
      viewers_(viewers),
      uses_(image_uses(model)) {
  for (const EncodedImage& image : model.images) kept_bytes_ += static_cast<double>(image.bytes.size());
  for (std::size_t a = 0; a < atlases.size(); ++a) {
    context.advance_or_throw("sizes", static_cast<double>(a) / static_cast<double>(atlases.size()));
    const double area = viewers == nullptr ? seen_area(model, atlases[a], field)
                                           : static_cast<double>(viewers->sights(atlases[a]).size() + 1);
    std::vector<Candidate> found;
    for (const int image : atlases[a].images) {
      const auto i = static_cast<std::size_t>(image);
      if (!uses_[i].is_ambiguous) found.push_back({i, &atlases[a], area, 1, {}, {}});
    }
    parallel_for_or_throw(context, found.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) measure(found[i]);
    });
    for (Candidate& candidate : found) {
      if (candidate.ways.empty()) continue;
      kept_bytes_ -= static_cast<double>(model.images[candidate.image].bytes.size());
      candidates_.push_back(std::move(candidate));
    }
  }
}

ImageSights TextureBudget::sights(const Candidate& candidate) const {
  if (viewers_ != nullptr) return {viewers_->sights(*candidate.atlas), pixels_};
  return {model_, atlas_faces(model_, *candidate.atlas), field_, pixels_};
}

Image8 TextureBudget::decoded(std::size_t image) const {
  return without_idle_alpha(decode_image(model_.images[image].bytes), uses_[image]);
}

Image8 TextureBudget::shown(std::size_t image, Image8 picture) const {
  return viewers_ == nullptr ? std::move(picture) : viewers_->shown(image, picture);
}

void TextureBudget::measure(Candidate& candidate) const {
  const ImageChange::State& file = files_[candidate.image];
  const WantedImage& limit = limits_[candidate.image];
  const ImageUse& use = uses_[candidate.image];
  const auto bytes = static_cast<double>(file.bytes);
  try {
    const Image8 image = decoded(candidate.image);
    candidate.limits = {use, output_format(image, file.mime_type, options_), limit.width, limit.height,
                        std::min(bytes, most_bytes_ + 1)};
    const std::vector<AtlasFace> faces = known_faces(candidate);
    const ImageSights seen = sights(candidate);
    const ImageLoss loss(seen, image, use, context_);
    candidate.ways = image_ways(shown(candidate.image, image), candidate.limits, faces, loss, context_);
    if (limit.stays)
      candidate.ways.push_back(
          {limit.width, limit.height, std::nullopt, bytes, std::vector<double>(pixels_.size())});
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::cancelled) throw;
    candidate.ways.clear();
  }
}

void TextureBudget::refine(Candidate& candidate, double bytes, std::optional<int> halvings) const {
  const ImageUse& use = uses_[candidate.image];
  const Image8 image = decoded(candidate.image);
  const ImageSights seen = sights(candidate);
  std::vector<ImageWay> near;
  for (const ImageWay& way : candidate.ways)
    if (!halvings || is_halved(candidate, way, *halvings)) near.push_back(way);
  for (ImageWay& more : finer_ways(near, bytes, shown(candidate.image, image), candidate.limits,
                                   known_faces(candidate), ImageLoss(seen, image, use, context_), context_))
    candidate.ways.push_back(std::move(more));
}

std::vector<AtlasFace> TextureBudget::known_faces(const Candidate& candidate) const {
  return candidate.atlas->fixed_because.empty() ? atlas_faces(model_, *candidate.atlas)
                                                : std::vector<AtlasFace>{};
}

void TextureBudget::add(Sums& sums, const Candidate& candidate, const ImageWay& way) const {
  const TexelMeaning& meaning = uses_[candidate.image].meaning;
  for (std::size_t p = 0; p < pixels_.size(); ++p) {
    const double loss = area(candidate) * way.losses[p];
    if (meaning.kind == TexelMeaning::Kind::color) sums[2 * p] += loss;
    sums[2 * p + 1] += loss * lit_weight(meaning);
  }
}

bool TextureBudget::is_halved(const Candidate& candidate, const ImageWay& way, int times) const {
  const ImageChange::State& file = files_[candidate.image];
  return way.width == std::max(1, file.width >> times) && way.height == std::max(1, file.height >> times);
}

TextureBudget::Numbers TextureBudget::numbers_within(double bytes, std::optional<int> halvings) const {
  double whole = 0;
  for (const Candidate& candidate : candidates_) whole += area(candidate);
  // At first a picture counts by what it loses in the mean over all ways.
  Sums sums(2 * pixels_.size());
  for (const Candidate& candidate : candidates_) {
    Sums all(sums.size());
    for (const ImageWay& way : candidate.ways) add(all, candidate, way);
    for (std::size_t c = 0; c < sums.size(); ++c)
      sums[c] += all[c] / static_cast<double>(candidate.ways.size());
  }
  std::vector<Numbers> allowed;
  bool any_comes_so = false;
  for (const Candidate& candidate : candidates_) {
    Numbers& own = allowed.emplace_back();
    for (std::size_t w = 0; w < candidate.ways.size(); ++w)
      if (!halvings || is_halved(candidate, candidate.ways[w], *halvings)) own.push_back(w);
    any_comes_so |= !own.empty();
    if (!own.empty()) continue;
    own.resize(candidate.ways.size());
    std::iota(own.begin(), own.end(), std::size_t{0});
  }
  if (!any_comes_so) return {};
  Numbers numbers;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::vector<LadderStep>> steps;
    std::vector<SizeLadder> ladders;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      std::vector<LadderStep>& own = steps.emplace_back();
      for (const std::size_t w : allowed[c]) {
        const ImageWay& way = candidates_[c].ways[w];
        Sums lost(sums.size());
        add(lost, candidates_[c], way);
        double loss = 0;
        for (std::size_t p = 0; p < sums.size(); ++p)
          loss += lost[p] / std::max(sums[p], whole * kLeastImageLoss);
        own.push_back({own.size(), way.bytes, loss});
      }
      ladders.push_back(lower_hull(own));
    }
    const std::vector<std::size_t> chosen = choose_steps(ladders, bytes);
    Numbers next;
    for (std::size_t c = 0; c < chosen.size(); ++c) next.push_back(ladders[c][chosen[c]].number);
    fill_room(steps, bytes, next);
    for (std::size_t c = 0; c < next.size(); ++c) next[c] = allowed[c][next[c]];
    const bool is_known = next == numbers;
    numbers = std::move(next);
    if (is_known) break;
    std::ranges::fill(sums, 0.0);
    for (std::size_t c = 0; c < numbers.size(); ++c)
      add(sums, candidates_[c], candidates_[c].ways[numbers[c]]);
  }
  return numbers;
}

std::vector<WantedImage> TextureBudget::wanted(std::span<const std::size_t> ways) const {
  std::vector<WantedImage> images = limits_;
  for (const Candidate& candidate : candidates_) {
    const ImageWay& way = candidate.ways[ways[candidate.image]];
    WantedImage& image = images[candidate.image];
    if (!way.file) continue;
    const bool is_limit = way.width == image.width && way.height == image.height;
    const SizeReason reason = is_limit && image.reason != SizeReason::none ? image.reason : SizeReason::bytes;
    image = {way.width, way.height, image.psnr_db, false, reason, way.file};
  }
  return images;
}

void TextureBudget::fill_up(Numbers& numbers, double bytes) {
  Numbers order(numbers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto taken = [&](std::size_t c) { return candidates_[c].ways[numbers[c]].bytes; };
  std::ranges::stable_sort(order, std::greater(), taken);
  double left = bytes;
  for (const std::size_t c : order) left -= taken(c);
  for (const std::size_t c : order) {
    if (left < kLeastFill * taken(c)) continue;
    Candidate& candidate = candidates_[c];
    const ImageWay now = candidate.ways[numbers[c]];
    const ImageUse& use = uses_[candidate.image];
    const Image8 image = decoded(candidate.image);
    const ImageSights seen = sights(candidate);
    const double most = std::min(now.bytes + left, candidate.limits.most_bytes - 1);
    std::optional<ImageWay> fuller =
        fullest_way(now, candidate.ways, most, shown(candidate.image, image), candidate.limits,
                    known_faces(candidate), ImageLoss(seen, image, use, context_), context_);
    if (!fuller) continue;
    left -= fuller->bytes - now.bytes;
    numbers[c] = candidate.ways.size();
    candidate.ways.push_back(std::move(*fuller));
  }
}

std::vector<std::size_t> TextureBudget::chosen(double bytes, bool refine, std::optional<int> halvings) {
  const double room = bytes - kept_bytes_;
  Numbers numbers = numbers_within(room, halvings);
  if (refine && !numbers.empty()) {
    double left = room;
    for (std::size_t c = 0; c < candidates_.size(); ++c) left -= candidates_[c].ways[numbers[c]].bytes;
    parallel_for_or_throw(context_, candidates_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c)
        this->refine(candidates_[c], candidates_[c].ways[numbers[c]].bytes + left, halvings);
    });
    numbers = numbers_within(room, halvings);
    fill_up(numbers, room);
  }
  return numbers.empty() && halvings ? std::vector<std::size_t>{} : ways_of(numbers);
}

std::vector<std::size_t> TextureBudget::choose_ways(double bytes, bool refine) {
  return chosen(bytes, refine, {});
}

std::vector<std::size_t> TextureBudget::choose_halved_ways(double bytes, int halvings, bool refine) {
  return chosen(bytes, refine, halvings);
}

std::vector<std::size_t> TextureBudget::ways_of(const Numbers& numbers) const {
  std::vector<std::size_t> ways(limits_.size(), kNoWay);
  for (std::size_t c = 0; c < candidates_.size(); ++c) ways[candidates_[c].image] = numbers[c];
  return ways;
}

std::vector<WantedImage> TextureBudget::choose(double bytes, bool refine) {
  return wanted(choose_ways(bytes, refine));
}

std::vector<WantedImage> TextureBudget::choose_halved(double bytes, int halvings, bool refine) {
  const std::vector<std::size_t> ways = choose_halved_ways(bytes, halvings, refine);
  return ways.empty() ? std::vector<WantedImage>{} : wanted(ways);
}

std::vector<std::optional<ImageOutput>> TextureBudget::encoded_alike(std::span<const Image8> pictures,
                                                                     double psnr_db) const {
  ImageOutputOptions options = options_;
  options.psnr_db = psnr_db;
  std::vector<std::optional<ImageOutput>> outputs(pictures.size());
  parallel_for_or_throw(context_, pictures.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const ImageChange::State& file = files_[candidates_[c].image];
      outputs[c] =
          encode_output(pictures[c], uses_[candidates_[c].image], file.mime_type, file.bytes, options);
    }
  });
  return outputs;
}

std::vector<WantedImage> TextureBudget::choose_alike(double bytes, int halvings) const {
  std::vector<Image8> pictures;
  for (const Candidate& candidate : candidates_) {
    const ImageChange::State& file = files_[candidate.image];
    const ImageUse& use = uses_[candidate.image];
    const int width = std::max(1, file.width >> halvings), height = std::max(1, file.height >> halvings);
    if (width > candidate.limits.width || height > candidate.limits.height) return {};
    pictures.push_back(
        resized_for_way(shown(candidate.image, decoded(candidate.image)), width, height, use, context_));
  }
  std::vector<std::optional<ImageOutput>> best;
  int fits = 0, too_much = kAlikeSteps;
  while (too_much - fits > 1) {
    const int middle = fits + (too_much - fits) / 2;
    std::vector<std::optional<ImageOutput>> outputs =
        encoded_alike(pictures, kLeastAlikeDb + middle * kAlikeStepDb);
    double sum = kept_bytes_;
    for (std::size_t c = 0; c < outputs.size(); ++c) {
      const std::uint64_t file = files_[candidates_[c].image].bytes;
      sum += static_cast<double>(outputs[c] ? outputs[c]->texture.bytes.size() : file);
    }
    (sum <= bytes ? fits : too_much) = middle;
    if (sum <= bytes) best = std::move(outputs);
  }
  if (best.empty()) return {};
  std::vector<WantedImage> images = limits_;
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    if (!best[c]) continue;
    WantedImage& image = images[candidates_[c].image];
    image = {pictures[c].width, pictures[c].height,
             image.psnr_db,     false,
             SizeReason::bytes, FileChoice{best[c]->format, best[c]->texture.quality, false}};
  }
  return images;
}

const TextureBudget::Candidate* TextureBudget::find(std::size_t image) const {
  const auto found = std::ranges::find(candidates_, image, &Candidate::image);
  return found == candidates_.end() ? nullptr : &*found;
}

void TextureBudget::set_weight(std::size_t image, double weight) {
  for (Candidate& candidate : candidates_)
    if (candidate.image == image) candidate.weight = weight;
}

bool TextureBudget::set_color_weight(double weight) {
  std::size_t colors = 0;
  for (Candidate& candidate : candidates_) {
    if (uses_[candidate.image].meaning.kind != TexelMeaning::Kind::color) continue;
    candidate.weight = weight;
    ++colors;
  }
  return colors > 0 && colors < candidates_.size();
}

std::span<const ImageWay> TextureBudget::ways(std::size_t image) const {
  const Candidate* candidate = find(image);
  return candidate == nullptr ? std::span<const ImageWay>() : candidate->ways;
}

double TextureBudget::loss(std::size_t image, const ImageWay& way) const {
  const Candidate* candidate = find(image);
  if (candidate == nullptr) return 0;
  Sums sums(2 * pixels_.size());
  add(sums, *candidate, way);
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

std::vector<std::uint8_t> TextureBudget::encoded(std::size_t image, const ImageWay& way) {
  const EncodedImage& file = model_.images[image];
  if (!way.file) return file.bytes;
  const auto [format, quality, fill] = *way.file;
  const auto [known, is_new] = sized_.try_emplace({image, way.width, way.height, fill});
  if (is_new) {
    const ImageUse& use = uses_[image];
    known->second =
        sized_for_way(shown(image, decoded(image)), way, use, known_faces(*find(image)), context_);
  }
  return encode_texture(known->second, format, quality);
}

}  // namespace fovea
