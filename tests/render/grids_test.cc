// Fields that are grids: every engine, on every instruction set, makes the reference's picture of
// them, alone and among fields of particles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "core/error.h"
#include "render/engine_check.h"
#include "render/renderer.h"
#include "support/random_scene.h"

namespace motes {
namespace {

class GridSweep : public testing::TestWithParam<int> {};

TEST_P(GridSweep, MakesThePictureOfTheReference) {
  Comparison comparison;
  for (int i = 0; i < seeds_per_block; ++i) {
    const auto seed = static_cast<std::uint32_t>(GetParam() * seeds_per_block + i);
    const RandomScene random = random_grid_scene(seed);
    comparison.check(random.particles, random.scene, random.description);
  }
  EXPECT_LT(comparison.rms(), 5e-4);
  EXPECT_LT(comparison.unstable_share(), 0.06);
}

INSTANTIATE_TEST_SUITE_P(Blocks, GridSweep, testing::Range(0, num_blocks));

// ---- Scenes that chance does not make -----------------------------------------------------------

/// n^3 samples of f on the cube from -size to size.
FieldSource cube_grid(std::size_t n, double size, const std::function<double(const Point3d&)>& f) {
  Grid grid;
  grid.name = "cube";
  grid.dims = {n, n, n};
  grid.origin = {-size, -size, -size};
  const double step = 2 * size / static_cast<double>(n - 1);
  grid.steps = {Vector3d{step, 0, 0}, {0, step, 0}, {0, 0, step}};
  grid.values.resize(grid.size());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const std::size_t x = i % n, y = i / n % n, z = i / n / n;
    const auto place = [](std::size_t k) { return static_cast<double>(k); };
    grid.values[i] = static_cast<float>(f(grid.position(place(x), place(y), place(z))));
  }
  FieldSource source;
  source.name = "grid";
  source.grid = std::make_shared<const Grid>(std::move(grid));
  return source;
}

double bump(const Point3d& p) { return std::exp(-0.5 * (p.x * p.x + p.y * p.y + p.z * p.z)); }

/// A grid alone, seen as by plain_scene().
PlainScene grid_scene(FieldSource grid, double distance) {
  PlainScene s = plain_scene({{0, 0, 0}}, distance);
  s.scene.fields = {std::move(grid)};
  return s;
}

constexpr std::array<Reconstruction, 3> all_interpolations{
    Reconstruction::trilinear, Reconstruction::tricubic, Reconstruction::tricubic_smoothing};

TEST(GridPictures, FromInsideAndFromAnywhere) {
  for (const Reconstruction interpolation : all_interpolations) {
    PlainScene s = grid_scene(cube_grid(12, 3, bump), 10);
    s.scene.fields[0].interpolation = interpolation;
    s.scene.render.lighting.enabled = true;
    s.scene.step_size = 0.21;
    check(s, "outside");
    s.scene.camera.eye = {0.3, 0.2, 0.1};
    s.scene.camera.target = {1, 0.5, 0.25};
    s.scene.camera.fov_degrees = 110;
    check(s, "inside");
    s.scene.camera = {};
    s.scene.camera.eye = {0, 0, 3};  // on a face
    s.scene.camera.target = {0, 0, 0};
    s.scene.render.lighting.enabled = false;
    check(s, "on a face");
  }
}

TEST(GridPictures, FarAwayThroughANarrowView) {
  PlainScene s = grid_scene(cube_grid(20, 3, bump), 2000);
  s.scene.camera.fov_degrees = 0.2;
  s.scene.render.lighting.enabled = true;
  s.scene.step_size = 0.23;
  check(s, "far");
}

TEST(GridPictures, OutsideShowsNothingWhereZeroShows) {
  // A small grid of zeros beside the particles: opaque, but in its hull alone.
  PlainScene s = plain_scene({{0, 0, 0}, {2, 1, 0}}, 12);
  s.scene.fields.push_back(cube_grid(4, 1.05, [](const Point3d&) { return 0; }));
  TransferFunction all;
  all.points = {{.value = 1, .color = {0, 1, 0}, .extinction = 0.7}};
  s.scene.transfer_functions.push_back(all);
  check(s, "zero shows");
  std::swap(s.scene.fields[0], s.scene.fields[1]);
  std::swap(s.scene.transfer_functions[0], s.scene.transfer_functions[1]);
  check(s, "zero shows, in front");
  s.scene.fields.pop_back();
  s.scene.transfer_functions.pop_back();
  check(s, "zero shows, alone");
}

TEST(GridPictures, EmptySpaceIsSkippedWithoutATrace) {
  // Two thin shells of values in a grid of many macro cells.
  PlainScene s = grid_scene(cube_grid(90, 3, bump), 10);
  s.scene.transfer_functions = {{{{.value = 0.1, .color = {1, 0, 0}, .extinction = 0},
                                  {.value = 0.12, .color = {1, 0, 0}, .extinction = 9},
                                  {.value = 0.14, .color = {1, 0, 0}, .extinction = 0},
                                  {.value = 0.8, .color = {0, 1, 0}, .extinction = 0},
                                  {.value = 0.9, .color = {0, 1, 0}, .extinction = 9},
                                  {.value = 0.92, .color = {0, 1, 0}, .extinction = 0}},
                                 false}};
  s.scene.step_size = 0.033;
  s.scene.render.lighting.enabled = true;
  check(s, "shells");
}

TEST(GridPictures, OfOneValueAndOfOneCell) {
  for (const Reconstruction interpolation : all_interpolations) {
    PlainScene s = grid_scene(cube_grid(2, 2, [](const Point3d&) { return 0.7; }), 9);
    s.scene.fields[0].interpolation = interpolation;
    s.scene.render.lighting.enabled = true;
    check(s, "one value");
  }
}

TEST(GridPictures, ALinearFieldIsExact) {
  // Extinction c (4 + x - z) on the way through the middle of the cube: the sum has a closed form.
  constexpr double size = 2, step = 0.05, distance = 7.02;
  const auto linear = [](const Point3d& p) { return 4 + p.x - p.z; };
  for (const Reconstruction interpolation : all_interpolations) {
    PlainScene s = grid_scene(cube_grid(5, size, linear), distance);
    s.scene.fields[0].interpolation = interpolation;
    s.scene.transfer_functions = {ramp(8, 0.4)};
    s.scene.camera.orthographic_height = 2;
    s.scene.step_size = step;
    s.scene.render.termination_opacity = 1;
    const Renderer renderer(s.particles, s.scene.fields);
    const Framebuffer image = renderer.render(s.scene, {});
    for (int px = 0; px < image.width; ++px) {
      const double x = (2 * (px + 0.5) / image.width - 1) * image.width / image.height;
      double depth = 0;
      for (int k = 0; k < 300; ++k) {
        const double near = std::max(k * step, distance - size);
        const double far = std::min((k + 1) * step, distance + size);
        if (near >= far) continue;
        const double z = distance - std::clamp((k + 0.5) * step, near, far);
        depth += 0.4 / 8 * linear({x, 0, z}) * (far - near);
      }
      // 80 samples of float arithmetic.
      EXPECT_NEAR(image.pixel(px, 7)[3], 1 - std::exp(-depth), 2e-6) << px;
    }
  }
}

TEST(GridPictures, EndAtTheFacesOfTheHull) {
  // The same everywhere in a sheared hull: opacity is a matter of the way through it, not of where
  // its samples lie.
  constexpr double extinction = 0.2;
  Grid sheared;
  sheared.name = "sheared";
  sheared.dims = {3, 3, 3};
  sheared.origin = {-3, -2, -2};
  sheared.steps = {Vector3d{2, 0, 0}, {0, 2, 0}, {1, 0, 2}};
  sheared.values.assign(27, 1);
  FieldSource source;
  source.name = "grid";
  source.grid = std::make_shared<const Grid>(std::move(sheared));
  PlainScene s = grid_scene(source, 10);
  s.scene.transfer_functions = {
      {{{.value = 1, .color = {1, 1, 1}, .extinction = extinction}}, false}};
  s.scene.camera.orthographic_height = 4;
  s.scene.step_size = 0.83;
  s.scene.render.termination_opacity = 1;
  check(s, "sheared");
  s.scene.render.clip_planes = {{{0.3, 0.1, 1}, 0.4}};
  check(s, "sheared and clipped");
  s.scene.render.clip_planes.clear();
  const Framebuffer image = Renderer(s.particles, s.scene.fields).render(s.scene, {});
  for (int px = 0; px < image.width; ++px) {
    // At z the hull reaches from x = z/2 - 2 to z/2 + 2, and z from -2 to 2.
    const double x = (2 * (px + 0.5) / image.width - 1) * 2 * image.width / image.height;
    const double way = std::max(std::min(2.0, 2 * x + 4) - std::max(-2.0, 2 * x - 4), 0.0);
    EXPECT_NEAR(image.pixel(px, 7)[3], 1 - std::exp(-extinction * way), 1e-6) << px;
  }
}

TEST(GridPictures, DoNotDependOnThreads) {
  const RandomScene random = random_grid_scene(3);
  const Renderer renderer(random.particles, random.scene.fields);
  const Framebuffer one = renderer.render(random.scene, {1});
  EXPECT_EQ(renderer.render(random.scene, {4}).rgba, one.rgba);
}

TEST(GridPictures, MovingParticlesKeepTheGrid) {
  const RandomScene random = random_grid_scene(3);
  Renderer renderer(random.particles, random.scene.fields);
  const Framebuffer before = renderer.render(random.scene, {});
  renderer.set_particles(random.particles, random.scene.fields);
  EXPECT_EQ(renderer.render(random.scene, {}).rgba, before.rgba);
}

TEST(GridPictures, NeedTwoSamplesAlongEachAxis) {
  FieldSource source = cube_grid(2, 1, bump);
  Grid thin;
  thin.name = "thin";
  thin.dims = {2, 1, 2};
  thin.steps = source.grid->steps;
  thin.values.resize(4);
  source.grid = std::make_shared<const Grid>(std::move(thin));
  EXPECT_THROW(Renderer({}, {source}), Error);
}

}  // namespace
}  // namespace motes
