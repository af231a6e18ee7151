// Balls and sticks in pictures: alone, in the volume, and of particles that no field has.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/engine_check.h"
#include "render/renderer.h"

namespace motes {
namespace {

/// Balls of that radius for some particles, all of one colour.
GeometrySource balls(std::vector<std::uint32_t> index, float radius) {
  GeometrySource source;
  source.radius.assign(index.size(), radius);
  source.srgb.assign(index.size(), 0x3366cc);
  source.index = std::move(index);
  return source;
}

/// Particles on a grid, off the axes.
std::vector<Point3d> some_points() {
  std::vector<Point3d> points;
  points.reserve(60);
  for (int i = 0; i < 60; ++i) {
    const int column = i % 4, row = i / 4 % 4, plane = i / 16;
    points.push_back({1.7 * column - 2.6, 1.9 * row - 2.7, 1.6 * plane - 2.4});
  }
  return points;
}

TEST(DrawnOnly, ParticlesAddNothingToTheFields) {
  PlainScene s = plain_scene(some_points(), 16);
  // The field has a third of the particles; all the others are in the tree to be drawn.
  FieldSource& field = s.scene.fields[0];
  field.index.clear();
  GeometrySource geometry;
  std::vector<std::uint32_t> others;
  for (std::uint32_t i = 0; i < s.particles.size(); ++i) {
    (i % 3 == 0 ? field.index : others).push_back(i);
  }
  const Renderer alone(s.particles, s.scene.fields);
  // Balls so small that no ray meets one.
  geometry = balls(others, 1e-6F);
  const Renderer with(s.particles, s.scene.fields, geometry);
  EXPECT_EQ(with.kernels().size(), s.particles.size());
  EXPECT_EQ(with.kernels().box().min, alone.kernels().box().min);
  s.scene.render.lighting.enabled = true;
  for (const Way& way : all_ways()) {
    const Framebuffer expected = render_in(way, alone, s.scene);
    EXPECT_LE(compare_images(render_in(way, with, s.scene), expected).max, 2e-5) << way.name();
  }
}

TEST(Geometry, HasTheColoursOfTheFirstFieldThatHasTheParticle) {
  // Three balls far apart: of both fields, of the second alone and of none.
  PlainScene s = plain_scene({{-4, 0, 0}, {0, 0, 0}, {4, 0, 0}}, 16);
  FieldSource second = s.scene.fields[0];
  s.scene.fields[0].index = {0};
  second.index = {0, 1};
  second.name = "second";
  second.weight = {0.75F};
  s.scene.fields.push_back(second);
  s.scene.transfer_functions = {{{{0, {0, 1, 0}, 0}, {2, {1, 0, 0}, 0}}},
                                {{{0, {0, 0, 1}, 0}, {1, {1, 1, 0}, 0}}}};
  s.scene.render.surface = {1, 0, {}, false, 0};
  s.scene.render.lighting.enabled = false;
  GeometrySource geometry = balls({0, 1, 2}, 1.5F);
  for (std::uint32_t& color : geometry.srgb) color |= for_want_of_field;
  const Renderer renderer(s.particles, s.scene.fields, geometry);
  const Framebuffer image = renderer.render(s.scene, {});
  const auto expect_color = [&](double x, const Color& expected) {
    const double scale =
        image.height / (2 * 16 * std::tan(s.scene.camera.fov_degrees / 360 * M_PI));
    const float* const c =
        image.pixel(static_cast<int>(image.width / 2.0 + x * scale), image.height / 2);
    EXPECT_NEAR(c[0], expected.r, 0.01) << x;
    EXPECT_NEAR(c[1], expected.g, 0.01) << x;
    EXPECT_NEAR(c[2], expected.b, 0.01) << x;
  };
  expect_color(-4, {0.5F, 0.5F, 0});
  expect_color(0, {0.75F, 0.75F, 0.25F});
  expect_color(4, color_from_srgb(0x3366cc));
}

TEST(Geometry, IsCutByClipPlanes) {
  PlainScene s = plain_scene(some_points(), 16);
  s.scene.render.clip_planes = {{{2, 1, -1}, 1.1}, {{0, 0, 1}, 1.5}};
  std::vector<std::uint32_t> all, left;
  for (std::uint32_t i = 0; i < s.particles.size(); ++i) {
    all.push_back(i);
    const Vector3d x = s.particles.position(i) - Point3d{};
    if (dot({2, 1, -1}, x) <= 1.1 * std::sqrt(6) && x.z <= 1.5) left.push_back(i);
  }
  ASSERT_GT(left.size(), 10u);
  ASSERT_LT(left.size(), 50u);
  const auto render_balls = [&](const std::vector<std::uint32_t>& index) {
    GeometrySource geometry = balls(index, 0.7F);
    return Renderer(s.particles, {}, geometry).render(s.scene, {});
  };
  s.scene.transfer_functions.clear();
  const Framebuffer cut = render_balls(all);
  s.scene.render.clip_planes.clear();
  EXPECT_EQ(cut.rgba, render_balls(left).rgba);
  EXPECT_NE(cut.rgba, render_balls(all).rgba);
}

/// A ball in front of a lone kernel, and one behind it.
TEST(Geometry, CutsTheVolumeWhereRaysMeetIt) {
  PlainScene s = plain_scene({{0, 0, 0}, {0, 0, 3}, {0.3, 0, -3}}, 16);
  s.scene.fields[0].index = {0};
  s.scene.render.surface.antialiasing = 1;
  s.scene.render.surface.occlusion_samples = 0;
  s.scene.render.lighting.enabled = true;
  s.scene.render.lighting.ambient = 1;
  s.scene.render.lighting.diffuse = s.scene.render.lighting.specular = 0;
  s.scene.transfer_functions = {ramp(1, 0.5)};
  GeometrySource geometry = balls({1, 2}, 0.7F);
  const Renderer renderer(s.particles, s.scene.fields, geometry);
  // The reference's layers, from closed forms: ambient light alone, so that colours are constant.
  const Color blue = color_from_srgb(0x3366cc);
  const int width = s.scene.render.width, height = s.scene.render.height;
  std::vector<std::vector<reference::Layer>> layers;
  for (int i = 0; i < width * height; ++i) {
    auto& of_pixel = layers.emplace_back();
    const reference::CameraRay ray =
        reference::camera_ray(s.scene.camera, width, height, i % width, i / width);
    for (const Point3d& center : {Point3d{0, 0, 3}, Point3d{static_cast<double>(0.3F), 0, -3}}) {
      const Vector3d to = center - ray.origin;
      const double a = dot(ray.direction, ray.direction), b = dot(ray.direction, to);
      const double radius = 0.7F, c = dot(to, to) - radius * radius;
      if (b * b - a * c < 0) continue;
      of_pixel.push_back({(b - std::sqrt(b * b - a * c)) / a, 1, blue.r, blue.g, blue.b});
    }
  }
  const reference::Image truth = reference::render(s.particles, s.scene, layers);
  for (const Way& way : all_ways()) {
    const ImageDifference difference =
        compare_images(render_in(way, renderer, s.scene), to_framebuffer(truth), truth.unstable);
    EXPECT_LE(difference.max, 1e-3) << way.name();
  }
}

TEST(Geometry, JoinsBondsByDistanceToThoseOfTheFile) {
  PlainScene s = plain_scene({{0, 0, 0}, {1.5, 0, 0}, {5, 0, 0}}, 16);
  s.particles.species_names = {"C"};
  s.particles.species = {0, 0, 0};
  const auto bonds = [&](const std::vector<Bond>& of_file, bool by_distance) {
    GeometrySource geometry = balls({0, 1, 2}, 0.2F);
    geometry.stick_radius = 0.1F;
    geometry.bonds = of_file;
    if (by_distance) geometry.bonds_among = {true, true, true};
    const Renderer renderer(s.particles, s.scene.fields, geometry);
    return geometry.bonds;
  };
  EXPECT_EQ(bonds({}, true), (std::vector<Bond>{{0, 1}}));
  EXPECT_EQ(bonds({{0, 2}}, false), (std::vector<Bond>{{0, 2}}));
  EXPECT_EQ(bonds({{0, 1}, {1, 2}}, true), (std::vector<Bond>{{0, 1}, {1, 2}})) << "each once";
}

TEST(Geometry, IsDrawnWithoutAnyField) {
  PlainScene s = plain_scene(some_points(), 16);
  s.scene.fields.clear();
  s.scene.transfer_functions.clear();
  std::vector<std::uint32_t> all(s.particles.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  GeometrySource geometry = balls(all, 0.6F);
  const Renderer renderer(s.particles, {}, geometry);
  const Framebuffer image = renderer.render(s.scene, {});
  float opaque = 0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    EXPECT_LE(image.rgba[i], 1.00001F);
    opaque = std::max(opaque, image.rgba[i]);
  }
  EXPECT_FLOAT_EQ(opaque, 1);
  // The same for any number of threads.
  EXPECT_EQ(image, renderer.render(s.scene, {.threads = 1}));
}

TEST(Geometry, IsInTheLightOfTheDirectionsThatASeedDraws) {
  PlainScene s = plain_scene(some_points(), 16);
  std::vector<std::uint32_t> all(s.particles.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  GeometrySource geometry = balls(all, 1);
  s.scene.transfer_functions.clear();
  const Renderer renderer(s.particles, {}, geometry);
  const Framebuffer image = renderer.render(s.scene, {});
  EXPECT_EQ(renderer.render(s.scene, {}), image);
  s.scene.render.surface.seed = 1;
  const double difference = compare_images(renderer.render(s.scene, {}), image).max;
  EXPECT_GT(difference, 0);
  EXPECT_LT(difference, 0.1);  // noise, and little of it
}

TEST(Geometry, EdgesAreAntialiasedWithoutMoreSamplesOfTheVolume) {
  PlainScene s = plain_scene({{0, 0, 0}, {0.4, 0.3, 2}}, 12);
  GeometrySource geometry = balls({1}, 0.9F);
  const Renderer renderer(s.particles, s.scene.fields, geometry);
  RenderStatistics one, nine;
  s.scene.render.surface.antialiasing = 1;
  const Framebuffer hard = renderer.render(s.scene, {}, &one);
  s.scene.render.surface.antialiasing = 3;
  const Framebuffer soft = renderer.render(s.scene, {}, &nine);
  EXPECT_GT(compare_images(hard, soft).max, 0.05);
  // Rays at edges go on behind the ball.
  EXPECT_LT(static_cast<double>(nine.samples), 1.2 * static_cast<double>(one.samples));
}

}  // namespace
}  // namespace motes
