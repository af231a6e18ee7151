// Ambient occlusion of isosurfaces against a long Monte Carlo run on the reference's field.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "isosurface/isosurface.h"
#include "reference/field.h"
#include "render/render_tile.h"
#include "support/particles_at.h"
#include "surface/light.h"

namespace motes {
namespace {

constexpr double level = 0.5;
constexpr double distance = 6;

/// A cluster of Gaussians with crevices.
struct Scene {
  ParticleSet particles = particles_at({{0, 0, 0},
                                        {2.6, 0, 0},
                                        {1.3, 2.2, 0},
                                        {1.2, 0.8, 2.1},
                                        {-2.2, 1.1, 0.7},
                                        {0.3, -2.4, 1},
                                        {3.4, 2.4, 2},
                                        {3, -2.2, 1.6},
                                        {-1.8, -1.4, 2.4},
                                        {-1.2, 3, 2.2}});
  FieldSource field;
  KernelSet kernels;
  IsosurfaceFrame frame;

  Scene() {
    Kernel kernel;
    kernel.support_factor = 4;
    field = field_of_all(particles, 1, 1, kernel);
    kernels = build_kernel_set(particles, {field});
    frame.kernels = &kernels;
    // Samples 0.15 apart: what they miss of a grazed level is a thousandth of the sky.
    const double scale = kernels.length_scale;
    frame.planes = {0, 0.1 * scale};
    frame.last_plane = 300;
    frame.box = {internal(kernels.box().min), internal(kernels.box().max)};
    Camera camera;
    camera.eye = {4, 3, 14};
    camera.target = {0.5, 0.3, 0.5};
    frame.view = {camera_axes(camera), internal(camera.eye), false};
    const auto value = static_cast<float>(level * kernels.fields[0].value_scale);
    frame.fields = {{0, {{0, value, 1, {{1, 1, 1}}}}, {}}};
  }
  Point3d internal(const Point3d& p) const {
    return Point3d{} + kernels.length_scale * (p - kernels.origin);
  }
  Point3d world(const Point3d& p) const {
    return kernels.origin + (p - Point3d{}) / kernels.length_scale;
  }
};

/// The part of `rays` directions, as cosine-weighted as the light of a uniform sky, along which the
/// field stays below the level.
double monte_carlo_sky(const Scene& scene, const Point3d& place, const Vector3d& normal, int rays,
                       std::mt19937& random) {
  const auto kernels = reference::particle_kernels(scene.particles, scene.field);
  std::uniform_real_distribution<double> uniform(0, 1);
  int open = 0;
  for (int i = 0; i < rays; ++i) {
    // A unit vector about the end of the normal: Lambert's law.
    const double z = 2 * uniform(random) - 1, angle = 2 * std::numbers::pi * uniform(random);
    const double across = std::sqrt(1 - z * z);
    const Vector3d direction =
        normalize(normal + Vector3d{across * std::cos(angle), across * std::sin(angle), z});
    constexpr int samples = 120;
    bool free = true;
    for (int k = 1; k <= samples && free; ++k) {
      const Point3d p = place + 1e-4 * normal + distance * k / samples * direction;
      free = reference::evaluate_field(kernels, p).value <= level;
    }
    open += free ? 1 : 0;
  }
  return static_cast<double>(open) / rays;
}

TEST(Isosurface, LacksTheSkyThatALongMonteCarloRunLacks) {
  const Scene scene;
  SurfaceShading shading;
  shading.occlusion_samples = 16;
  shading.occlusion_distance = distance * scene.kernels.length_scale;
  SurfaceFrame light = make_light_frame(scene.frame.view, {}, shading);
  light.prune = [&](const Point3d& place, const Vector3d& normal, double length,
                    std::vector<Vector3f>& directions) {
    prune(scene.frame, place, normal, length, directions);
  };
  const RayGrid grid{-0.24, 0.24, 0.06, -0.06, 0, 0, 9, 9};
  std::vector<IsosurfaceHit> hits;
  trace_isosurfaces(scene.frame, grid, hits);
  ASSERT_GT(hits.size(), 5u);
  std::mt19937 random(7);
  std::vector<Vector3f> scratch;
  double darkest = 1;
  for (const IsosurfaceHit& hit : hits) {
    const std::uint32_t column = hit.ray % 9, row = hit.ray / 9;
    const double u = grid.u + column * grid.du, v = grid.v + row * grid.dv;
    const CameraAxes& axes = scene.frame.view.axes;
    const Point3d place =
        scene.frame.view.eye + hit.depth * (axes.forward + u * axes.x + v * axes.y);
    const Vector3d normal(hit.normal);
    constexpr int rays = 4000, pattern = 64;
    const double expected = monte_carlo_sky(scene, scene.world(place), normal, rays, random);
    darkest = std::min(darkest, expected);
    // Four standard deviations of the run, sqrt(p (1 - p) / n); the 16 x 64 directions of all
    // pixels of the pattern are spread evenly, and their error is below that of so many random
    // ones.
    const double variance = std::max(expected * (1 - expected), 1e-3);
    const double tolerance = 4 * std::sqrt(variance / rays) + 2 * std::sqrt(variance / 1024);
    for (const std::string& target : instruction_sets()) {
      force_instruction_set(target);
      double sky = 0;
      for (int number = 0; number < pattern; ++number) {
        Spot spot{{place, no_particle, 0}, normal, {}};
        look_for_light(light, {&spot, 1}, number, scratch);
        sky += static_cast<double>(spot.light.sky) / pattern;
      }
      EXPECT_NEAR(sky, expected, tolerance) << target << ", ray " << hit.ray;
    }
    force_instruction_set("");
  }
  EXPECT_LT(darkest, 0.8);
}

}  // namespace
}  // namespace motes
