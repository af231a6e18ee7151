// What a scene leaves open is filled in; what it says stays.
#include "render/resolve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <memory>

#include "core/error.h"
#include "field/probe.h"
#include "scene/fit.h"
#include "support/particles_at.h"

namespace motes {
namespace {

class CountedUpdates : public Progress {
 public:
  void update(std::string_view, double) override { ++count; }
  int count = 0;
};

/// Two particles apart, one field of both, and what they come to.
class Resolve : public testing::Test {
 protected:
  Resolve() { fields_[0].name = "all"; }
  ResolvedScene resolve_scene(Progress* progress = nullptr) const {
    return resolve(scene_, particles_, fields_, sources_, {}, kernels_, progress);
  }

  const ParticleSet particles_ = particles_at({{-3, 0, 0}, {3, 0, 0}});
  const std::vector<FieldSource> sources_{field_of_all(particles_, 0.5f, 1, {})};
  const KernelSet kernels_ = build_kernel_set(particles_, sources_);
  std::vector<Field> fields_{1};
  Scene scene_;
};

TEST_F(Resolve, FillsInWhatIsOpen) {
  scene_.render.width = 200;
  scene_.render.height = 100;
  CountedUpdates progress;
  const ResolvedScene resolved = resolve_scene(&progress);
  EXPECT_EQ(resolved.render, scene_.render);
  EXPECT_EQ(resolved.step_size, default_step_size(sources_, kernels_.box()));
  const Camera camera = fit_camera(scene_, visible_spheres(particles_, sources_), 2);
  EXPECT_EQ(resolved.camera.eye, camera.eye);
  EXPECT_EQ(resolved.camera.target, camera.target);
  EXPECT_GT(progress.count, 0);
  // Fitted to values that the field takes: at most 1 anywhere.
  ASSERT_EQ(resolved.transfer_functions.size(), 1u);
  const std::vector<TransferFunction::Point>& points = resolved.transfer_functions[0].points;
  ASSERT_GT(points.size(), 1u);
  EXPECT_GT(points.front().value, 0);
  EXPECT_GT(points.back().value, 0.1);
  EXPECT_LT(points.back().value, 1.01);
  EXPECT_GT(points.back().extinction, 0);
}

TEST_F(Resolve, MakesFieldsMoreOpaqueOverWhite) {
  const auto fitted = [&] {
    return resolve_scene().transfer_functions[0].points.back().extinction;
  };
  const double over_black = fitted();
  scene_.render.background = {1, 1, 1};
  EXPECT_GT(fitted(), over_black);
}

TEST_F(Resolve, MakesFieldsLessOpaqueAroundBalls) {
  GeometrySource balls;
  balls.index = {0};
  balls.radius = {0};
  const auto fitted = [&](const GeometrySource& geometry) {
    return resolve(scene_, particles_, fields_, sources_, geometry, kernels_)
        .transfer_functions[0]
        .points.back()
        .extinction;
  };
  EXPECT_LT(fitted(balls), 0.7 * fitted({}));
}

TEST_F(Resolve, KeepsWhatTheSceneSaysWithoutLookingAtTheData) {
  const TransferFunction function{{{1, {1, 0, 0}, 2}, {5, {0, 1, 0}, 3}}, false};
  fields_[0].transfer_function = function;
  fields_.push_back({});
  fields_[1].transfer_function = NamedTransferFunction{"magma", {{2, 7}}, 4.0, false};
  scene_.eye = {1, 2, 30};
  scene_.target = {1, 2, 3};
  scene_.up = {1, 0, 0};
  scene_.fov_degrees = 20;
  scene_.render.step_size = 0.125;
  const std::vector<FieldSource> sources{sources_[0], sources_[0]};
  CountedUpdates progress;
  const ResolvedScene resolved = resolve(scene_, particles_, fields_, sources, {},
                                         build_kernel_set(particles_, sources), &progress);
  EXPECT_EQ(resolved.camera.eye, scene_.eye);
  EXPECT_EQ(resolved.camera.target, scene_.target);
  EXPECT_EQ(resolved.camera.up, scene_.up);
  EXPECT_EQ(resolved.camera.fov_degrees, 20);
  EXPECT_EQ(resolved.step_size, 0.125);
  ASSERT_EQ(resolved.transfer_functions.size(), 2u);
  EXPECT_EQ(resolved.transfer_functions[0], function);
  EXPECT_EQ(resolved.transfer_functions[1], named_transfer_function("magma", 2, 7, 4, false));
  EXPECT_EQ(progress.count, 0) << "nothing is left to fit";
}

TEST_F(Resolve, FitsColoursToWhatTheCameraSees) {
  // Beside the particles: nothing but the empty space between them is in view.
  const auto highest = [this] { return resolve_scene().transfer_functions[0].points.back().value; };
  scene_.orthographic_height = 0.25;
  scene_.eye = {-3, 0, 10};
  scene_.target = {-3, 0, 0};
  scene_.render.width = scene_.render.height = 16;
  const double middle = highest();
  scene_.eye = {-3, 0.9, 10};
  scene_.target = {-3, 0.9, 0};
  EXPECT_LT(highest(), 0.6 * middle);  // near the kernel's edge
}

TEST_F(Resolve, ColoursIsosurfacesOfGridsBySign) {
  Grid grid;
  grid.dims = {2, 2, 2};
  grid.steps = {Vector3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  grid.values.assign(8, 1);
  std::vector<FieldSource> sources(1);
  sources[0].grid = std::make_shared<const Grid>(grid);
  const FieldColors& colors = sources[0].colors;
  const KernelSet kernels = build_kernel_set({}, sources);
  const auto colors_at = [&](const std::vector<Isosurface>& isosurfaces) {
    fields_[0].grid.emplace();
    fields_[0].isosurfaces = isosurfaces;
    std::vector<Color> all;
    for (const ResolvedIsosurface& surface :
         resolve(scene_, {}, fields_, sources, {}, kernels, nullptr, make_grid_fields(sources))
             .isosurfaces) {
      all.push_back(surface.colors.at(0));
    }
    return all;
  };
  EXPECT_THAT(colors_at({{0.5, {}, 1}, {0.6, {}, 1}}),
              testing::ElementsAre(colors.own, colors.own));
  EXPECT_THAT(colors_at({{0.5, {}, 1}, {-0.5, {}, 1}}),
              testing::ElementsAre(colors.positive, colors.negative));
}

/// Whether p is in the image of the camera.
bool is_seen(const Camera& camera, double aspect, const Point3d& p) {
  const CameraAxes axes = camera_axes(camera);
  const Vector3d v = p - camera.eye;
  const double half = half_height(camera) * dot(v, axes.forward);
  return std::abs(dot(v, axes.y)) <= half && std::abs(dot(v, axes.x)) <= aspect * half;
}

// Wherever a field of overlapping kernels exceeds the lowest level, and not far beyond.
RC_GTEST_PROP(ResolveIsosurfaces, FitTheCameraToTheSurfaceFarthestOut, ()) {
  const auto number = [](int low, int high) { return *rc::gen::inRange(low, high) / 16.0; };
  std::vector<Point3d> points;
  for (int n = *rc::gen::inRange(1, 40); n > 0; --n) {
    points.push_back({number(-32, 32), number(-32, 32), number(-32, 32)});
  }
  const ParticleSet particles = particles_at(points);
  const std::vector<FieldSource> sources{field_of_all(particles, 1, 1, {.support_factor = 5})};
  const KernelSet kernels = build_kernel_set(particles, sources);
  const double level = std::pow(10, -number(5, 60));
  Field field;
  field.isosurfaces = {{level, {}, 1}, {3 * level, {}, 1}};
  const double aspect = 1.5;
  Scene scene;
  scene.render.width = 300;
  scene.render.height = 200;
  const Camera camera = resolve(scene, particles, {field}, sources, {}, kernels).camera;
  double largest = 0;
  for (const Point3d& center : points) {
    // Around each particle, to where all kernels end.
    for (int k = 0; k < 2000; ++k) {
      const double z = (k + 0.5) / 1000 - 1, turn = 2.39996 * k, across = std::sqrt(1 - z * z);
      const Vector3d direction{across * std::cos(turn), across * std::sin(turn), z};
      const Point3d p = center + (k % 25) * 0.2 * direction;
      if (probe(kernels, std::vector{p})[0].value <= level) continue;
      RC_ASSERT(is_seen(camera, aspect, p));
      largest = std::max(largest, length(p - camera.target));
    }
  }
  RC_ASSERT(largest > 0.3 * half_height(camera) * length(camera.eye - camera.target));
}

TEST_F(Resolve, RefusesACameraThatCannotBe) {
  scene_.eye = {0, 5, 0};
  scene_.target = {0, 0, 0};
  scene_.up = {0, 1, 0};
  EXPECT_THAT([this] { resolve_scene(); },
              testing::ThrowsMessage<Error>(testing::StartsWith("camera.up: is parallel")));
}

}  // namespace
}  // namespace motes
