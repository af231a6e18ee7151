// Light on balls and sticks: ambient occlusion against closed forms and long Monte Carlo runs,
// shadows and colours against the formulas of docs/surface.md.
#include "surface/shade.h"
#include "surface/phong.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "render/render_tile.h"
#include "support/particles_at.h"
#include "surface/brute_force.h"
#include "surface/directions.h"
#include "surface/random_surface.h"

namespace motes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Ambient light alone, so that a white surface shows the open part of the sky.
SurfaceShading sky_alone(int samples) {
  SurfaceShading shading;
  shading.lighting.ambient = 1;
  shading.lighting.diffuse = shading.lighting.specular = 0;
  shading.occlusion_samples = samples;
  return shading;
}

void make_white(Surface& surface) { surface.colors.palette = {{1, 1, 1}}; }

/// Directions about +z, their density going with the cosine.
Vector3d random_cosine_direction(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double u = uniform(random), angle = 2 * std::numbers::pi * uniform(random);
  return {std::sqrt(u) * std::cos(angle), std::sqrt(u) * std::sin(angle), std::sqrt(1 - u)};
}

/// Whether anything but solid `own` is in the way.
bool is_free(const Line& line, const std::vector<Solid>& solids, const SurfaceHit& own,
             double length) {
  return std::none_of(solids.begin(), solids.end(), [&](const Solid& solid) {
    if (solid.particle == own.particle && solid.stick == own.stick) return false;
    return cross(line, solid, 0).first_after(1e-3 * solid.radius) < length;
  });
}

/// Two balls, not in proportion: the first of radius 1 around 0, seen from +z, the second at `at`.
struct TwoBalls {
  KernelSet kernels;
  Surface surface;
  SurfaceView view;

