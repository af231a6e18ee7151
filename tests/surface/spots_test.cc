// Which spots pixels keep, and how their light is evened out.
#include "surface/spots.h"

#include <gtest/gtest.h>

namespace motes {
namespace {

Spot spot_at(double x, std::uint32_t particle) {
  return {{{x, 0, 0}, particle, no_stick}, {0, 0, 1}, {}};
}

TEST(Spots, KeepTheLowestRankOfEachBallAndCountItsRays) {
  Spots spots;
  spots.reset(1);
  spots.add(spot_at(1, 7), 50);
  spots.add(spot_at(2, 7), 20);
  spots.add(spot_at(3, 7), 30);
  spots.add(spot_at(4, 8), 40);
  const auto kept = spots.end_pixel();
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].point.place.x, 2);
  EXPECT_EQ(kept[0].num_rays, 3);
  EXPECT_EQ(kept[1].point.place.x, 4);
  EXPECT_EQ(kept[1].num_rays, 1);
  // The next pixel begins anew.
  spots.add(spot_at(5, 7), 90);
  EXPECT_EQ(spots.end_pixel()[0].num_rays, 1);
}

TEST(Spots, TellPiecesOfAnIsosurfaceApart) {
  constexpr std::uint32_t level = 0;
  const auto at = [](double z) {
    return Spot{{{0.1 * z, 0, z}, no_particle, level}, {1, 0, 0}, {}};
  };
  Spots spots;
  spots.reset(1);
  // A step of 100 along the normal is no smooth piece of surface; one of 0.1 is.
  spots.add(at(0), 3);
  spots.add(at(1), 2);
  spots.add({{{100, 0, 0}, no_particle, level}, {1, 0, 0}, {}}, 1);
  const auto kept = spots.end_pixel();
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].num_rays, 2);
  EXPECT_EQ(kept[1].num_rays, 1);
}

/// A pattern of pixels that show a ball: those of three rays where it is bright, those of one where
/// it is dark. The one in the middle shows `extra` balls more.
Spots pattern(int extra) {
  constexpr int side = 9;
  Spots spots;
  spots.reset(side);
  for (int pixel = 0; pixel < side * side; ++pixel) {
    const bool middle = pixel == side * side / 2;
    const int rays = pixel % 2 == 0 ? 3 : 1;
    for (int i = 0; i < rays; ++i) spots.add(spot_at(0.1 * pixel, 1), 0);
    for (int b = 0; middle && b < extra; ++b) {
      Spot other = spot_at(0, 2 + static_cast<std::uint32_t>(b));
      other.normal = {1, 0, 0};
      spots.add(other, 0);
    }
    for (Spot& spot : spots.end_pixel()) {
      spot.light.sky = rays == 3 ? 1 : 0;
      spot.light.lamps = {spot.light.sky, 1 - spot.light.sky};
    }
  }
  return spots;
}

TEST(Spots, AreEvenedOutByTheRaysThatShowThem) {
  const Spots spots = pattern(0);
  const Light light = spots.even_light(4, 4, spots.of(4, 4)[0]);
  // Of the 8 x 8 pixels that the pattern stands for half have three rays.
  EXPECT_NEAR(light.sky, 0.75, 1e-6);
  EXPECT_NEAR(light.lamps[0], 0.75, 1e-6);
  EXPECT_NEAR(light.lamps[1], 0.25, 1e-6);
}

TEST(Spots, OfCrowdedPixelsAreNot) {
  const Spots few = pattern(few_spots - 1), crowded = pattern(few_spots);
  EXPECT_NEAR(few.even_light(4, 4, few.of(4, 4)[0]).sky, 0.75, 1e-6);
  EXPECT_EQ(crowded.even_light(4, 4, crowded.of(4, 4)[0]).sky, 1);
}

}  // namespace
}  // namespace motes
