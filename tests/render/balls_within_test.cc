// Balls inside of isosurfaces: that they are inside, and that they hide what the surfaces hide.
#include "render/balls_within.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "render/engine_check.h"
#include "render/renderer.h"

namespace motes {
namespace {

ResolvedIsosurface level(double value, float opacity = 1) {
  return {0, value, opacity, {{1, 1, 1}}};
}

/// Three kernels far from each other, of weights 1, 2 and 0.5.
PlainScene three_kernels(KernelType type) {
  PlainScene s = plain_scene({{0, 0, 0}, {50, 0, 0}, {0, 50, 0}}, 16);
  s.scene.fields[0].kernel.shape.type = type;
  s.scene.fields[0].radius = {1.5F, 1, 2};
  s.scene.fields[0].weight = {1, 2, 0.5F};
  return s;
}

TEST(BallsWithin, AreWithinTheSurfacesAndNearlyFillThem) {
  for (const KernelType type : {KernelType::gaussian, KernelType::cubic_spline,
                                KernelType::quintic_spline, KernelType::wendland_c2}) {
    PlainScene s = three_kernels(type);
    s.scene.fields[0].kernel.kernel_scale = 0.8;
    const KernelSet kernels = build_kernel_set(s.particles, s.scene.fields);
    for (const double value : {0.2, 0.6, 1.2}) {
      const auto balls = balls_within(kernels, {level(0.01), level(value), level(9, 0.5F)});
      ASSERT_TRUE(balls);
      for (std::size_t i = 0; i < kernels.size(); ++i) {
        const double weight =
            0.8 * static_cast<double>(kernels.weight[i]) / kernels.fields[0].value_scale;
        const auto field_at = [&](double distance) {
          const double q = distance / static_cast<double>(kernels.radius[i]);
          return weight * evaluate(s.scene.fields[0].kernel, q).value;
        };
        const double radius = static_cast<double>(balls->radius[i]);
        if (weight <= value) {
          EXPECT_EQ(radius, 0) << weight << " " << value;
          continue;
        }
        EXPECT_GT(field_at(radius), value);
        EXPECT_LE(field_at(radius / 0.96), value);
      }
    }
  }
}

// Of two fields whose kernels are as high, but not as wide.
TEST(BallsWithin, AreThoseOfEachFieldsKernel) {
  PlainScene s = three_kernels(KernelType::gaussian);
  s.scene.fields[0].weight = {1};
  s.scene.fields[0].radius = {1};
  s.scene.fields.push_back(s.scene.fields[0]);
  s.scene.fields[1].kernel.shape.type = KernelType::wendland_c2;
  const KernelSet kernels = build_kernel_set(s.particles, s.scene.fields);
  const auto balls = balls_within(kernels, {level(0.5), {1, 0.5, 1, {{1, 1, 1}}}});
  ASSERT_TRUE(balls);
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const Kernel& kernel = s.scene.fields[kernels.field_of(i)].kernel;
    const double q = static_cast<double>(balls->radius[i]) / (0.97 * kernels.length_scale);
    EXPECT_NEAR(evaluate(kernel, q).value, 0.5, 1e-4) << kernels.field_of(i);
  }
}

TEST(BallsWithin, AreNoneWhereAKernelAloneSaysNothing) {
  PlainScene s = three_kernels(KernelType::gaussian);
  const auto any = [&](const ResolvedIsosurface& isosurface) {
    return balls_within(build_kernel_set(s.particles, s.scene.fields), {isosurface}).has_value();
  };
  EXPECT_TRUE(any(level(0.5)));
  EXPECT_FALSE(any(level(0.5, 0.9F))) << "translucent";
  EXPECT_FALSE(any(level(-0.5)));
  EXPECT_FALSE(any(level(3))) << "above all peaks";
  s.scene.fields[0].weight = {1, 2, -0.5F};
  EXPECT_FALSE(any(level(0.5))) << "another may take away what one gives";
  s.scene.fields[0].weight = {1, 2, 0.5F};
  s.scene.fields[0].kernel.shape.type = KernelType::tabulated;
  s.scene.fields[0].kernel.shape.profile.values = {1, 0.2, 0.8, 0};
  EXPECT_FALSE(any(level(0.5)));
}

// The inside of a bowl is nearly as dark as rays without end find it.
TEST(BallsWithin, HideTheLightOfHollows) {
  std::vector<Point3d> points;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < 300; ++i) {
    const double z = -6 * (i + 0.5) / 300, r = std::sqrt(36 - z * z);
    points.push_back({r * std::cos(golden * i), r * std::sin(golden * i), z});
  }
  PlainScene s = plain_scene(points, 16);
  s.scene.fields[0].radius = {0.8F};
  s.scene.fields[0].kernel.support_factor = 4;
  s.scene.step_size = 0.4;
  s.scene.transfer_functions = {{{{0, {}, 0}}}};
  s.scene.isosurfaces = {level(0.5)};
  s.scene.render.lighting = {true, 1, 0, 0, 1, {}};  // nothing but ambient light
  s.scene.render.surface = {1, 64, {}, false, 0};
  s.scene.camera.eye = {0, 0, 30};
  s.scene.camera.fov_degrees = 8;
  const Renderer renderer(s.particles, s.scene.fields);
  const auto brightness = [&](std::optional<double> distance) {
    ResolvedScene scene = s.scene;
    scene.render.surface.occlusion_distance = distance;
    const Framebuffer image = renderer.render(scene, {});
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        sum += static_cast<double>(image.pixel(x, y)[0]);
      }
    }
    return sum / (image.width * image.height);
  };
  const double all = brightness(40), near = brightness(4), by_default = brightness({});
  EXPECT_LT(all, 0.8 * near);
  EXPECT_GE(by_default, all - 1e-6) << "what hides light without being there";
  EXPECT_LT(by_default, all + 0.3 * (near - all));
}

}  // namespace
}  // namespace motes
