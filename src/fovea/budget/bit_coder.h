#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "fovea/base/error.h"

// Private to budget.

namespace fovea {

/// How likely a bit is to be 0, learned from those that came before: fast at first, slower later.
class BitModel {
 public:
  /// In 65536ths, never certain.
  std::uint32_t zero() const { return zero_; }
  void learn(bool bit) {
    constexpr int kSlowest = 6;
    const int rate = std::min(count_ + 1, kSlowest);
    if (count_ < kSlowest) ++count_;
    const std::uint32_t target = bit ? kLeast : kOne - kLeast;
    zero_ = target > zero_ ? zero_ + ((target - zero_) >> rate) : zero_ - ((zero_ - target) >> rate);
  }

 private:
  static constexpr std::uint32_t kOne = 1u << 16, kLeast = 1u << 5;
  std::uint32_t zero_ = kOne / 2;
  int count_ = 0;
};

/// Writes bits in as many bits as their models say (range coder after Martin 1979, with carries as in LZMA).
class BitWriter {
 public:
  static constexpr bool kWrites = true;

  void bit(BitModel& model, bool& bit) {
    const std::uint32_t bound = (range_ >> 16) * model.zero();
    if (bit) {
      low_ += bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model.learn(bit);
    normalize();
  }
  /// One of which nothing is known.
  void plain_bit(bool& bit) {
    range_ >>= 1;
    if (bit) low_ += range_;
    normalize();
  }
  std::vector<std::uint8_t> finish() {
    for (int i = 0; i < 5; ++i) shift();
    bytes_.erase(bytes_.begin());  // is always 0
    return std::move(bytes_);
  }

 private:
  void normalize() {
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      shift();
    }
  }
  void shift() {
    if (low_ < 0xFF000000u || low_ > 0xFFFFFFFFu) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32);
      bytes_.push_back(static_cast<std::uint8_t>(held_ + carry));
      for (; waiting_ > 0; --waiting_) bytes_.push_back(static_cast<std::uint8_t>(0xFF + carry));
      held_ = static_cast<std::uint8_t>(low_ >> 24);
    } else {
      ++waiting_;
    }
    low_ = (low_ & 0x00FFFFFFu) << 8;
  }

  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
  std::uint8_t held_ = 0;  // waits with so many bytes 0xFF for a carry
  std::size_t waiting_ = 0;
  std::vector<std::uint8_t> bytes_;
};

/// Reads what BitWriter wrote, with the same models, to its last byte. Throws Error(format) for less.
class BitReader {
 public:
  static constexpr bool kWrites = false;

  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
  }
  void bit(BitModel& model, bool& bit) {
    const std::uint32_t bound = (range_ >> 16) * model.zero();
    bit = code_ >= bound;
    if (bit) {
      code_ -= bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model.learn(bit);
    normalize();
  }
  void plain_bit(bool& bit) {
    range_ >>= 1;
    bit = code_ >= range_;
    if (bit) code_ -= range_;
    normalize();
  }
  bool is_at_end() const { return at_ == bytes_.size(); }

 private:
  void normalize() {
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
  }
  std::uint32_t next() {
    if (at_ == bytes_.size()) throw Error(ErrorKind::format, "the code ends early");
    return bytes_[at_++];
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::uint32_t code_ = 0, range_ = 0xFFFFFFFFu;
};

/// A whole number from 0 on: as many models as it takes bits in unary up to `kUnary`, then its Exp-Golomb
/// code.
class NumberModel {
 public:
  template <class Io>
  void code(Io& io, std::uint32_t& number) {
    std::uint32_t count = 0;
    for (; count < kUnary; ++count) {
      bool more = number > count;
      io.bit(unary_[count], more);
      if (!more) break;
    }
    if (count < kUnary) {
      number = count;
      return;
    }
    std::uint32_t rest = number - kUnary + 1;  // 1 or more, when writing
    std::uint32_t bits = Io::kWrites ? static_cast<std::uint32_t>(std::bit_width(rest)) : 0u;
    std::uint32_t width = 1;
    for (; width < kMostBits; ++width) {
      bool more = bits > width;
      io.bit(width_[width], more);
      if (!more) break;
    }
    if constexpr (!Io::kWrites) rest = 1;
    for (std::uint32_t i = width - 1; i-- > 0;) {
      bool set = (rest >> i & 1u) != 0;
      io.plain_bit(set);
      if constexpr (!Io::kWrites) rest = rest << 1 | (set ? 1u : 0u);
    }
    number = rest - 1 + kUnary;
  }

 private:
  static constexpr std::uint32_t kUnary = 12, kMostBits = 30;
  BitModel unary_[kUnary], width_[kMostBits];
};

}  // namespace fovea
