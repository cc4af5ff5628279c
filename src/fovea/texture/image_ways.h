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

/// A way to store an image.
struct ImageWay {
  int width = 0, height = 0;
  std::optional<FileChoice> file;  ///< None for the file as it is.
  double psnr_db = 0;              ///< Of the encoding.
  double bytes = 0;
  std::vector<double> losses;  ///< What pictures lose by it (`ImageLoss`).
};

/// What an image is, and what it may become.
struct ImageLimits {
  ImageUse use;
  TextureFormat format = TextureFormat::png;
  int width = 0, height = 0;  ///< At most,
  int half_octaves = 0;       ///< and each size 1/√2 of the one before, so many times.
  double most_bytes = 0;      ///< No file takes as much.
};

/// Encodes an image of each size, and at several qualities, to see what that takes and what pictures lose:
/// as it is, and from where it is filled between the triangles that show it, `faces` (all of them, or none
/// if not all are known). WebP without alpha as JPEG too. There is always one at least, the smallest image
/// of the lowest quality, though it may take more bytes than it should.
///
/// Small sizes first, and none larger than the first of which all files take too much: the time goes with
/// `most_bytes`. All in memory at once. Throws Error(cancelled).
std::vector<ImageWay> image_ways(const Image8& image, const ImageLimits& limits,
                                 std::span<const AtlasFace> faces, const ImageLoss& loss,
                                 const Context& context);

/// More ways: of qualities near those of the three best that take no more than so many bytes, each of another
/// size, format or filling.
std::vector<ImageWay> finer_ways(std::span<const ImageWay> ways, double bytes, const Image8& image,
                                 const ImageLimits& limits, std::span<const AtlasFace> faces,
                                 const ImageLoss& loss, const Context& context);

}  // namespace fovea
