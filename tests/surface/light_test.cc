// How the spots of a pixel share its rays to the light.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "surface/directions.h"
#include "surface/light.h"

namespace motes {
namespace {

/// Two lights that are seen 6 degrees large and 16 rays a pixel to each and to the sky; what hides
/// them are the first 8 of the rays of the pixel with that number of the pattern.
SurfaceFrame half_hidden(int number) {
  SurfaceShading shading;
  shading.lighting.lights = {{Vector3d{0, 0, 1}, 1}, {Vector3d{0, 0.6, 0.8}, 1}};
  shading.shadows = true;
  shading.light_radius = 0.05;
  shading.occlusion_samples = shading.shadow_samples = 16;
  SurfaceFrame frame = make_light_frame({}, {}, shading);
  std::vector<Vector3f> hidden;
  const auto hide = [&](std::span<const Vector3f> all) {
    const auto of_pixel = directions_of(all, number);
    EXPECT_EQ(of_pixel.size(), 16u);
    hidden.insert(hidden.end(), of_pixel.begin(), of_pixel.begin() + 8);
  };
  for (const auto& lamp : frame.lamps) hide(lamp);

  frame.prune = [hidden](const Point3d& /*place*/, const Vector3d& /*normal*/, double /*length*/,
                         std::vector<Vector3f>& directions) {
    std::erase_if(directions, [&](const Vector3f& direction) {
      return std::find(hidden.begin(), hidden.end(), direction) != hidden.end();
    });
  };
  return frame;
}

std::vector<Spot> spots(std::size_t count) {
  return std::vector<Spot>(count, Spot{{{0, 0, 0}, no_particle, 0}, {0, 0, 1}, {}});
}

TEST(LookForLight, TakesAllRaysForEachOfFewSpots) {
  for (const int number : {0, 13, 63}) {
    const SurfaceFrame frame = half_hidden(number);
    std::vector<Vector3f> scratch;
    auto few = spots(few_spots);
    look_for_light(frame, few, number, scratch);
    for (const Spot& spot : few) {
      EXPECT_EQ(spot.light.lamps[0], 0.5F);
      EXPECT_EQ(spot.light.lamps[1], 0.5F);
      EXPECT_EQ(spot.light.sky, 1);
    }
  }
}

// As many rays as few spots have, however many there are, and each of the pixel's as often.
TEST(LookForLight, SharesTheRaysAmongManySpots) {
  for (const std::size_t count : {8, 16, 32, 64, 128}) {
    const int number = 5;
    const SurfaceFrame frame = half_hidden(number);
    std::vector<Vector3f> scratch;
    auto many = spots(count);
    look_for_light(frame, many, number, scratch);
    for (std::size_t lamp = 0; lamp < 2; ++lamp) {
      double sum = 0;
      bool all_alike = true;
      for (const Spot& spot : many) {
        sum += static_cast<double>(spot.light.lamps[lamp]);
        all_alike = all_alike && spot.light.lamps[lamp] == many[0].light.lamps[lamp];
      }
      EXPECT_EQ(sum / static_cast<double>(count), 0.5) << count;
      EXPECT_FALSE(all_alike) << count;
    }
  }
}

TEST(LookForLight, LeavesHeadlightsAndDarkLightsAlone) {
  SurfaceFrame frame = half_hidden(0);
  frame.shading.lighting.lights[0].direction.reset();
  frame.shading.lighting.lights[1].intensity = 0;
  std::vector<Vector3f> scratch;
  auto few = spots(1);
  look_for_light(frame, few, 0, scratch);
  EXPECT_EQ(few[0].light.lamps[0], 1);
  EXPECT_EQ(few[0].light.lamps[1], 1);
}

}  // namespace
}  // namespace motes
