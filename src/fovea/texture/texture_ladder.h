#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/texture/image_output.h"

namespace fovea {

struct ImageViewers;  // image_viewers.h, inside Fovea

struct TextureLadderOptions {
  ImageOutputOptions output;
  double shown_pixels = 512;              ///< How long the model is in pictures.
  std::uint64_t most_bytes = 0;           ///< No file that takes more will be asked for; 0 for any.
  const ImageViewers* viewers = nullptr;  ///< Who looks, if not all from around; must outlive the ladders.
};

/// One of the ways to store an image: none takes as little and loses as little.
struct TextureRung {
  std::uint64_t bytes = 0;
  double loss = 0;      ///< Mean squared difference on the surface that shows it, estimated; 0 … 1.
  std::size_t way = 0;  ///< Its number, for `TextureLadders::stored`.
};

/// The images of a model in less and less bytes: halves of their sides (of PNG, which has no quality, also
/// sizes between) at many qualities, filled between their charts or as they are. What each takes and what
/// pictures lose by it is measured once (image_ways.h).
///
/// Not for images that materials read in different ways, that nothing uses, or that cannot be decoded: they
/// stay as they are.
class TextureLadders {
 public:
  static constexpr std::size_t kAsItIs = static_cast<std::size_t>(-1);

  /// `model` and `context` must outlive this. Seconds for large images; memory for a few of them decoded.
  /// Throws Error(usage) for options out of range, Error(cancelled).
  TextureLadders(const Model& model, const TextureLadderOptions& options, Context& context);
  ~TextureLadders();

  /// [#images] From the file as it is (`kAsItIs`) down: bytes fall from rung to rung, and each costs more
  /// loss for a byte than the one before. One rung where nothing is smaller.
  const std::vector<std::vector<TextureRung>>& rungs() const;

  /// [#images] The ways that lose least of what takes no more than so many bytes together, or the fewest
  /// bytes there are. With `refine` more qualities are tried near them: some seconds for large images.
  std::vector<std::size_t> within(std::uint64_t bytes, bool refine);
  /// The same of ways that all have the images' own sides halved so many times; empty if some do not come so.
  std::vector<std::size_t> halved(std::uint64_t bytes, int halvings);
  /// From now on what is lost of an image counts so many times: estimates do not know what lit pictures make
  /// of it.
  void set_weight(std::size_t image, double weight);
  /// So many bytes together spent from given ways [#images] on: again and again on the image that gains most.
  std::vector<std::size_t> filled(std::vector<std::size_t> ways, std::uint64_t bytes) const;

  /// What the file of one takes.
  std::uint64_t bytes(std::size_t image, std::size_t way) const;
  /// An image stored in one of its ways. Each is encoded once.
  const EncodedImage& stored(std::size_t image, std::size_t way);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fovea
