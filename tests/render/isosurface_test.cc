// Isosurfaces in pictures: those of a single kernel are balls.
#include <gtest/gtest.h>

#include <cmath>

#include "render/engine_check.h"
#include "render/renderer.h"

namespace motes {
namespace {

/// One Gaussian of radius 2 at the origin; at value v its isosurface is a ball of radius
/// 2 sqrt(-2 ln v).
PlainScene one_kernel() {
  PlainScene s = plain_scene({{0, 0, 0}}, 16);
  s.scene.fields[0].radius = {2};
  s.scene.fields[0].kernel.support_factor = 4;
  s.scene.step_size = 0.4;
  s.scene.render.lighting.enabled = true;
  s.scene.render.surface = {3, 0, {}, false, 0};
  return s;
}
float radius_at(double value) { return static_cast<float>(2 * std::sqrt(-2 * std::log(value))); }

GeometrySource ball(float radius, std::uint32_t srgb) {
  GeometrySource source;
  source.index = {0};
  source.radius = {radius};
  source.srgb = {srgb};
  return source;
}

TEST(Isosurface, OfOneKernelIsABallInTheVolume) {
  PlainScene s = one_kernel();
  GeometrySource geometry = ball(radius_at(0.5), 0x3366cc);
  const Renderer with_ball(s.particles, s.scene.fields, geometry);
  const Renderer alone(s.particles, s.scene.fields);
  ResolvedScene surface = s.scene;
  surface.isosurfaces = {{0, 0.5, 1, {color_from_srgb(0x3366cc)}}};
  for (const Way& way : all_ways()) {
    const Framebuffer expected = render_in(way, with_ball, s.scene);
    const ImageDifference difference = compare_images(render_in(way, alone, surface), expected);
    EXPECT_LE(difference.rms, 1e-3) << way.name();
    // One of a pixel's nine rays may graze the ball and not the surface.
    EXPECT_LE(difference.max, 0.06) << way.name();
  }
}

TEST(Isosurface, AloneLeavesWhatIsBehindInPart) {
  PlainScene s = one_kernel();
  s.scene.render.lighting.enabled = false;
  s.scene.camera.eye = {0, 0, 7};
  s.scene.transfer_functions = {{{{0, {}, 0}}}};
  const Color outer{1, 0, 0}, inner{0, 1, 0};
  s.scene.isosurfaces = {{0, 0.9, 0.25F, {inner}}, {0, 0.2, 0.5F, {outer}}};
  const auto middle = [&](const Renderer& renderer) {
    const Framebuffer image = renderer.render(s.scene, {});
    const float* const p = image.pixel(image.width / 2, image.height / 2);
    return std::vector<float>(p, p + 4);
  };
  // Outer, inner, inner, outer.
  const std::vector<float> empty = middle(Renderer(s.particles, s.scene.fields));
  const float front = 0.5F, green = 0.5F * (0.25F + 0.75F * 0.25F), left = 0.5F * 0.5625F;
  EXPECT_NEAR(empty[0], front + left * 0.5F, 1e-5);
  EXPECT_NEAR(empty[1], green, 1e-5);
  EXPECT_NEAR(empty[3], 1 - left * 0.5F, 1e-5);
  // A ball within all of it.
  GeometrySource within = ball(0.8F, 0x0000ff);
  const std::vector<float> filled = middle(Renderer(s.particles, s.scene.fields, within));
  EXPECT_NEAR(filled[0], front, 1e-5);
  EXPECT_NEAR(filled[1], 0.5F * 0.25F, 1e-5);
  EXPECT_NEAR(filled[2], 0.5F * 0.75F, 1e-5);
  EXPECT_NEAR(filled[3], 1, 1e-5);
}

TEST(Isosurface, HidesTheLightOfWhatIsWithinButForWhatIsCutAway) {
  // A ball within a surface, seen through where a plane cuts that open.
  PlainScene s = one_kernel();
  s.scene.transfer_functions = {{{{0, {}, 0}}}};
  s.scene.render.surface.occlusion_samples = 64;
  s.scene.render.surface.occlusion_distance = 6;
  s.scene.isosurfaces = {{0, 0.5, 1, {{1, 1, 1}}}};
  s.scene.camera.eye = {0, 0, 7};
  s.scene.camera.fov_degrees = 4;  // so that what a pixel shows is the middle of the ball
  GeometrySource within = ball(0.8F, 0xffffff);
  const auto brightness = [&](double plane, bool surface) {
    ResolvedScene scene = s.scene;
    scene.render.clip_planes = {{{0, 0, 1}, plane}};
    if (!surface) scene.isosurfaces.clear();
    const Framebuffer image = Renderer(s.particles, s.scene.fields, within).render(scene, {});
    return image.pixel(image.width / 2, image.height / 2)[0];
  };
  const float open = brightness(2, false);
  EXPECT_GT(open, 0.9F);
  for (const double plane : {1.2, 1.6, 2.0, 2.3}) {
    // The sky of the ball's front is what the hole shows of it: of angle t around the normal, a
    // part of sin^2 t.
    const double hole = radius_at(0.5) * radius_at(0.5) - plane * plane;
    const double part = hole / (hole + (plane - 0.8) * (plane - 0.8));
    // 64 directions a pixel, evened out over 16: a standard deviation of 0.016 at most. The
    // surface's samples are half a step apart, which moves the rim of the hole.
    EXPECT_NEAR(brightness(plane, true) / open, part, 0.06) << plane;
  }
}

// The far side of a translucent shell, seen beside a ball in its middle, which hides the part
// (r/R)^2 of the light from there and all of a lamp behind it.
TEST(Isosurface, ThatIsTranslucentLacksTheLightThatSolidsHide) {
  PlainScene s = one_kernel();
  constexpr int size = 48;
  s.scene.render.width = s.scene.render.height = size;
  s.scene.transfer_functions = {{{{0, {}, 0}}}};
  s.scene.camera.eye = {0, 0, 7};
  s.scene.camera.orthographic_height = 6;
  s.scene.isosurfaces = {{0, 0.5, 0.5F, {{1, 1, 1}}}};
  Lighting& lighting = s.scene.render.lighting;
  lighting.specular = 0;
  const double radius = 1.2, shell = radius_at(0.5);
  const auto beside = [&](bool with_ball) {
    GeometrySource within = with_ball ? ball(1.2F, 0xffffff) : GeometrySource{};
    const Framebuffer image = Renderer(s.particles, s.scene.fields, within).render(s.scene, {});
    return image.pixel(9, size / 2)[0];  // x = -1.81
  };
  s.scene.render.surface = {3, 64, {}, true, 0};
  lighting.ambient = 1;
  lighting.diffuse = 0;
  EXPECT_NEAR(beside(false), 0.5 + 0.25, 1e-5);
  const double open = 1 - radius * radius / (shell * shell);
  EXPECT_NEAR(beside(true), 0.5 + 0.25 * open, 0.25 * 0.03);
  for (const double light_angle : {0.0, 3.0}) {
    s.scene.render.surface = {3, 0, {}, true, light_angle};
    lighting.ambient = 0;
    lighting.diffuse = 1;
    lighting.lights = {{Vector3d{1.81, 0, std::sqrt(shell * shell - 1.81 * 1.81)}}};
    EXPECT_GT(beside(false), 0.1) << light_angle;
    EXPECT_NEAR(beside(true), 0, light_angle > 0 ? 0.01 : 0) << light_angle;
  }
}

// However many translucent levels there are, those that are opaque keep their rays to the light.
TEST(Isosurface, ThatIsOpaqueIsLitTheSameWithinTranslucentOnes) {
  // A cup around the view.
  PlainScene s = plain_scene(
      {{2, 0, 2}, {-2, 0, 2}, {0, 2, 2}, {0, -2, 2}, {1.3, 0, 0}, {-1.3, 0, 0}, {0, 0, -1}}, 12);
  s.scene.fields[0].radius = {1};
  s.scene.fields[0].kernel.support_factor = 4;
  s.scene.step_size = 0.2;
  s.scene.transfer_functions = {{{{0, {}, 0}}}};
  s.scene.render.lighting = {true, 1, 0, 0, 1};
  s.scene.render.surface = {3, 16, 20.0, true, 5};
  s.scene.isosurfaces = {{0, 0.6, 1, {{1, 1, 1}}}};
  const Renderer renderer(s.particles, s.scene.fields);
  const Framebuffer alone = renderer.render(s.scene, {});
  s.scene.render.surface.occlusion_samples = 0;
  EXPECT_GT(compare_images(renderer.render(s.scene, {}), alone).max, 0.02) << "no light is hidden";
  s.scene.render.surface.occlusion_samples = 16;
  for (const double value : {0.5, 0.4, 0.3, 0.2, 0.1}) {
    s.scene.isosurfaces.push_back({0, value, 0, {{1, 1, 1}}});
  }
  EXPECT_LE(compare_images(renderer.render(s.scene, {}), alone).max, 1e-5);
}

TEST(Isosurface, ThatIsTranslucentTakesNoLight) {
  PlainScene s = one_kernel();
  s.scene.transfer_functions = {{{{0, {}, 0}}}};
  s.scene.render.surface = {3, 64, {}, true, 5};
  s.scene.render.lighting.lights = {{Vector3d{1, 1, 1}}};
  s.scene.camera.eye = {0, 0, 7};
  GeometrySource within = ball(0.8F, 0xffffff);
  const Renderer renderer(s.particles, s.scene.fields, within);
  const Framebuffer alone = renderer.render(s.scene, {});
  // A shell that is not seen itself: the ball within is as bright as without it.
  s.scene.isosurfaces = {{0, 0.5, 0, {{1, 1, 1}}}};
  EXPECT_LE(compare_images(renderer.render(s.scene, {}), alone).max, 1e-5);
}

TEST(Isosurface, HasNoShadowsOfItsOwnWhereItIsConvex) {
  PlainScene s = one_kernel();
  s.scene.transfer_functions = {{{{0, {}, 0}}}};
  s.scene.isosurfaces = {{0, 0.5, 1, {{1, 1, 1}}}};
  const Renderer renderer(s.particles, s.scene.fields);
  const Framebuffer expected = renderer.render(s.scene, {});
  s.scene.render.surface.occlusion_samples = 16;
  EXPECT_LE(compare_images(renderer.render(s.scene, {}), expected).max, 1e-5);
}

TEST(Isosurface, IsTheSameForAnyNumberOfThreads) {
  PlainScene s = one_kernel();
  s.scene.render.width = 150;
  s.scene.render.height = 140;
  s.scene.isosurfaces = {{0, 0.5, 0.5F, {{1, 1, 1}}}, {0, 0.7, 1, {{1, 0, 0}}}};
  const Renderer renderer(s.particles, s.scene.fields);
  const Framebuffer one = renderer.render(s.scene, {.threads = 1});
  EXPECT_EQ(renderer.render(s.scene, {.threads = 3}).rgba, one.rgba);
}

TEST(Isosurface, IsCutByClipPlanes) {
  PlainScene s = one_kernel();
  s.scene.render.lighting.enabled = false;
  s.scene.transfer_functions = {{{{0, {}, 0}}}};
  s.scene.isosurfaces = {{0, 0.5, 1, {{1, 1, 1}}}};
  s.scene.render.clip_planes = {{{1, 0, 0}, 0}};
  const Renderer renderer(s.particles, s.scene.fields);
  const Framebuffer image = renderer.render(s.scene, {});
  EXPECT_EQ(image.pixel(image.width / 2 + 1, image.height / 2)[3], 0);
  EXPECT_EQ(image.pixel(image.width / 2 - 2, image.height / 2)[3], 1);
}

}  // namespace
}  // namespace motes
