#include "fovea/model/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace fovea {

namespace {

/// Calls `f` with a value of the C++ type that `type` stands for.
template <class F>
auto with_type(ComponentType type, F&& f) {
  switch (type) {
    case ComponentType::i8: return f(std::int8_t{});
    case ComponentType::u8: return f(std::uint8_t{});
    case ComponentType::i16: return f(std::int16_t{});
    case ComponentType::u16: return f(std::uint16_t{});
    case ComponentType::u32: return f(std::uint32_t{});
    case ComponentType::f32: break;
  }
  return f(float{});
}

}  // namespace

std::size_t size_of(ComponentType type) {
  return with_type(type, [](auto zero) { return sizeof(zero); });
}

float decode_component(double raw, Storage storage) {
  if (!storage.normalized || storage.type == ComponentType::f32) return static_cast<float>(raw);
  return with_type(storage.type, [&](auto zero) {
    const double top = static_cast<double>(std::numeric_limits<decltype(zero)>::max());
    return static_cast<float>(std::max(raw / top, -1.0));
  });
}

double encode_component(float value, Storage storage) {
  if (storage.type == ComponentType::f32) return value;
  if (std::isnan(value)) return 0;
  return with_type(storage.type, [&](auto zero) {
    using Limits = std::numeric_limits<decltype(zero)>;
    const double top = static_cast<double>(Limits::max());
    const double bottom =
        storage.normalized && Limits::is_signed ? -top : static_cast<double>(Limits::lowest());
    const double scaled = storage.normalized ? value * top : static_cast<double>(value);
    return std::clamp(std::round(scaled), bottom, top);
  });
}

std::vector<float> Accessor::to_floats() const {
  std::vector<float> values(count * static_cast<std::size_t>(width));
  with_type(storage.type, [&](auto zero) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      auto raw = zero;
      std::memcpy(&raw, bytes.data() + i * sizeof(raw), sizeof(raw));
      values[i] = decode_component(static_cast<double>(raw), storage);
    }
  });
  return values;
}

Accessor Accessor::from_floats(const std::vector<float>& values, int width, Storage storage) {
  Accessor a;
  a.storage = storage;
  a.width = width;
  a.count = values.size() / static_cast<std::size_t>(width);
  a.bytes.resize(values.size() * size_of(storage.type));
  with_type(storage.type, [&](auto zero) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto raw = static_cast<decltype(zero)>(encode_component(values[i], storage));
      std::memcpy(a.bytes.data() + i * sizeof(raw), &raw, sizeof(raw));
    }
  });
  return a;
}

}  // namespace fovea
