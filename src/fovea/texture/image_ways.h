#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/image_loss.h"
#include "fovea/texture/image_output.h"
#include "fovea/texture/image_use.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// No image gets smaller than so many halves of what it was.
inline constexpr int kMostHalvings = 5;

/// A way to store an image.
struct ImageWay {
  int width = 0, height = 0;
  std::optional<FileChoice> file;  ///< None for the file as it is.
  double bytes = 0;
  std::vector<double> losses;  ///< [#pixels of the sights] What pictures lose by it (`ImageLoss`).
};

/// What an image is, and what it may become.
struct ImageLimits {
  ImageUse use;
  TextureFormat format = TextureFormat::png;
  int width = 0, height = 0;  ///< At most.
  double most_bytes = 0;      ///< No file takes as much.
};

/// `resized`, as the images of ways are: by way of a quarter of the sides where an eighth or less is left,
/// which saves most of the time and loses nothing that is seen.
Image8 resized_for_way(const Image8& image, int width, int height, const ImageUse& use,
                       const Context& context);

/// Encodes an image at its limit and at the halves of its own size down to 1/32, which pictures see nearly as
/// they see the image itself, as GPUs make the same copies of it (at 1/√2 pictures lost 10 dB more of
/// BoomBox's colours than at 1/2), or of PNG, which has no quality, at four sizes for each half, at several
/// qualities, to see what that takes and what pictures lose: as it is, and filled between the triangles that
/// show it, `faces` (all of them, or none if not all are known); large ones only in that of the two ways that
/// did better with a small one, unless the other loses clearly less by its size. WebP without loss, too (of
/// more than 512² texels up to 1024² only if the file may take a third of a byte for each), and if it has no
/// alpha as JPEG. There is always one way at least, the smallest image of the lowest quality, though it may
/// take more bytes than it should.
///
/// Small sizes first, and none larger than the first of which all files take too much: the time goes with
/// `most_bytes`. Throws Error(cancelled).
std::vector<ImageWay> image_ways(const Image8& image, const ImageLimits& limits,
                                 std::span<const AtlasFace> faces, const ImageLoss& loss,
                                 const Context& context);

/// The image that one of them encodes.
Image8 sized_for_way(Image8 image, const ImageWay& way, const ImageUse& use, std::span<const AtlasFace> faces,
                     const Context& context);

/// More ways: of qualities near those of the three best that take no more than so many bytes, each of another
/// size, format or filling.
std::vector<ImageWay> finer_ways(std::span<const ImageWay> ways, double bytes, const Image8& image,
                                 const ImageLimits& limits, std::span<const AtlasFace> faces,
                                 const ImageLoss& loss, const Context& context);

/// The same size, format and filling as `way`, of the highest quality that takes no more than so many bytes;
/// none if `way` has that already, or no quality. `ways` are known.
std::optional<ImageWay> fullest_way(const ImageWay& way, std::span<const ImageWay> ways, double bytes,
                                    const Image8& image, const ImageLimits& limits,
                                    std::span<const AtlasFace> faces, const ImageLoss& loss,
                                    const Context& context);

}  // namespace fovea