  TwoBalls(const Point3d& at, double radius) {
    const ParticleSet particles = particles_at({{0, 0, 0}, at});
    const std::vector<FieldSource> fields{field_of_all(particles, 1, 1, {})};
    kernels = build_kernel_set(particles, fields);
    surface.kernels = &kernels;
    surface.radius.allocate(2);
    const Point3d first = internal({0, 0, 0});
    for (std::size_t i = 0; i < 2; ++i) {
      const bool is_first = kernels.x[i] == static_cast<float>(first.x) &&
                            kernels.y[i] == static_cast<float>(first.y) &&
                            kernels.z[i] == static_cast<float>(first.z);
      surface.radius.at(i) = static_cast<float>((is_first ? 1 : radius) * kernels.length_scale);
    }
    fit_reach(surface);
    make_white(surface);
    const Camera camera{{0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 45, {}};
    view = {camera_axes(camera), internal(camera.eye), false};
  }
  Point3d internal(const Point3d& p) const {
    const Vector3d v = kernels.length_scale * (p - kernels.origin);
    return {v.x, v.y, v.z};
  }
  /// What the middle of the first ball shows.
  Color middle(const SurfaceShading& shading) const {
    const ImagePlane plane{1e-6, 1e-6, 1, 1, 1};
    const SurfaceFrame frame = make_surface_frame(surface, view, plane, shading);
    SurfaceSamples samples;
    render_surface(frame, {0, 0, 1, 1}, samples);
    return samples.color[0];
  }
};

// A ball of angular radius a at an angle t from the normal, all above the horizon, hides
// sin^2(a) cos(t) of the sky.
TEST(AmbientOcclusion, OfABallOverABallIsItsFormFactor) {
  for (const double angle : {35., 50., 65.}) {
    for (const double size : {10., 24.}) {
      const double t = angle * std::numbers::pi / 180, a = size * std::numbers::pi / 180;
      const double distance = 2;
      const TwoBalls balls({distance * std::sin(t), 0, 1 + distance * std::cos(t)},
                           distance * std::sin(a));
      const double expected = 1 - std::sin(a) * std::sin(a) * std::cos(t);
      // 16 samples for each of 64 pixels.
      EXPECT_NEAR(balls.middle(sky_alone(16)).r, expected, 4e-3) << angle << ", " << size;
      SurfaceShading near = sky_alone(16);
      near.occlusion_distance = 0.99 * balls.kernels.length_scale * distance * (1 - std::sin(a));
      EXPECT_EQ(balls.middle(near).r, 1);
    }
  }
}

TEST(AmbientOcclusion, IsWhatALongMonteCarloRunGives) {
  std::mt19937 random(1);
  int checked = 0;
  for (unsigned seed = 0; seed < 40 && checked < 40; ++seed) {
    RandomSurface scene = random_surface(seed);
    if (scene.kernels->size() < 15 || scene.surface.radius.is_shared()) continue;
    make_white(scene.surface);
    const std::vector<Solid> solids = solids_of(scene.surface);
    const RandomView random_place = random_view(scene, seed);
    const RayGrid& grid = random_place.grid;
    const double distance = seed % 2 == 0 ? infinity : scene.spacing;
    SurfaceShading shading = sky_alone(16);
    shading.occlusion_distance = distance;
    for (int i = 0; i < 3; ++i) {
      // One pixel, so small that those around it see the same point.
      SurfaceView view = random_place.view;
      const Line towards = camera_line(view, grid.u + grid.du * (grid.column + i * grid.width / 3.),
                                       grid.v + grid.dv * grid.row);
      if (view.orthographic) view.eye = towards.origin;
      view.axes = camera_axes({towards.origin, towards.at(1), view.axes.y, 45, {}});
      const SurfaceHit hit = trace(scene.surface, view.eye, view.axes.forward);
      if (!hit.any()) continue;
      const double pixel = 1e-5 * scene.spacing / (view.orthographic ? 1 : hit.depth);
      SurfaceSamples samples;
      render_surface(make_surface_frame(scene.surface, view, {pixel, pixel, 1, 1, 1}, shading),
                     {0, 0, 1, 1}, samples);

      const Vector3d normal(hit.normal);
      const Across sides = across(normal);
      const Point3d point = view.eye + hit.depth * view.axes.forward;
      constexpr int count = 20000;
      int open = 0;
      for (int k = 0; k < count; ++k) {
        const Vector3d d = random_cosine_direction(random);
        const Line line{point, d.x * sides.x + d.y * sides.y + d.z * normal};
        open += is_free(line, solids, hit, distance) ? 1 : 0;
      }
      // Three standard deviations of the run are 0.01; 1024 stratified samples are off by less.
      EXPECT_NEAR(samples.color[0].r, static_cast<double>(open) / count, 0.02)
          << scene.description << "\n"
          << random_place.description << ", " << i;
      ++checked;
    }
  }
  EXPECT_GT(checked, 20);
}

/// A picture of all samples.
SurfaceSamples render(const Surface& surface, const SurfaceView& view, const ImagePlane& plane,
                      const SurfaceShading& shading) {
  SurfaceSamples samples;
  render_surface(make_surface_frame(surface, view, plane, shading),
                 {0, 0, plane.width, plane.height}, samples);
  return samples;
}

/// Close-packed balls from near: what the noise of pictures is judged by.
struct Pile {
  KernelSet kernels;
  Surface surface;
  SurfaceView view;
  ImagePlane plane{0.25, 0.25, 96, 96, 1};

  Pile() {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-0.2, 0.2);
    std::vector<Point3d> points;
    for (int i = 0; i < 1000; ++i) {
      const int row = i / 10 % 10, layer = i / 100;
      points.emplace_back(i % 10 + uniform(random), row + uniform(random), layer + uniform(random));
    }
    const ParticleSet particles = particles_at(points);
    kernels = build_kernel_set(particles, {field_of_all(particles, 1, 1, {})});
    surface.kernels = &kernels;
    surface.radius.share(static_cast<float>(0.5 * kernels.length_scale));
    fit_reach(surface);
    make_white(surface);
    const Camera camera{{4, 7, 21}, {4.5, 4.5, 9}, {0, 1, 0}, 45, {}};
    const Vector3d eye = kernels.length_scale * (camera.eye - kernels.origin);
    view = {camera_axes(camera), {eye.x, eye.y, eye.z}, false};
  }
};

TEST(AmbientOcclusion, Of16SamplesIsNearlyFreeOfNoise) {
  const Pile pile;
  const SurfaceSamples few = render(pile.surface, pile.view, pile.plane, sky_alone(16));
  const SurfaceSamples many = render(pile.surface, pile.view, pile.plane, sky_alone(256));
  double squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < few.depth.size(); ++i) {
    if (std::isinf(few.depth[i])) continue;
    const double difference = few.color[i].r - many.color[i].r;
    squares += difference * difference;
    ++count;
  }
  // 16 independent samples would be off by up to 0.125.
  EXPECT_LT(std::sqrt(squares / count), 0.012);
  EXPECT_GT(count, 8000);
}

