#include "fovea/texture/fill.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

#include "fovea/base/parallel.h"

namespace fovea {

namespace {

/// Texels that a drawn area grows by before averages of larger squares take over, which know little of its
/// border.
constexpr int kRings = 8;

/// An image and which of its texels are known.
struct Level {
  Image8 image;
  std::vector<std::uint8_t> known;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
  }
};

constexpr int kMostChannels = 4;
/// Of texels that have a value, and of those that get one next.
constexpr std::uint8_t kKnown = 1, kMarked = 2;

template <class Row>
void over_rows(int height, const Context& context, const Row& row) {
  constexpr std::size_t kGrain = 64;
  parallel_for_or_throw(context, static_cast<std::size_t>(height), kGrain,
                        [&](std::size_t begin, std::size_t end) {
                          for (std::size_t y = begin; y < end; ++y) row(static_cast<int>(y));
                        });
}

/// Half the size: averages of what is known, 0 or 1, of 2 × 2 texels.
template <std::size_t Channels>
void push(const Image8& image, std::span<const std::uint8_t> known, Level& half, const Context& context) {
  over_rows(half.image.height, context, [&](int y) {
    const auto width = static_cast<std::size_t>(image.width);
    // Beyond the last row or column there is nothing, so that it stands for itself with no weight.
    const bool is_last = 2 * y + 1 == image.height;
    const std::size_t above = static_cast<std::size_t>(2 * y) * width,
                      below = is_last ? above : above + width;
    std::uint8_t* out = half.image.at(0, y);
    for (std::size_t x = 0; x < static_cast<std::size_t>(half.image.width); ++x, out += Channels) {
      const std::size_t left = 2 * x, right = std::min(left + 1, width - 1);
      const std::array<std::size_t, 4> texels{above + left, above + right, below + left, below + right};
      const std::array<unsigned, 4> weights{known[texels[0]], right > left ? known[texels[1]] : 0u,
                                            is_last ? 0u : known[texels[2]],
                                            right > left && !is_last ? known[texels[3]] : 0u};
      const unsigned count = weights[0] + weights[1] + weights[2] + weights[3];
      if (count == 0) continue;
      half.known[half.index(static_cast<int>(x), y)] = 1;
      for (std::size_t k = 0; k < Channels; ++k) {
        unsigned sum = count / 2;  // rounds
        for (std::size_t i = 0; i < 4; ++i) sum += weights[i] * image.pixels[texels[i] * Channels + k];
        out[k] = static_cast<std::uint8_t>(count == 4 ? sum / 4 : sum / count);
      }
    }
  });
}

Level pushed(const Image8& image, std::span<const std::uint8_t> known, const Context& context) {
  Level half{Image8((image.width + 1) / 2, (image.height + 1) / 2, image.channels, image.encoding), {}};
  half.known.resize(half.index(0, half.image.height), 0);
  constexpr std::array kPush{push<1>, push<2>, push<3>, push<kMostChannels>};
  kPush[static_cast<std::size_t>(image.channels) - 1](image, known, half, context);
  return half;
}

/// What is not known is mixed from the four nearest texels of half the size, which are all there.
void pull(Image8& image, std::span<const std::uint8_t> known, const Image8& half, const Context& context) {
  over_rows(image.height, context, [&](int y) {
    const int row = y / 2, other_row = std::clamp(row + (y % 2 == 0 ? -1 : 1), 0, half.height - 1);
    for (int x = 0; x < image.width; ++x) {
      if (known[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                static_cast<std::size_t>(x)] != 0)
        continue;
      const int column = x / 2, other_column = std::clamp(column + (x % 2 == 0 ? -1 : 1), 0, half.width - 1);
      const std::uint8_t *a = half.at(column, row), *b = half.at(other_column, row),
                         *c = half.at(column, other_row), *d = half.at(other_column, other_row);
      std::uint8_t* out = image.at(x, y);
      for (int k = 0; k < image.channels; ++k)
        out[k] = static_cast<std::uint8_t>((9 * a[k] + 3 * b[k] + 3 * c[k] + d[k] + 8) / 16);
    }
  });
}

void fill(Image8& image, std::span<const std::uint8_t> known, const Context& context) {
  if (std::ranges::find(known, 0) == known.end() || (image.width == 1 && image.height == 1)) return;
  Level half = pushed(image, known, context);
  fill(half.image, half.known, context);
  pull(image, known, half.image, context);
}

/// Calls f(index) for a texel and the eight around it, as many as there are.
template <class F>
void for_around(const Image8& image, std::size_t texel, F&& f) {
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  const std::size_t x = texel % width, y = texel / width;
  for (std::size_t j = y > 0 ? y - 1 : 0; j <= std::min(y + 1, height - 1); ++j)
    for (std::size_t i = x > 0 ? x - 1 : 0; i <= std::min(x + 1, width - 1); ++i) f(j * width + i);
}

/// The texels beside those that are known.
std::vector<std::size_t> border(const Image8& image, std::span<const std::uint8_t> known,
                                const Context& context) {
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<std::vector<std::size_t>> rows(static_cast<std::size_t>(image.height));
  over_rows(image.height, context, [&](int y) {
    const auto row = static_cast<std::size_t>(y);
    for (std::size_t t = row * width; t < (row + 1) * width; ++t) {
      if (known[t] != 0) continue;
      bool is_beside = false;
      for_around(image, t, [&](std::size_t n) { is_beside = is_beside || known[n] != 0; });
      if (is_beside) rows[row].push_back(t);
    }
  });
  std::vector<std::size_t> found;
  for (const std::vector<std::size_t>& row : rows) found.insert(found.end(), row.begin(), row.end());
  return found;
}

/// Gives each of `texels` of all images the mean of the known ones around it, nearer ones twice.
void give_means(std::span<Image8> images, std::span<const std::size_t> texels,
                std::span<const std::uint8_t> known, const Context& context) {
  constexpr std::size_t kGrain = 4096;
  struct Neighbour {
    std::size_t texel;
    int weight;
  };
  const auto width = static_cast<std::size_t>(images[0].width);
  const auto give = [&](std::size_t t) {
    std::array<Neighbour, 8> around;
    std::size_t count = 0;
    int weights = 0;
    for_around(images[0], t, [&](std::size_t n) {
      if (known[n] != kKnown) return;
      around[count] = {n, n % width == t % width || n / width == t / width ? 2 : 1};
      weights += around[count++].weight;
    });
    for (Image8& image : images) {
      assert(image.channels <= kMostChannels);
      const auto channels = static_cast<std::size_t>(image.channels);
      for (std::size_t k = 0; k < channels; ++k) {
        int sum = weights / 2;  // rounds
        for (std::size_t i = 0; i < count; ++i)
          sum += around[i].weight * image.pixels[around[i].texel * channels + k];
        image.pixels[t * channels + k] = static_cast<std::uint8_t>(sum / weights);
      }
    }
  };
  parallel_for_or_throw(context, texels.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) give(texels[i]);
  });
}

