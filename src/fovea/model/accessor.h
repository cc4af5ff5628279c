#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fovea {

/// Types of numbers in a file; the values are glTF's own.
enum class ComponentType : int { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

/// Bytes of one component: 1, 2 or 4.
std::size_t size_of(ComponentType type);

/// How a file stores numbers: component type, and whether integers stand for [0, 1] or [-1, 1].
struct Storage {
  ComponentType type = ComponentType::f32;
  bool normalized = false;
  friend bool operator==(const Storage&, const Storage&) = default;
};

/// What the number stored as `raw` stands for (glTF 2.0, "Accessor data types").
float decode_component(double raw, Storage storage);
/// The stored number nearest to `value`: rounded and clamped to the type's range for integers, in
/// which NaN is 0.
double encode_component(float value, Storage storage);

/// A typed array as a file stores it, tightly packed and little-endian: data that Fovea carries
/// without looking inside (animation samplers, points and lines), bit for bit.
struct Accessor {
  Storage storage;
  int width = 1;                 ///< Components per element: 1 to 4 for SCALAR to VEC4, 4/9/16 for MAT2/3/4.
  bool matrix = false;           ///< True for MAT2, MAT3, MAT4.
  std::size_t count = 0;         ///< Elements.
  std::vector<std::byte> bytes;  ///< [count × width × size_of(type)]; matrix columns without padding.

  /// The numbers as they are meant: [count × width].
  std::vector<float> to_floats() const;
  static Accessor from_floats(const std::vector<float>& values, int width, Storage storage = {});
  friend bool operator==(const Accessor&, const Accessor&) = default;
};

}  // namespace fovea