// A pixel a ball and a half wide shows more than a few balls. They share its rays to the sky, and
// each has the light of one place for all that is seen of it.
TEST(AmbientOcclusion, OfCrowdedPixelsIsThatOfTheirRaysInTheMean) {
  constexpr int side = 4, n = 8, views = 12;
  double sum = 0;
  for (int view = 0; view < views; ++view) {
    Pile pile;
    pile.view.eye.x += pile.kernels.length_scale * 0.1 * (view - views / 2.);
    const auto mean = [&](const ImagePlane& plane, int rays) {
      SurfaceShading shading = sky_alone(rays);
      shading.seed = static_cast<std::uint32_t>(view);
      const SurfaceSamples samples = render(pile.surface, pile.view, plane, shading);
      double bright = 0;
      for (std::size_t i = 0; i < samples.depth.size(); ++i) {
        if (!std::isinf(samples.depth[i])) bright += samples.color[i].r;
      }
      return bright / static_cast<double>(samples.depth.size());
    };
    // (neighbouring places are so near to each other in the larger picture that none is evened out
    // with one that is much darker)
    const double crowded = mean({0.25, 0.25, side, side, n}, 16);
    sum += crowded - mean({0.25, 0.25, 6 * side * n, 6 * side * n, 1}, 16);
  }
  // (light of the balls' edges would be darker by 0.24)
  EXPECT_NEAR(sum / views, 0, 0.04);
}

TEST(Shade, TellsTheSameOfAPixelWhateverTheRectAndTheThreads) {
  const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism, 5);
  Pile pile;
  pile.plane.samples = 2;
  SurfaceShading shading;
  shading.occlusion_samples = 8;
  shading.shadows = true;
  shading.lighting.lights = {{Vector3d{1, 2, 3}}, {Vector3d{-3, 1, 2}, 0.5}};
  shading.light_radius = 0.05;
  const SurfaceFrame frame = make_surface_frame(pile.surface, pile.view, pile.plane, shading);
  SurfaceSamples whole;
  render_surface(frame, {0, 0, 96, 96}, whole);
  tbb::task_arena arena(5);
  arena.execute([&] {
    constexpr int size = 23;  // no divisor of anything
    tbb::parallel_for(0, 25, [&](int i) {
      const int x = i % 5 * size, y = i / 5 * size;
      const Tile rect{x, y, std::min(size, 96 - x), std::min(size, 96 - y)};
      SurfaceSamples part;
      render_surface(frame, rect, part);
      for (int row = 0; row < 2 * rect.height; ++row) {
        for (int column = 0; column < 2 * rect.width; ++column) {
          const int in_part = row * 2 * rect.width + column;
          const int in_whole = (2 * y + row) * 192 + 2 * x + column;
          const auto p = static_cast<std::size_t>(in_part), w = static_cast<std::size_t>(in_whole);
          ASSERT_EQ(part.depth[p], whole.depth[w]);
          ASSERT_EQ(part.color[p], whole.color[w]);
        }
      }
    });
  });
}

/// The formula of docs/surface.md; `lit` tells of each light whether it is reached.
Color expected_color(const Lighting& lighting, const Color& base, const Vector3d& normal,
                     const Vector3d& direction, double sky, const std::vector<double>& lit) {
  const Vector3d view = normalize(-direction);
  double body = lighting.ambient * sky, gloss = 0;
  for (std::size_t l = 0; l < lighting.lights.size(); ++l) {
    const LightSource& light = lighting.lights[l];
    const Vector3d lamp = light.direction ? normalize(*light.direction) : view;
    const double cosine = std::max(dot(normal, lamp), 0.0);
    const double mirrored = std::max(dot(normal, normalize(lamp + view)), 0.0);
    body += lighting.diffuse * light.intensity * lit[l] * cosine;
    if (cosine > 0) {
      gloss +=
          lighting.specular * light.intensity * lit[l] * std::pow(mirrored, lighting.shininess);
    }
  }
  return {static_cast<float>(base.r * body + gloss), static_cast<float>(base.g * body + gloss),
          static_cast<float>(base.b * body + gloss)};
}

void expect_near(const Color& found, const Color& expected, const std::string& what) {
  EXPECT_NEAR(found.r, expected.r, 1e-5) << what;
  EXPECT_NEAR(found.g, expected.g, 1e-5) << what;
  EXPECT_NEAR(found.b, expected.b, 1e-5) << what;
}

