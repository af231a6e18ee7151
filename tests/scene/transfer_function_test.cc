// The built-in colour maps: their ends, their order, and that they are what their names promise.
#include "scene/transfer_function.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"

namespace motes {
namespace {

/// CIELAB lightness of a linear colour, 0 to 100.
double lightness(const Color& c) {
  const double y = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

TEST(ColorMaps, AreThoseOfTheDocumentation) {
  EXPECT_THAT(color_map_names(),
              testing::ElementsAre("viridis", "magma", "inferno", "plasma", "heat", "grey"));
}

TEST(ColorMaps, RiseInLightnessAndExtinction) {
  for (const std::string& name : color_map_names()) {
    const TransferFunction f = named_transfer_function(name, -1, 3, 5);
    EXPECT_FALSE(f.log_scale);
    EXPECT_EQ(f.points.front().value, -1);
    EXPECT_EQ(f.points.back().value, 3);
    EXPECT_EQ(f.points.front().extinction, 0);
    EXPECT_EQ(f.points.back().extinction, 5);
    for (std::size_t k = 1; k < f.points.size(); ++k) {
      EXPECT_GT(f.points[k].value, f.points[k - 1].value);
      EXPECT_GT(lightness(f.points[k].color), lightness(f.points[k - 1].color)) << name << k;
      EXPECT_NEAR(f.points[k].extinction, 5 * (f.points[k].value + 1) / 4, 1e-12);
    }
  }
}

TEST(ColorMaps, ViridisMatchesItsPublishedMiddle) {
  // matplotlib's viridis(0.5): 0.127568, 0.566949, 0.550556 in sRGB.
  const TransferFunction f = named_transfer_function("viridis", 0, 1, 1);
  const Color& c = f.points[16].color;
  EXPECT_NEAR(linear_to_srgb(c.r), 0.127568, 0.003);
  EXPECT_NEAR(linear_to_srgb(c.g), 0.566949, 0.003);
  EXPECT_NEAR(linear_to_srgb(c.b), 0.550556, 0.003);
}

TEST(NamedTransferFunction, LogScaleSpacesPointsEvenlyInTheLogarithm) {
  const TransferFunction f = named_transfer_function("heat", 1e-3, 1e5, 2, true);
  EXPECT_TRUE(f.log_scale);
  for (std::size_t k = 0; k < f.points.size(); ++k) {
    EXPECT_NEAR(std::log10(f.points[k].value), -3 + 8.0 * static_cast<double>(k) / 32, 1e-9);
  }
}

TEST(NamedTransferFunction, RefusesUnknownNamesAndEmptyRanges) {
  EXPECT_THROW(
      try { named_transfer_function("virids", 0, 1, 1); } catch (const Error& e) {
        EXPECT_STREQ(e.what(), "unknown colour map 'virids'; did you mean 'viridis'?");
        throw;
      },
      Error);
  EXPECT_THROW(named_transfer_function("grey", 1, 1, 1), Error);
  EXPECT_THROW(named_transfer_function("grey", 2, 1, 1), Error);
  EXPECT_THROW(named_transfer_function("grey", 0, NAN, 1), Error);
  EXPECT_THROW(named_transfer_function("grey", 0, 1, 1, true), Error);
  EXPECT_THROW(named_transfer_function("grey", 1, std::nextafter(1.0, 2.0), 1), Error);
}

TEST(ColorFromSrgb, DecodesChannels) {
  const Color c = color_from_srgb(0xff8000);
  EXPECT_EQ(c.r, 1);
  EXPECT_NEAR(c.g, 0.2158605, 1e-6);
  EXPECT_EQ(c.b, 0);
}

}  // namespace
}  // namespace motes
