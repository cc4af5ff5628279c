#include "fovea/texture/texture_ladder.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/texture/size_ladder.h"
#include "fovea/texture/texture_budget.h"

namespace fovea {

namespace {

std::vector<ImageChange::State> states_of(const Model& model) {
  std::vector<ImageChange::State> states;
  for (const EncodedImage& image : model.images) states.push_back(state_of(image));
  return states;
}

/// All of their own sides, and as they are if that may be.
std::vector<WantedImage> limits_of(std::span<const ImageChange::State> states,
                                   const ImageOutputOptions& output) {
  std::vector<WantedImage> limits;
  for (const ImageChange::State& state : states)
    limits.push_back({std::max(1, state.width), std::max(1, state.height), output.psnr_db,
                      keeps_format(state.mime_type, output)});
  return limits;
}

}  // namespace

struct TextureLadders::State {
  State(const Model& shown, const TextureLadderOptions& options, Context& context)
      : model(shown),
        files(states_of(model)),
        atlases(find_atlases(model)),
        budget(model, files, atlases, limits_of(files, options.output), options.output, {},
               options.viewers != nullptr ? std::vector<double>{1} : sights_of(options.shown_pixels),
               options.most_bytes > 0 ? static_cast<double>(options.most_bytes)
                                      : std::numeric_limits<double>::max(),
               context, options.viewers) {
    for (std::size_t i = 0; i < model.images.size(); ++i) rungs.push_back(rungs_of(i));
  }

  std::vector<TextureRung> rungs_of(std::size_t image) const {
    const std::uint64_t whole = files[image].bytes;
    std::vector<LadderStep> steps{{kAsItIs, static_cast<double>(whole), 0}};
    const std::span<const ImageWay> ways = budget.ways(image);
    for (std::size_t w = 0; w < ways.size(); ++w)
      if (ways[w].file) steps.push_back({w, ways[w].bytes, budget.loss(image, ways[w])});
    std::vector<TextureRung> found;
    for (const LadderStep& step : lower_hull(std::move(steps)))
      found.push_back({static_cast<std::uint64_t>(step.bytes), step.loss, step.number});
    return found;
  }

  /// The ways that leave a file as it is, named so.
  std::vector<std::size_t> with_files(std::vector<std::size_t> ways) const {
    for (std::size_t i = 0; i < ways.size(); ++i)
      if (ways[i] != TextureBudget::kNoWay && !budget.ways(i)[ways[i]].file) ways[i] = kAsItIs;
    return ways;
  }

  const Model& model;
  std::vector<ImageChange::State> files;
  std::vector<Atlas> atlases;
  TextureBudget budget;  // refers to the others
  std::vector<std::vector<TextureRung>> rungs;
  std::map<std::pair<std::size_t, std::size_t>, EncodedImage> known;
};

TextureLadders::TextureLadders(const Model& model, const TextureLadderOptions& options, Context& context) {
  if (!(options.shown_pixels > 0))
    throw Error(ErrorKind::usage, "pictures that textures are seen in have some pixels");
  state_ = std::make_unique<State>(model, options, context);
}

TextureLadders::~TextureLadders() = default;

const std::vector<std::vector<TextureRung>>& TextureLadders::rungs() const { return state_->rungs; }

std::vector<std::size_t> TextureLadders::within(std::uint64_t bytes, bool refine) {
  return state_->with_files(state_->budget.choose_ways(static_cast<double>(bytes), refine));
}

std::vector<std::size_t> TextureLadders::halved(std::uint64_t bytes, int halvings) {
  return state_->with_files(state_->budget.choose_halved_ways(static_cast<double>(bytes), halvings, false));
}

void TextureLadders::set_weight(std::size_t image, double weight) {
  state_->budget.set_weight(image, weight);
}

std::vector<std::size_t> TextureLadders::filled(std::vector<std::size_t> ways, std::uint64_t bytes) const {
  std::vector<std::vector<LadderStep>> steps;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    // The file as it is comes last, so that ways keep their numbers.
    std::vector<LadderStep>& own = steps.emplace_back();
    const std::span<const ImageWay> known = state_->budget.ways(i);
    for (std::size_t w = 0; w < known.size(); ++w)
      own.push_back({known[w].file ? w : kAsItIs, known[w].bytes, state_->budget.loss(i, known[w])});
    own.push_back({kAsItIs, static_cast<double>(state_->files[i].bytes), 0});
    if (ways[i] == kAsItIs) ways[i] = own.size() - 1;
  }
  fill_room(steps, static_cast<double>(bytes), ways);
  for (std::size_t i = 0; i < ways.size(); ++i) ways[i] = steps[i][ways[i]].number;
  return ways;
}

std::uint64_t TextureLadders::bytes(std::size_t image, std::size_t way) const {
  return way == kAsItIs ? state_->files[image].bytes
                        : static_cast<std::uint64_t>(state_->budget.ways(image)[way].bytes);
}

const EncodedImage& TextureLadders::stored(std::size_t image, std::size_t way) {
  if (way == kAsItIs) return state_->model.images[image];
  const auto [at, is_new] = state_->known.try_emplace({image, way});
  if (is_new) {
    const ImageWay& stored = state_->budget.ways(image)[way];
    at->second = state_->model.images[image];
    at->second.bytes = state_->budget.encoded(image, stored);
    at->second.mime_type = mime_type(stored.file->format);
  }
  return at->second;
}

}  // namespace fovea
