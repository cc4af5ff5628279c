#include "fovea/texture/within_bytes.h"

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "fovea/texture/image_ways.h"
#include "fovea/texture/seen_points.h"
#include "fovea/texture/texture_budget.h"

namespace fovea {

namespace {

/// What loses up to so many times as much as the best may be the best with finer qualities.
constexpr double kNearLoss = 1.2;
/// How many times more or less what is lost of colours is tried to count.
constexpr double kColorWeight = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TextureBudget texture_budget(const PreparedModel& prepared, std::span<const WantedImage> limits,
                             const ShrinkOptions& options, std::span<const VertexField> field,
                             Context& context) {
  std::vector<double> pixels(kPictureSizes.begin(), kPictureSizes.end());
  if (options.shown_pixels > 0) pixels = sights_of(options.shown_pixels);
  return {prepared.model, prepared.files, prepared.atlases, limits,
          options.output, field,          pixels,           static_cast<double>(*options.max_bytes),
          context};
}

/// The best by pictures of what is tried.
class PictureChoice {
 public:
  using Make = std::function<Shrunk(std::span<const WantedImage>)>;
  PictureChoice(Make make, const ShrinkOptions& options)
      : make_(std::move(make)), lost_(options.lost), most_(static_cast<std::uint64_t>(*options.max_bytes)) {}

  struct Tried {
    double loss = kInfinity;
    std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();
  };
  /// Nothing is tried of no images, and what takes too many bytes is not taken but for want of anything else.
  Tried consider(std::span<const WantedImage> wanted) {
    if (wanted.empty()) return {};
    Shrunk made = make_(wanted);
    const bool is_first = least_ == kInfinity;
    if (!lost_ || made.bytes > most_) {
      if (is_first) best_ = std::move(made);
      return {};
    }
    const Tried tried{lost_(made.model), made.bytes};
    if (is_first || tried.loss < least_) best_ = std::move(made);
    least_ = std::min(least_, tried.loss);
    return tried;
  }

  double least() const { return least_; }
  Shrunk take() { return std::move(best_); }

 private:
  Make make_;
  const std::function<double(const Model&)>& lost_;
  std::uint64_t most_;
  Shrunk best_;
  double least_ = kInfinity;
};

Shrunk resized_within_bytes(const PreparedModel& prepared, std::span<const WantedImage> limits,
                            const ShrinkOptions& options, std::span<const VertexField> field,
                            Context& context) {
  const auto most = static_cast<double>(*options.max_bytes);
  TextureBudget budget = texture_budget(prepared, limits, options, field, context);
  PictureChoice choice(
      [&](std::span<const WantedImage> wanted) {
        return with_images(prepared, wanted, options, field, context);
      },
      options);
  const PictureChoice::Tried first = choice.consider(budget.choose(most, true));
  if (first.loss == kInfinity || first.loss == 0) return choice.take();
  // Whether sides are halved, and how often; and what colours count.
  std::optional<int> halvings, nearest;
  double weight = 1, least_halved = kInfinity;
  for (int times = 0; times <= kMostHalvings; ++times) {
    const PictureChoice::Tried tried = choice.consider(budget.choose_halved(most, times, false));
    if (tried.loss < least_halved) nearest = times;
    least_halved = std::min(tried.loss, least_halved);
    if (static_cast<double>(tried.bytes) < most / 2) break;  // fewer texels only lose more
  }
  if (least_halved < kNearLoss * choice.least()) halvings = nearest;
  const auto chosen = [&](bool refine) {
    return halvings ? budget.choose_halved(most, *halvings, refine) : budget.choose(most, refine);
  };
  for (const double tried : {kColorWeight, 1 / kColorWeight}) {
    const double before = choice.least();
    if (!budget.set_color_weight(tried)) break;
    choice.consider(chosen(false));
    if (choice.least() == before) continue;
    weight = tried;
    break;  // there is nothing on the other side then
  }
  budget.set_color_weight(weight);
  if (halvings || weight != 1) choice.consider(chosen(true));
  if (nearest) choice.consider(budget.choose_alike(most, *nearest));
  return choice.take();
}

/// First bakes images anew, at their own sizes and without loss.
Shrunk rebaked_within_bytes(PreparedModel prepared, std::vector<WantedImage> limits, ShrinkOptions options,
                            std::span<const VertexField> field, Context& context) {
  std::vector<WantedImage> whole;
  for (const ImageChange::State& file : prepared.files)
    whole.push_back({file.width, file.height, 0, true, SizeReason::none, FileChoice{}});
  PreparedModel grown = prepared;
  for (ImageChange::State& file : grown.files) file.bytes = std::numeric_limits<std::uint64_t>::max();
  Shrunk baked = with_images(grown, whole, options, field, context);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    if (baked.model.images[i] != prepared.model.images[i]) limits[i].stays = false;
  }
  const std::vector<EncodedImage> files = std::move(prepared.model.images);
  prepared.model = std::move(baked.model);
  options.rebake = {};
  Shrunk result = resized_within_bytes(prepared, limits, options, field, context);
  result.atlases = std::move(baked.atlases);
  // Where nothing is smaller than the file was, that stays.
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::vector<std::uint8_t>& bytes = result.model.images[i].bytes;
    if (bytes.size() <= prepared.files[i].bytes) continue;
    result.bytes -= bytes.size() - files[i].bytes.size();
    result.model.images[i] = files[i];
  }
  return result;
}

}  // namespace

Shrunk within_bytes(const PreparedModel& prepared, std::span<const WantedImage> limits,
                    const ShrinkOptions& options, std::span<const VertexField> field, Context& context) {
  return options.rebake.original == nullptr
             ? resized_within_bytes(prepared, limits, options, field, context)
             : rebaked_within_bytes(prepared, {limits.begin(), limits.end()}, options, field, context);
}

}  // namespace fovea