/// The texels beside `ring` that are not known, each once; they are marked.
std::vector<std::size_t> next_ring(const Image8& image, std::span<const std::size_t> ring,
                                   std::vector<std::uint8_t>& known) {
  std::vector<std::size_t> next;
  for (const std::size_t t : ring) {
    for_around(image, t, [&](std::size_t n) {
      if (known[n] != 0) return;
      known[n] = kMarked;
      next.push_back(n);
    });
  }
  return next;
}

}  // namespace

void grow_drawn(std::span<std::uint8_t> drawn, int width, int height, const Context& context) {
  const Image8 shape(width, height, 1, ColorEncoding::linear);
  for (const std::size_t t : border(shape, drawn, context)) drawn[t] = 1;
}

void fill_undrawn(std::span<Image8> images, std::span<const std::uint8_t> drawn, const Context& context) {
  std::vector<std::uint8_t> known(drawn.size());
  for (std::size_t t = 0; t < drawn.size(); ++t) known[t] = drawn[t] != 0 ? kKnown : 0;
  std::vector<std::size_t> ring = border(images[0], known, context);
  if (ring.empty()) return;
  for (int i = 0; i < kRings && !ring.empty(); ++i) {
    give_means(images, ring, known, context);
    for (const std::size_t t : ring) known[t] = kKnown;
    if (i + 1 < kRings) ring = next_ring(images[0], ring, known);
  }
  for (Image8& image : images) fill(image, known, context);
}

}  // namespace fovea
