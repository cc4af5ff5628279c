#include "fovea/base/srgb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

/// The standard's curve.
double light_of(double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); }

TEST(Srgb, DisplayValuesAndLightAreInverse) {
  for (int i = 0; i < 256; ++i) {
    const auto display = static_cast<std::uint8_t>(i);
    EXPECT_EQ(to_display(to_light(display)), i);
    EXPECT_NEAR(to_light(display), light_of(i / 255.0), 1e-7);  // to the precision of a float
  }
  EXPECT_EQ(to_display(-1), 0);
  EXPECT_EQ(to_display(std::nanf("")), 0);
  EXPECT_EQ(to_display(7), 255);
}

TEST(Srgb, DisplayValuesAreTheNearest) {
  for (int i = 0; i <= 5000; ++i) {
    const double light = i / 5000.0;
    const double display = light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    EXPECT_NEAR(to_display(static_cast<float>(light)), display * 255, 0.5001) << light;
  }
}

TEST(Srgb, CurveIsTheStandardsAndItsInverse) {
  for (int i = 0; i <= 3000; ++i) {
    const double x = i / 1000.0;
    const auto display = static_cast<float>(x);
    // Half a unit of a float's last digit, and what rounding x to a float makes of it.
    EXPECT_NEAR(srgb_to_linear(display), light_of(x), 2e-7 * std::max(light_of(x), 0.1)) << x;
    EXPECT_NEAR(linear_to_srgb(srgb_to_linear(display)), x, 3e-7 * std::max(x, 0.1)) << x;
    EXPECT_EQ(srgb_to_linear(-display), -srgb_to_linear(display));
    EXPECT_EQ(linear_to_srgb(-display), -linear_to_srgb(display));
  }
  EXPECT_TRUE(std::isnan(srgb_to_linear(std::nanf(""))));
  EXPECT_TRUE(std::isnan(linear_to_srgb(std::nanf(""))));
}

}  // namespace
}  // namespace fovea
