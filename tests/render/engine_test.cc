// Every engine, on every instruction set and any number of threads, makes the reference's picture.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "render/engine_check.h"
#include "render/renderer.h"
#include "support/particles_at.h"
#include "support/random_scene.h"

namespace motes {
namespace {

class EngineSweep : public testing::TestWithParam<int> {};

TEST_P(EngineSweep, MakesThePictureOfTheReference) {
  Comparison comparison;
  for (int i = 0; i < seeds_per_block; ++i) {
    const auto seed = static_cast<std::uint32_t>(GetParam() * seeds_per_block + i);
    const RandomScene random = random_scene(seed);
    comparison.check(random.particles, random.scene, random.description);
  }
  EXPECT_LT(comparison.rms(), 5e-4);
  // A few of the scenes have hundreds of samples a ray; on the whole the comparison must stay one.
  EXPECT_LT(comparison.unstable_share(), 0.06);
}

INSTANTIATE_TEST_SUITE_P(Blocks, EngineSweep, testing::Range(0, num_blocks));

// ---- Scenes that chance does not make -----------------------------------------------------------

TEST(Engines, LoneParticleOnTheAxis) {
  // The middle ray meets samples at the very centre of the kernel, where the gradient is zero.
  PlainScene s = plain_scene({{0, 0, 0}}, 10.15);
  s.scene.step_size = 0.7;  // plane 14 is at 10.15; none is at a face of the box
  s.scene.render.width = s.scene.render.height = 25;
  check(s, "lone");
  s.scene.render.lighting.enabled = true;
  check(s, "lone, lit");
  s.scene.camera.orthographic_height = 5;
  check(s, "lone, lit, orthographic");
}

TEST(Engines, CameraOnAParticle) {
  PlainScene s = plain_scene({{0, 0, 0}, {0.3, 0.1, -1.5}}, 10);
  s.scene.camera.eye = {0, 0, 0};
  s.scene.camera.target = {0, 0, -1};
  s.scene.camera.fov_degrees = 120;
  s.scene.step_size = 0.05;
  check(s, "eye at a centre");
}

TEST(Engines, FarAwayThroughANarrowView) {
  PlainScene s = plain_scene({{0, 0, 0}, {2, 1, -1}, {-1, 1, 3}}, 2000);
  s.scene.camera.fov_degrees = 0.3;
  s.scene.render.lighting.enabled = true;
  check(s, "far");
}

TEST(Engines, KernelsSmallerThanAPixel) {
  std::vector<Point3d> centers;
  centers.reserve(40);
  for (int i = 0; i < 40; ++i) centers.push_back({0.7 * i - 14, 0.3 * ((i * 7) % 40) - 6, 0.1 * i});
  PlainScene s = plain_scene(centers, 60);
  s.scene.fields[0].radius = {0.15F};
  s.scene.step_size = 0.2;
  s.scene.transfer_functions = {ramp(0.5, 8)};
  check(s, "small kernels");
}

TEST(Engines, WideSupports) {
  // Values down to exp(-50) count on a logarithmic scale.
  PlainScene s = plain_scene({{0, 0, 0}, {1, 2, 0.5}}, 30);
  s.scene.fields[0].kernel.support_factor = 10;
  s.scene.transfer_functions = {{{{.value = 1e-20, .color = {1, 0, 0}, .extinction = 0},
                                  {.value = 1, .color = {0, 1, 1}, .extinction = 0.3}},
                                 true}};
  check(s, "sigma 10");
}

TEST(Engines, CoincidentParticlesOfBothSigns) {
  PlainScene s = plain_scene({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, 9);
  // The first two cancel: there is no field of theirs, and no normal.
  s.scene.fields[0].weight = {1, -1, 0, 0.001F};
  s.scene.transfer_functions = {ramp(1e-3, 2)};
  s.scene.render.lighting.enabled = true;
  s.scene.render.lighting.specular = 0;
  check(s, "coincident");
}

TEST(Engines, BothSignsSeenAndZeroNot) {
  PlainScene s = plain_scene({{0, 0, 0}, {1.5, 0.5, 1}}, 9);
  s.scene.fields[0].weight = {1, -1};
  s.scene.transfer_functions = {{{{.value = -1, .color = {0, 0, 1}, .extinction = 2},
                                  {.value = 0, .color = {1, 1, 1}, .extinction = 0},
                                  {.value = 1, .color = {1, 0, 0}, .extinction = 2}},
                                 false}};
  check(s, "both signs");
}

TEST(Engines, OneStepAcrossEverything) {
  PlainScene s = plain_scene({{0, 0, 0}, {1, -1, 2}}, 10);
  s.scene.step_size = 20.25;  // one plane, through the data
  check(s, "one plane");
  s.scene.step_size = 1000;
  check(s, "no plane");
}

TEST(Engines, ThousandsOfKernelsInOnePlace) {
  // Each of 4,000 kernels reaches all pixels and planes.
  std::vector<Point3d> centers;
  centers.reserve(4000);
  for (int i = 0; i < 4000; ++i) {
    centers.push_back({0.05 * (i % 7), 0.07 * (i % 11), 0.03 * (i % 13)});
  }
  PlainScene s = plain_scene(centers, 12);
  std::vector<float> weights(centers.size(), 2e-3F);
  for (std::size_t i = 0; i < weights.size(); i += 3) weights[i] = -1e-3F;
  s.scene.fields[0].weight = weights;
  s.scene.transfer_functions = {ramp(4, 1)};
  s.scene.render.lighting.enabled = true;
  s.scene.render.width = 9;
  s.scene.render.height = 7;
  check(s, "crowd");
}

TEST(Engines, NoSeamBetweenShapesOfKernels) {
  // From less than a pixel across to several areas of the sweep, each a little larger than the one
  // before, so that every way of summing has some: across the picture and past its edges.
  std::vector<Point3d> centers;
  std::vector<float> radii;
  for (int i = 0; i < 60; ++i) {
    centers.push_back({2.6 * std::sin(2.1 * i), 1.9 * std::cos(3.7 * i), 0.9 * std::sin(1.3 * i)});
    radii.push_back(0.008F * std::pow(1.1F, static_cast<float>(i)));
  }
  PlainScene s = plain_scene(centers, 5);
  s.scene.fields[0].radius = radii;
  s.scene.step_size = 0.06;
  s.scene.render.width = 110;
  s.scene.render.height = 80;
  check(s, "all sizes");
  s.scene.render.lighting.enabled = true;
  check(s, "all sizes, lit");
}

TEST(Engines, SmallKernelsSeenThroughASlit) {
  // Rays end above and below four rows of pixels, which the sweep takes together: what lies behind
  // is seen by none of its neighbours. A unit is a pixel.
  std::vector<Point3d> centers;
  std::vector<float> radii;
  for (double x = -32; x <= 32; x += 0.5) {
    centers.insert(centers.end(), {{x, 12, 0}, {x, -8, 0}});
    radii.insert(radii.end(), {4, 4});
  }
  for (double x = -30; x <= 30; x += 3) {
    centers.push_back({x, 2, -20});
    radii.push_back(1.45F);
  }
  PlainScene s = plain_scene(centers, 40);
  s.scene.fields[0].radius = radii;
  s.scene.fields[0].kernel.support_factor = 2;
  s.scene.transfer_functions = {ramp(0.01, 1000)};
  s.scene.camera.orthographic_height = 64;
  s.scene.render.width = s.scene.render.height = 64;
  check(s, "slit");
  s.scene.fields.push_back(s.scene.fields[0]);
  s.scene.transfer_functions.push_back(ramp(1, 0.5));
  s.scene.render.lighting.enabled = true;
  check(s, "slit, two fields, lit");
}

TEST(Engines, RaysThatBeginAfterOthersHaveEnded) {
  // A face of the volume, opaque from the first sample on, seen obliquely: a ray begins twelve
  // planes after its neighbour, so that between one and the next there are eight that none needs.
  PlainScene s = plain_scene({{0, -1, 0}, {8, 1, 0}, {0, 1, 8}}, 0.5);
  s.scene.transfer_functions = {{{{.value = 0, .color = {1, 0, 0}, .extinction = 1000},
                                  {.value = 1, .color = {0, 0, 1}, .extinction = 1000}},
                                 false}};
  s.scene.camera.eye = {-22, 0, -18};
  s.scene.camera.target = {-2, 0, 2};
  s.scene.camera.orthographic_height = 4 * 0.6;
  s.scene.render.width = 8;
  s.scene.render.height = 4;
  s.scene.step_size = 0.05;
  check(s, "oblique face");
}

TEST(Engines, RefuseACameraThatLooksNowhere) {
  PlainScene s = plain_scene({{0, 0, 0}}, 10);
  s.scene.camera.target = s.scene.camera.eye;
  const Renderer renderer(s.particles, s.scene.fields);
  EXPECT_THROW(renderer.render(s.scene, {}), Error);
}

/// The lattice of the measurements: spacing 2.475, jittered by 0.6, two radii.
PlainScene lattice(int n, double distance, double extinction) {
  std::vector<Point3d> centers;
  std::vector<float> radii;
  std::uint32_t state = 1;
  const auto jitter = [&] {
    state = state * 1664525U + 1013904223U;
    return 0.6 * (static_cast<double>(state >> 8) / (1 << 23) - 1);
  };
  for (int i = 0; i < n * n * n; ++i) {
    const int column = i % n, row = i / n % n, layer = i / (n * n);
    const double x = 2.475 * column + jitter(), y = 2.475 * row + jitter();
    centers.push_back({x, y, 2.475 * layer + jitter()});
    radii.push_back(i % 3 == 0 ? 1.11F : 0.66F);
  }
  PlainScene s = plain_scene(centers, 1);
  s.scene.fields[0].radius = radii;
  const double middle = 2.475 * (n - 1) / 2;
  s.scene.camera.target = {middle, middle, middle};
  s.scene.camera.eye =
      s.scene.camera.target + distance * n * 2.475 * normalize(Vector3d{0.4, 0.3, -1});
  s.scene.transfer_functions = {ramp(1.2, extinction)};
  s.scene.transfer_functions[0].points[0].value = 0.2;
  s.scene.render.width = s.scene.render.height = 45;
  return s;
}

TEST(Engines, LatticeFarAndClose) {
  for (const double distance : {1.9, 0.75}) {
    for (const double extinction : {2., 0.05}) {
      const PlainScene s = lattice(16, distance, extinction);
      Comparison comparison;
      comparison.check(s.particles, s.scene,
                       fmt::format("distance {}, extinction {}", distance, extinction));
      EXPECT_LT(comparison.rms(), 5e-4);
      // A sample is near one of the boundaries with a chance of some 0.3 % (far);
      // rays end after some ten samples, or after fifty.
      EXPECT_LT(comparison.unstable_share(), extinction > 1 ? 0.04 : 0.2);
    }
  }
}

/// Radii from 0.5 down over so many orders of magnitude, evenly spread, around the origin. Kernels
/// far thinner than a pixel lie on samples of the camera's, or none would be seen; not those so
/// thin that floats do not place them to a thousandth of their radius.
PlainScene radii_over(int orders) {
  PlainScene s = plain_scene({}, 6);
  s.scene.step_size = 0.11;
  const double half_height = std::tan(s.scene.camera.fov_degrees * std::numbers::pi / 360);
  std::uint32_t state = 5;
  const auto unit = [&] {
    state = state * 1664525U + 1013904223U;
    return static_cast<double>(state >> 8) / (1 << 24);
  };
  std::vector<Point3d> centers;
  std::vector<float> radii;
  for (int i = 0; i < 300; ++i) {
    const double radius = 0.5 * std::pow(10, -orders * unit());
    Point3d center{2 * unit() - 1, 2 * unit() - 1, 2 * unit() - 1};
    if (radius < 0.02 && radius > 1e-4) {
      const double column = std::floor(24 * unit()), row = std::floor(20 * unit());
      const double depth = s.scene.step_size * (std::floor(40 + 25 * unit()) + 0.5);
      // Not on the very sample: there is no normal.
      center = Point3d{(2 * (column + 0.5) / 24 - 1) * half_height * 1.2 * depth,
                       (1 - 2 * (row + 0.5) / 20) * half_height * depth, 6 - depth} +
               radius * Vector3d{0.4, -0.3, 0.3};
    }
    centers.push_back(center);
    radii.push_back(static_cast<float>(radius));
  }
  s.particles = particles_at(centers);
  s.scene.fields = {field_of_all(s.particles, 1, 1, {})};
  s.scene.fields[0].radius = radii;
  s.scene.transfer_functions = {ramp(4, 2)};
  return s;
}

TEST(Engines, RadiiOverFourAndEightOrdersOfMagnitude) {
  for (const int orders : {4, 8}) {
    PlainScene s = radii_over(orders);
    check(s, fmt::format("{} orders", orders));
    s.scene.render.lighting.enabled = true;
    check(s, fmt::format("{} orders, lit", orders));
    // Densities: the peaks span three times as many.
    s.scene.fields[0].normalise = true;
    s.scene.transfer_functions = {{{{.value = 0.01, .color = {0.1F, 0.2F, 1}, .extinction = 0},
                                    {.value = 1e12, .color = {1, 0.8F, 0.3F}, .extinction = 3}},
                                   true}};
    check(s, fmt::format("{} orders, densities", orders));
  }
}

TEST(Engines, DoNotDependOnTheNumberOfThreads) {
  // Some tiles of each kind: whole, and cut off at the right and at the bottom.
  PlainScene s = lattice(6, 1.5, 0.3);
  s.scene.render.width = 107;
  s.scene.render.height = 75;
  s.scene.render.lighting.enabled = true;
  const Renderer renderer(s.particles, s.scene.fields);
  for (const Way& way : all_ways()) {
    RenderStatistics one, many;
    const Framebuffer alone = render_in(way, renderer, s.scene, 1, &one);
    for (const int threads : {2, 4}) {
      EXPECT_EQ(render_in(way, renderer, s.scene, threads, &many), alone) << way.name();
      EXPECT_EQ(many.samples, one.samples) << way.name();
      EXPECT_EQ(many.kernel_evaluations, one.kernel_evaluations) << way.name();
    }
  }
}

}  // namespace
}  // namespace motes
