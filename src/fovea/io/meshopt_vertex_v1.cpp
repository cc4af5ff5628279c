#include "fovea/io/meshopt_vertex_v1.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

namespace fovea::gltf {

namespace {

constexpr std::size_t kGroup = 16;
constexpr std::size_t kMaxBlockBytes = 8192;
constexpr std::size_t kMaxBlock = 256;
constexpr std::size_t kMinTail = 24;

/// How the deltas of one byte position are stored in a block.
enum Control { kShortBits = 0, kLongBits = 1, kZero = 2, kLiteral = 3 };
/// How bytes become values, four at a time.
enum Channel { kBytes = 0, kWords = 1, kXor = 2 };

template <class Unsigned>
Unsigned unzigzag(Unsigned v) {
  return static_cast<Unsigned>(v & 1 ? ~(v >> 1) : v >> 1);
}

std::uint8_t number_of(std::byte b) { return std::to_integer<std::uint8_t>(b); }

/// Reads a stream from its front; running dry is remembered and gives zeros.
class Source {
 public:
  explicit Source(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::span<const std::byte> take(std::size_t count) {
    static constexpr std::array<std::byte, kMaxBlock> kZeros{};
    if (count > bytes_.size()) {
      dry_ = true;
      bytes_ = {};
      return std::span(kZeros).first(count);
    }
    const auto taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  bool dry() const { return dry_; }
  bool empty() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
  bool dry_ = false;
};

class BlockDecoder {
 public:
  BlockDecoder(Source& source, std::size_t stride, std::span<const std::byte> baseline,
               std::span<const std::byte> channels)
      : source_(source), stride_(stride), channels_(channels) {
    std::copy(baseline.begin(), baseline.end(), last_.begin());
  }

  void decode(std::size_t count, std::byte* out) {
    read_deltas(count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < stride_; k += 4) advance(k, i);
      std::copy_n(last_.begin(), stride_, out + i * stride_);
    }
  }

 private:
  std::uint8_t delta(std::size_t byte, std::size_t element) const {
    return deltas_[byte * kMaxBlock + element];
  }

  void read_deltas(std::size_t count) {
    const auto controls = source_.take(stride_ / 4);
    for (std::size_t k = 0; k < stride_; ++k) {
      const int control = number_of(controls[k / 4]) >> (k % 4 * 2) & 3;
      std::uint8_t* to = &deltas_[k * kMaxBlock];
      if (control == kZero) {
        std::fill_n(to, count, std::uint8_t{0});
      } else if (control == kLiteral) {
        std::memcpy(to, source_.take(count).data(), count);
      } else {
        read_groups(control, (count + kGroup - 1) / kGroup, to);
      }
    }
  }

  void read_groups(int control, std::size_t groups, std::uint8_t* to) {
    static constexpr int kBits[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
    const auto header = source_.take((groups + 3) / 4);
    for (std::size_t g = 0; g < groups; ++g, to += kGroup) {
      read_group(kBits[control][number_of(header[g / 4]) >> (g % 4 * 2) & 3], to);
    }
  }

  /// Sixteen deltas of `bits` each; all ones mean that a whole byte follows the group.
  void read_group(int bits, std::uint8_t* to) {
    if (bits == 0) {
      std::fill_n(to, kGroup, std::uint8_t{0});
      return;
    }
    const auto packed = source_.take(kGroup * static_cast<std::size_t>(bits) / 8);
    const std::size_t per_byte = 8 / static_cast<std::size_t>(bits);
    const int sentinel = (1 << bits) - 1;
    for (std::size_t i = 0; i < kGroup; ++i) {
      // Single bits are stored from the lowest up, wider ones from the highest down.
      const std::size_t slot = bits == 1 ? i % per_byte : per_byte - 1 - i % per_byte;
      const int value = number_of(packed[i / per_byte]) >> (slot * static_cast<std::size_t>(bits)) & sentinel;
      to[i] =
          bits < 8 && value == sentinel ? number_of(source_.take(1)[0]) : static_cast<std::uint8_t>(value);
    }
  }

  /// Takes bytes k … k + 3 of the element before to those of element i.
  void advance(std::size_t k, std::size_t i) {
    const std::uint8_t channel = number_of(channels_[k / 4]);
    if (channel == kBytes) {
      for (std::size_t b = k; b < k + 4; ++b) {
        last_[b] = static_cast<std::byte>(number_of(last_[b]) + unzigzag(delta(b, i)));
      }
    } else if (channel == kWords) {
      for (std::size_t b = k; b < k + 4; b += 2) {
        const auto step = unzigzag(static_cast<std::uint16_t>(delta(b, i) | delta(b + 1, i) << 8));
        const unsigned value = number_of(last_[b]) + 256u * number_of(last_[b + 1]) + step;
        last_[b] = static_cast<std::byte>(value);
        last_[b + 1] = static_cast<std::byte>(value >> 8);
      }
    } else {
      std::uint32_t step = 0;
      for (std::size_t b = 0; b < 4; ++b) step |= static_cast<std::uint32_t>(delta(k + b, i)) << (8 * b);
      step = std::rotr(step, channel >> 4);
      for (std::size_t b = 0; b < 4; ++b) last_[k + b] ^= static_cast<std::byte>(step >> (8 * b));
    }
  }

  Source& source_;
  std::size_t stride_;
  std::span<const std::byte> channels_;
  std::array<std::byte, 256> last_{};                                                  // the element before
  std::vector<std::uint8_t> deltas_ = std::vector<std::uint8_t>(stride_ * kMaxBlock);  // [stride × kMaxBlock]
};

bool are_valid(std::span<const std::byte> channels) {
  return std::all_of(channels.begin(), channels.end(), [](std::byte c) {
    return number_of(c) == kBytes || number_of(c) == kWords || (number_of(c) & 15) == kXor;
  });
}

}  // namespace

std::size_t vertex_block_size(std::size_t stride) {
  return std::min(kMaxBlockBytes / stride / kGroup * kGroup, kMaxBlock);
}

bool decode_vertices_v1(std::span<const std::byte> stream, std::size_t count, std::size_t stride,
                        std::byte* out) {
  const std::size_t tail = stride + stride / 4;
  const std::size_t padded_tail = std::max(tail, kMinTail);
  if (stream.size() < 1 + padded_tail || number_of(stream[0]) != 0xA1) return false;
  const auto baseline = stream.last(tail).first(stride);
  const auto channels = stream.last(stride / 4);
  if (!are_valid(channels)) return false;
  Source source(stream.subspan(1, stream.size() - 1 - padded_tail));
  BlockDecoder decoder(source, stride, baseline, channels);
  const std::size_t block = vertex_block_size(stride);
  for (std::size_t i = 0; i < count && !source.dry(); i += block) {
    decoder.decode(std::min(block, count - i), out + i * stride);
  }
  return !source.dry() && source.empty();
}

}  // namespace fovea::gltf