TEST(Shade, KeepsToItsFormulasForHardShadows) {
  int lit = 0, dark = 0;
  for (unsigned seed = 0; seed < 25; ++seed) {
    RandomSurface scene = random_surface(seed);
    scene.surface.colors.palette = {{0.2f, 0.5f, 0.9f}};
    const std::vector<Solid> solids = solids_of(scene.surface);
    const RandomView random = random_view(scene, seed);
    SurfaceShading shading;
    shading.shadows = seed % 5 != 0;
    std::vector<LightSource>& lights = shading.lighting.lights;
    if (seed % 3 != 0) lights[0].direction = Vector3d{0.3, 2, -1};
    if (seed % 2 != 0) lights.push_back({Vector3d{-2, 0.1, 0.4}, 0.6});
    const double half = std::abs(random.grid.du) * random.grid.width / 2;
    const ImagePlane plane{half, half * 13 / 17, 17, 13, 2};
    const SurfaceSamples samples = render(scene.surface, random.view, plane, shading);
    for (int i = 0; i < 34 * 26; ++i) {
      const int column = i % 34, row = i / 34;
      const Line line = camera_line(random.view, (2 * (column + 0.5) / 34 - 1) * plane.half_width,
                                    (1 - 2 * (row + 0.5) / 26) * plane.half_height);
      const double depth = samples.depth[static_cast<std::size_t>(i)];
      // What is hit where is the business of trace().
      const SurfaceHit hit = trace(scene.surface, line.origin, line.direction);
      if (!hit.any() || !(std::abs(hit.depth - depth) < 1e-9 * hit.depth)) continue;
      // Grazed: whether it is in shadow is a matter of rounding.
      std::vector<Solid> larger = solids, smaller = solids;
      for (Solid& s : larger) s.radius *= 1 + 1e-4;
      for (Solid& s : smaller) s.radius *= 1 - 1e-4;
      bool grazed = false;
      std::vector<double> reached(lights.size(), 1);
      for (std::size_t l = 0; l < lights.size(); ++l) {
        if (!shading.shadows || !lights[l].direction) continue;
        const Line to_lamp{line.at(depth), *lights[l].direction};
        reached[l] = is_free(to_lamp, solids, hit, infinity) ? 1 : 0;
        grazed |=
            is_free(to_lamp, larger, hit, infinity) != is_free(to_lamp, smaller, hit, infinity);
        (reached[l] > 0 ? lit : dark) += 1;
      }
      if (grazed) continue;
      expect_near(samples.color[static_cast<std::size_t>(i)],
                  expected_color(shading.lighting, scene.surface.colors.palette[0],
                                 Vector3d(hit.normal), line.direction, 1, reached),
                  fmt::format("{}\n{}\nsample {}", scene.description, random.description, i));
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(lit, 2000);
  EXPECT_GT(dark, 500);
}

// A grid's surface that is seen from the side may face a light straight behind it.
TEST(Shade, ALightStraightBehindHasNoHighlight) {
  const Lighting lighting{.ambient = 0.25, .diffuse = 0.5, .lights = {{Vector3d{0, 0, -1}}}};
  const Color color = phong(lighting, {1, 1, 1}, {0.6, 0, -0.8}, {0, 0, 1}, {});
  EXPECT_FLOAT_EQ(color.r, 0.25F + 0.5F * 0.8F);
}

// Seen from the middle of the first ball, the second takes up all directions within asin(4/5) of
// +x: a lamp in the direction of its edge is hidden by half.
TEST(Shade, SoftShadowsAreThePartOfTheLampThatIsSeen) {
  const TwoBalls balls({5, 0, 1}, 4);
  const double edge = std::numbers::pi / 2 - std::asin(4. / 5);  // from +z
  SurfaceShading shading;
  shading.lighting.ambient = shading.lighting.specular = 0;
  shading.lighting.diffuse = 1;
  shading.shadows = true;
  shading.light_radius = 0.02;
  const auto lit = [&](double angle) {
    shading.lighting.lights[0].direction = Vector3d{std::sin(angle), 0, std::cos(angle)};
    return balls.middle(shading).r / std::cos(angle);
  };
  EXPECT_NEAR(lit(edge), 0.5, 0.01);
  EXPECT_NEAR(lit(edge - 1.05 * shading.light_radius), 1, 1e-5);
  EXPECT_EQ(lit(edge + 1.05 * shading.light_radius), 0);
  // Beyond a line at half its radius lies this part of a disc.
  const double segment = (std::acos(0.5) - 0.5 * std::sqrt(0.75)) / std::numbers::pi;
  EXPECT_NEAR(lit(edge - 0.5 * shading.light_radius), 1 - segment, 0.01);
  // The part of the lamp below the horizon gives no light.
  const TwoBalls apart({0, 0, -50}, 4);
  const double low = std::numbers::pi / 2 - 0.5 * shading.light_radius;
  shading.lighting.lights[0].direction = Vector3d{std::sin(low), 0, std::cos(low)};
  EXPECT_NEAR(apart.middle(shading).r / std::cos(low), 1 - segment, 0.02);
  // Each of several lights has its own shadow.
  const auto towards = [](double angle) { return Vector3d{std::sin(angle), 0, std::cos(angle)}; };
  shading.lighting.lights = {
      {towards(edge + 0.1), 1}, {towards(edge), 0.5}, {towards(-0.2), 2}, {{}, 0.25}};
  EXPECT_NEAR(balls.middle(shading).r, 0.5 * 0.5 * std::cos(edge) + 2 * std::cos(0.2) + 0.25 * 1,
              0.005);
}

TEST(Shade, GivesEachParticleItsColour) {
  const TwoBalls balls({5, 5, -5}, 1);
  Surface surface;
  surface.kernels = &balls.kernels;
  surface.radius = balls.surface.radius;
  fit_reach(surface);
  const auto shown = [&] {
    const ImagePlane plane{1e-6, 1e-6, 1, 1, 1};
    SurfaceShading shading;
    shading.lighting.enabled = false;
    return render(surface, balls.view, plane, shading).color[0];
  };
  surface.colors.palette = {{0.25f, 0.5f, 2}};
  EXPECT_EQ(shown(), (Color{0.25f, 0.5f, 2}));
  const std::uint32_t first = trace(surface, balls.view.eye, balls.view.axes.forward).particle;
  surface.colors.palette.push_back({1, 0, 0.125f});
  surface.colors.index = {1, 1};
  surface.colors.index[first] = 0;
  EXPECT_EQ(shown(), (Color{0.25f, 0.5f, 2}));
  surface.colors.index[first] = 1;
  EXPECT_EQ(shown(), (Color{1, 0, 0.125f}));
  surface.colors.srgb = {0, 0};
  surface.colors.srgb[first] = 0x80ff33;
  const Color color = shown();
  EXPECT_NEAR(color.r, srgb_to_linear(0x33 / 255.), 1e-6);
  EXPECT_NEAR(color.g, 1, 1e-6);
  EXPECT_NEAR(color.b, srgb_to_linear(0x80 / 255.), 1e-6);
}

TEST(Directions, OfEachPixelAndOfAllTogetherAreEvenlySpread) {
  constexpr int samples = 16, all = samples * pattern_side * pattern_side;
  const std::vector<Vector3f> directions = cosine_directions(samples, 5);
  ASSERT_EQ(directions.size(), static_cast<std::size_t>(all));
  const auto expect_spread = [&](int begin, int count) {
    for (int columns = 1; columns <= count; columns *= 2) {
      std::set<int> cells;
      for (int i = begin; i < begin + count; ++i) {
        const Vector3f& d = directions[static_cast<std::size_t>(i)];
        EXPECT_NEAR(length(Vector3d(d)), 1, 1e-6);
        const double u = double(d.x) * d.x + double(d.y) * d.y;
        double v = std::atan2(d.y, d.x) / (2 * std::numbers::pi);
        if (v < 0) v += 1;
        const int rows = count / columns;
        cells.insert(static_cast<int>(u * columns) * rows + static_cast<int>(v * rows));
      }
      // Floats may lie a rounding beyond the edge of their cell.
      EXPECT_GE(static_cast<int>(cells.size()), count - count / 500) << columns;
    }
  };
  expect_spread(0, all);
  for (int pixel = 0; pixel < 64; ++pixel) expect_spread(pixel * samples, samples);
  // Other seeds, other directions.
  EXPECT_EQ(cosine_directions(samples, 5), directions);
  EXPECT_NE(cosine_directions(samples, 6), directions);
}

}  // namespace
}  // namespace motes
