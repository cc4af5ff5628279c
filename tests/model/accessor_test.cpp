#include "fovea/model/accessor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fovea {
namespace {

constexpr ComponentType kTypes[] = {ComponentType::i8,  ComponentType::u8,  ComponentType::i16,
                                    ComponentType::u16, ComponentType::u32, ComponentType::f32};

TEST(Component, Sizes) {
  EXPECT_EQ(size_of(ComponentType::i8), 1u);
  EXPECT_EQ(size_of(ComponentType::u8), 1u);
  EXPECT_EQ(size_of(ComponentType::i16), 2u);
  EXPECT_EQ(size_of(ComponentType::u16), 2u);
  EXPECT_EQ(size_of(ComponentType::u32), 4u);
  EXPECT_EQ(size_of(ComponentType::f32), 4u);
}

TEST(Component, NormalizedEndsAreExact) {
  // glTF 2.0: f = c / max, and max(c / max, -1) for signed types.
  EXPECT_EQ(decode_component(255, {ComponentType::u8, true}), 1.0f);
  EXPECT_EQ(decode_component(65535, {ComponentType::u16, true}), 1.0f);
  EXPECT_EQ(decode_component(127, {ComponentType::i8, true}), 1.0f);
  EXPECT_EQ(decode_component(-127, {ComponentType::i8, true}), -1.0f);
  EXPECT_EQ(decode_component(-128, {ComponentType::i8, true}), -1.0f);
  EXPECT_EQ(decode_component(-32768, {ComponentType::i16, true}), -1.0f);
  EXPECT_EQ(decode_component(0, {ComponentType::u8, true}), 0.0f);
}

TEST(Component, PlainNumbersStandForThemselves) {
  for (const ComponentType type : kTypes) EXPECT_EQ(decode_component(100, {type, false}), 100.0f);
  EXPECT_EQ(decode_component(0.25, {ComponentType::f32, false}), 0.25f);
}

TEST(Component, EncodeRoundsAndClamps) {
  EXPECT_EQ(encode_component(1.4f, {ComponentType::u8, false}), 1.0);
  EXPECT_EQ(encode_component(1.6f, {ComponentType::u8, false}), 2.0);
  EXPECT_EQ(encode_component(300.0f, {ComponentType::u8, false}), 255.0);
  EXPECT_EQ(encode_component(-3.0f, {ComponentType::u8, false}), 0.0);
  EXPECT_EQ(encode_component(-300.0f, {ComponentType::i8, false}), -128.0);
  EXPECT_EQ(encode_component(-2.0f, {ComponentType::i8, true}), -127.0);
  EXPECT_EQ(encode_component(2.0f, {ComponentType::i16, true}), 32767.0);
  EXPECT_EQ(encode_component(-1.5f, {ComponentType::f32, false}), -1.5);
}

TEST(Component, EveryStoredByteSurvivesDecodingAndEncoding) {
  for (int raw = -127; raw <= 127; ++raw) {
    const Storage storage{ComponentType::i8, true};
    EXPECT_EQ(encode_component(decode_component(raw, storage), storage), raw);
  }
  for (int raw = 0; raw <= 65535; raw += 17) {
    const Storage storage{ComponentType::u16, true};
    EXPECT_EQ(encode_component(decode_component(raw, storage), storage), raw);
  }
}

TEST(Accessor, FloatsSurviveEveryTypeThatHoldsThem) {
  const std::vector<float> values{0, 1, 2, 3, 100, 127};
  for (const ComponentType type : kTypes) {
    const Accessor a = Accessor::from_floats(values, 3, {type, false});
    EXPECT_EQ(a.count, 2u);
    EXPECT_EQ(a.width, 3);
    EXPECT_EQ(a.bytes.size(), values.size() * size_of(type));
    EXPECT_EQ(a.to_floats(), values);
  }
}

TEST(Accessor, BytesAreLittleEndian) {
  const Accessor a = Accessor::from_floats({258}, 1, {ComponentType::u16, false});
  EXPECT_EQ(a.bytes, (std::vector<std::byte>{std::byte{2}, std::byte{1}}));
}

TEST(Accessor, NormalizedErrorIsHalfAStep) {
  const std::vector<float> values{-1, -0.3f, 0, 0.123f, 1};
  const auto back = Accessor::from_floats(values, 1, {ComponentType::i8, true}).to_floats();
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(back[i], values[i], 0.5 / 127 + 1e-7);
}

TEST(Accessor, EmptyIsFine) {
  EXPECT_TRUE(Accessor{}.to_floats().empty());
  EXPECT_EQ(Accessor::from_floats({}, 4).count, 0u);
}

}  // namespace
}  // namespace fovea
