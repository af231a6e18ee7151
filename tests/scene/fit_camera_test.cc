// Cameras that show all of the data and fill the image.
#include "scene/fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <span>

#include "core/error.h"
#include "scene/fit_levels.h"

namespace motes {
namespace {

/// Coordinates of `p` in the image, -1 to 1 from edge to edge; NaN behind the camera.
std::pair<double, double> project(const Camera& camera, double aspect, const Point3d& p) {
  const CameraAxes axes = camera_axes(camera);
  const Vector3d v = p - camera.eye;
  const double depth = dot(v, axes.forward);
  if (!(depth > 0)) return {NAN, NAN};
  const double half_height = camera.orthographic_height
                                 ? *camera.orthographic_height / 2
                                 : depth * std::tan(camera.fov_degrees * M_PI / 360);
  return {dot(v, axes.x) / half_height / aspect, dot(v, axes.y) / half_height};
}

/// Points at the corners of `box`, which fill it for the fitting.
std::vector<VisibleSphere> corners_of(const Bounds3d& box) {
  std::vector<VisibleSphere> corners;
  for (const double x : {box.min.x, box.max.x}) {
    for (const double y : {box.min.y, box.max.y}) {
      for (const double z : {box.min.z, box.max.z}) corners.push_back({{x, y, z}, 0});
    }
  }
  return corners;
}

double extent_in_image(const Camera& camera, double aspect, const Bounds3d& box) {
  double extent = 0;
  for (const VisibleSphere& corner : corners_of(box)) {
    const auto [u, v] = project(camera, aspect, corner.center);
    if (std::isnan(u)) return NAN;
    extent = std::max({extent, std::abs(u), std::abs(v)});
  }
  return extent;
}

RC_GTEST_PROP(FitCamera, ShowsTheWholeBoxAndFillsTheImage, ()) {
  const auto number = [](int low, int high) { return *rc::gen::inRange(low, high) / 16.0; };
  const Point3d corner{number(-9999, 9999), number(-9999, 9999), number(-9999, 9999)};
  const Bounds3d box{corner, corner + Vector3d{number(0, 999), number(0, 999), number(1, 999)}};
  const double aspect = number(4, 64);
  Scene scene;
  if (*rc::gen::arbitrary<bool>()) scene.fov_degrees = number(16, 2870);
  if (*rc::gen::arbitrary<bool>()) scene.up = Vector3d{number(-99, 99), number(1, 99), 0};
  const Camera camera = fit_camera(scene, corners_of(box), aspect);
  const double extent = extent_in_image(camera, aspect, box);
  RC_ASSERT(extent < 0.98);
  double nearest = INFINITY;
  for (const VisibleSphere& point : corners_of(box)) {
    nearest = std::min(nearest, dot(point.center - camera.eye, camera_axes(camera).forward));
  }
  const double room = scene.fov_degrees ? 0.05 : 0.3;  // of the diagonal
  const bool is_as_near_as_may_be = nearest < 1.002 * room * length(box.diagonal());
  RC_ASSERT(extent > 0.9 || is_as_near_as_may_be);
}

RC_GTEST_PROP(FitCamera, ShowsAllHoweverWideTheView, ()) {
  const auto number = [](int low, int high) { return *rc::gen::inRange(low, high) / 16.0; };
  std::vector<VisibleSphere> spheres = corners_of({{-3, 5, 7}, {number(-32, 99), 9, 11}});
  const double radius = number(0, 32);
  Bounds3d box;
  for (VisibleSphere& sphere : spheres) {
    sphere.radius = radius;
    for (const double r : {-radius, radius}) box.add(sphere.center + Vector3d{r, r, r});
  }
  const double diagonal = length(box.diagonal());
  const double aspect = number(4, 64);
  Scene scene;
  scene.fov_degrees = 180 - std::pow(10, -number(-32, 208));
  if (*rc::gen::arbitrary<bool>()) scene.target = {number(-64, 64), 7, 9};
  const Camera camera = fit_camera(scene, spheres, aspect);
  const CameraAxes axes = camera_axes(camera);
  const double tan_y = std::tan(camera.fov_degrees * M_PI / 360);
  for (const VisibleSphere& sphere : spheres) {
    const Vector3d v = sphere.center - camera.eye;
    const double depth = dot(v, axes.forward);
    RC_ASSERT(depth - radius >= 0.05 * diagonal * (1 - 1e-6));
    for (const auto& [across, tangent] :
         {std::pair(axes.x, tan_y * aspect), std::pair(axes.y, tan_y)}) {
      const double reach = std::abs(dot(v, across)) + radius * std::sqrt(1 + tangent * tangent);
      RC_ASSERT(reach <= tangent * depth * (1 + 1e-6));
    }
  }
}

TEST(FitCamera, LooksAtTheLargestFace) {
  const auto forward = [](double x, double y, double z) {
    return camera_axes(fit_camera({}, corners_of({{0, 0, 0}, {x, y, z}}), 1)).forward;
  };
  EXPECT_LT(forward(10, 10, 10).z, -0.8);
  EXPECT_LT(forward(10, 10, 2).z, -0.8);
  EXPECT_LT(forward(2, 10, 10).x, -0.8);
  EXPECT_GT(forward(10, 2, 10).y, 0.8);
  EXPECT_EQ(forward(10, 10, 0), (Vector3d{0, 0, -1}));
  EXPECT_EQ(fit_camera({}, corners_of({{0, 0, 0}, {10, 2, 10}}), 1).up, (Vector3d{0, 0, 1}));
}

TEST(FitCamera, KeepsWhatTheSceneSays) {
  const Bounds3d box{{0, 0, 0}, {2, 2, 2}};
  Scene scene;
  scene.eye = {1, 9, 1};
  Camera camera = fit_camera(scene, corners_of(box), 1);
  EXPECT_EQ(camera.eye, (Point3d{1, 9, 1}));
  EXPECT_EQ(camera.target, (Point3d{1, 1, 1}));
  EXPECT_EQ(camera.up, (Vector3d{0, 0, 1})) << "y would be parallel to the view";
  scene.eye = {1, 1, 1};
  EXPECT_NO_THROW(fit_camera(scene, corners_of(box), 1));
  scene.target = {1, 1, 1};
  EXPECT_THROW(fit_camera(scene, corners_of(box), 1), Error);
  scene.eye.reset();
  scene.target = {0, 0, 0};
  camera = fit_camera(scene, corners_of(box), 1);
  EXPECT_EQ(camera.target, (Point3d{0, 0, 0}));
  EXPECT_LT(extent_in_image(camera, 1, box), 0.98);
  scene.orthographic_height = 5;
  EXPECT_FALSE(std::isnan(extent_in_image(fit_camera(scene, corners_of(box), 1), 1, box)));
}

/// What spheres come to in the image: -1 to 1 from edge to edge.
struct Extent {
  double left = 1, right = -1, bottom = 1, top = -1;
};

Extent extent_of(const std::vector<VisibleSphere>& spheres, const Camera& camera, double aspect) {
  Extent extent;
  for (const VisibleSphere& sphere : spheres) {
    const auto [u, v] = project(camera, aspect, sphere.center);
    extent.left = std::min(extent.left, u);
    extent.right = std::max(extent.right, u);
    extent.bottom = std::min(extent.bottom, v);
    extent.top = std::max(extent.top, v);
  }
  return extent;
}

/// Points on a ball's surface.
std::vector<VisibleSphere> ball(std::size_t count) {
  std::vector<VisibleSphere> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(count) - 1;
    const double around = 2.399963 * static_cast<double>(i), r = std::sqrt(1 - z * z);
    points.push_back({{r * std::cos(around), r * std::sin(around), z}, 0});
  }
  return points;
}

TEST(FitCamera, FillsTheImageWithABallWhoseBoxWouldNeedMoreRoom) {
  const auto points = ball(5000);
  const Extent extent = extent_of(points, fit_camera({}, points, 1), 1);
  for (const double edge : {-extent.left, extent.right, -extent.bottom, extent.top}) {
    EXPECT_NEAR(edge, 0.96, 0.01);
  }
}

TEST(FitCamera, LooksFromTheSameSideHoweverLargeAllIs) {
  const Camera usual = fit_camera({}, ball(100), 1);
  const Vector3d direction = normalize(usual.eye - usual.target);
  for (const double scale : {1e-20, 1e8, 1e16, 1e24}) {
    auto points = ball(100);
    for (VisibleSphere& point : points) point.center = Point3d{} + scale * Vector3d(point.center);
    const Camera camera = fit_camera({}, points, 1);
    EXPECT_LT(length(normalize(camera.eye - camera.target) - direction), 1e-6) << scale;
  }
}

TEST(FitCamera, LooksNoWiderInWidePictures) {
  const auto points = ball(100);
  EXPECT_EQ(fit_camera({}, points, 16. / 9).fov_degrees, 45);
  EXPECT_EQ(fit_camera({}, points, 0.2).fov_degrees, 45);
  const double tangent = 3 * std::tan(fit_camera({}, points, 3).fov_degrees * M_PI / 360);
  EXPECT_NEAR(2 * std::atan(tangent) * 180 / M_PI, 75, 1e-9);
  Scene scene;
  scene.eye = {0, 0, 9};
  EXPECT_EQ(fit_camera(scene, points, 3).fov_degrees, 45);
}

TEST(FitCamera, KeepsAwayFromAFewBallsBehindEachOther) {
  const std::vector<VisibleSphere> two{{{0.4, 0.3, 1}, 0.3}, {{-0.4, -0.3, -1}, 0.3}};
  const Camera camera = fit_camera({}, two, 1);
  const double nearer = length(camera.eye - two[0].center),
               farther = length(camera.eye - two[1].center);
  EXPECT_GT(nearer / farther, 0.35);
}

TEST(FitCamera, HoldsWholeSpheres) {
  // A sphere of radius 1 at distance d fills the image where sin(fov / 2) = 1 / d.
  Scene scene;
  scene.fov_degrees = 60;
  const std::vector<VisibleSphere> one{{{5, 6, 7}, 1}};
  const Camera camera = fit_camera(scene, one, 1);
  const double tangent = 0.96 * std::tan(M_PI / 6);
  EXPECT_NEAR(length(camera.eye - one[0].center), std::sqrt(1 + tangent * tangent) / tangent, 1e-9);
}

TEST(FitCamera, IsNotMovedByFarStraysButShowsSmallNumbersOfParticles) {
  const auto points = ball(5000);
  const Camera camera = fit_camera({}, points, 1);
  auto with_strays = points;
  with_strays.push_back({{100, 0, 0}, 0});
  with_strays.push_back({{0, -1e6, 0}, 0});
  EXPECT_LT(length(fit_camera({}, with_strays, 1).eye - camera.eye), 0.02);

  auto cloud = points;  // too many for strays
  for (int i = 0; i < 50; ++i) cloud.push_back({{100, 0.1 * i, 0}, 0});
  EXPECT_LT(extent_of(cloud, fit_camera({}, cloud, 1), 1).right, 0.97);

  auto near = points;  // not far enough
  near.push_back({{1.8, 0, 0}, 0});
  EXPECT_LT(extent_of(near, fit_camera({}, near, 1), 1).right, 0.97);

  auto few = ball(10);
  few.push_back({{100, 0, 0}, 0});
  EXPECT_LT(extent_of(few, fit_camera({}, few, 1), 1).right, 0.97);
}

TEST(VisibleSpheres, AreAsLargeAsGaussiansAreSeenAndNotOutsized) {
  ParticleSet particles;
  particles.origin = {10, 20, 30};
  for (auto* axis : {&particles.x, &particles.y, &particles.z}) axis->assign(9, 1);
  std::vector<FieldSource> fields(1);
  fields[0].index = {0, 2, 4};
  fields[0].radius = {3, 3, 1000};
  const auto spheres = visible_spheres(particles, fields);
  ASSERT_EQ(spheres.size(), 3u);
  EXPECT_EQ(spheres[0].center, (Point3d{11, 21, 31}));
  EXPECT_EQ(spheres[0].radius, 1.75 * 3);
  EXPECT_EQ(spheres[2].radius, 2.5 * 1.75 * 3);
  fields[0].kernel.support_factor = 1;
  EXPECT_EQ(visible_spheres(particles, fields)[0].radius, 3) << "nothing is beyond the support";
}

TEST(VisibleSpheres, HoldBallsWholeWhateverTheSizeOfOthers) {
  ParticleSet particles;
  for (auto* axis : {&particles.x, &particles.y, &particles.z}) axis->assign(5, 1);
  GeometrySource geometry;
  geometry.index = {0, 1, 2, 3, 4};
  geometry.radius = {1, 1, 1, 1, 100};
  EXPECT_EQ(visible_spheres(particles, {}, geometry).back().radius, 100);
}

TEST(VisibleSpheres, HoldSticksThatLeaveTheCell) {
  ParticleSet particles;
  particles.x = {1, 9, 5, 6, NAN};
  particles.y = particles.z = {5, 5, 5, 5, 5};
  particles.cell = Cell{{0, 0, 0}, {Vector3d{10, 0, 0}, {0, 10, 0}, {0, 0, 10}}};
  GeometrySource geometry;
  geometry.index = {0, 1, 2, 3};
  geometry.radius.assign(4, 0.5f);
  geometry.stick_radius = 0.25f;
  geometry.bonds = {{2, 3}};
  EXPECT_EQ(visible_spheres(particles, {}, geometry).size(), 4u);
  geometry.bonds = {{0, 1}, {2, 3}, {2, 4}};
  auto spheres = visible_spheres(particles, {}, geometry);
  ASSERT_EQ(spheres.size(), 6u);
  EXPECT_EQ(spheres[4].center, (Point3d{0, 5, 5}));
  EXPECT_EQ(spheres[5].center, (Point3d{10, 5, 5}));
  EXPECT_EQ(spheres[4].radius, 0.25);
  particles.cell->periodic[0] = false;
  EXPECT_EQ(visible_spheres(particles, {}, geometry).size(), 4u);
  particles.cell->periodic[0] = true;
  geometry.bonds = {{2, 3, {1, 0, 0}}};  // to the image at 16
  spheres = visible_spheres(particles, {}, geometry);
  ASSERT_EQ(spheres.size(), 6u);
  EXPECT_EQ(spheres[4].center, (Point3d{10.5, 5, 5}));
  EXPECT_EQ(spheres[5].center, (Point3d{0.5, 5, 5}));
}

/// A bell of height 1 and width 1 around (2, 3, 4), on 0 to 20 by half a length.
FieldSource bell() {
  Grid grid;
  grid.dims = {41, 41, 41};
  grid.steps = {Vector3d{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}};
  grid.values.resize(grid.size());
  for (std::size_t n = 0; n < grid.size(); ++n) {
    const std::size_t row = n / 41, plane = row / 41;
    const Point3d p = grid.position(static_cast<double>(n % 41), static_cast<double>(row % 41),
                                    static_cast<double>(plane));
    const Vector3d off = p - Point3d{2, 3, 4};
    grid.values[n] = static_cast<float>(std::exp(-0.5 * dot(off, off)));
  }
  FieldSource source;
  source.grid = std::make_shared<const Grid>(std::move(grid));
  return source;
}

double farthest_x(const std::vector<VisibleSphere>& spheres) {
  double x = -1;
  for (const VisibleSphere& sphere : spheres) x = std::max(x, sphere.center.x);
  return x;
}

TEST(VisibleSpheres, HoldWhatAGridShows) {
  const FieldSource source = bell();
  const auto spheres = visible_spheres({}, {source});
  // 85 % of a bell lie within 2.3 widths, where it is 0.07; it comes to three tenths of that
  // at 2.78.
  EXPECT_NEAR(farthest_x(spheres), 2 + 2.78 + 0.5, 0.5);
  for (const VisibleSphere& sphere : spheres) {
    EXPECT_GE(sphere.center.x, 0);
    EXPECT_LT(length(sphere.center - Point3d{2, 3, 4}), 2.78 + 0.51) << "no corners of boxes";
  }
  Field low;
  low.isosurfaces.push_back({1e-6, {}, 1});  // 5.26 widths
  EXPECT_NEAR(farthest_x(visible_spheres({}, {source}, {}, {low})), 2 + 5.26 + 0.5, 0.5);
  Field high;
  high.isosurfaces.push_back({0.5, {}, 1});  // 1.18 widths, and no volume
  EXPECT_NEAR(farthest_x(visible_spheres({}, {source}, {}, {high})), 2 + 1.18 + 0.5, 0.5);
}

// Behind the last sample of a grid that goes on is the first one's image.
TEST(VisibleSpheres, HoldTheImageAtTheEndOfAGridThatGoesOn) {
  FieldSource source = bell();
  Grid grid;
  grid.dims = source.grid->dims;
  grid.steps = source.grid->steps;
  grid.values = source.grid->values;
  grid.periodic = true;
  source.grid = std::make_shared<const Grid>(std::move(grid));
  EXPECT_EQ(farthest_x(visible_spheres({}, {source})), 20.5);
  Field high;
  high.isosurfaces.push_back({0.5, {}, 1});  // does not come to the faces
  EXPECT_NEAR(farthest_x(visible_spheres({}, {source}, {}, {high})), 2 + 1.18 + 0.5, 0.5);
}

TEST(VisibleSpheres, AreThoseThatClipPlanesLeave) {
  const FieldSource source = bell();
  Field surface;
  surface.isosurfaces.push_back({0.5, {}, 1});
  const auto of_grid = visible_spheres({}, {source}, {}, {surface}, {}, {{{0, 2, 0}, 6}});
  ASSERT_FALSE(of_grid.empty());
  double highest = -1;
  for (const VisibleSphere& sphere : of_grid) highest = std::max(highest, sphere.center.y);
  EXPECT_NEAR(highest, 3, 1e-9) << "up to the plane";
  // Lines are cut off where they cross it.
  double farthest = -1;
  for (const VisibleSphere& sphere :
       visible_spheres({}, {source}, {}, {surface}, {}, {{{1, 0, 0}, 2.25}})) {
    farthest = std::max(farthest, sphere.center.x);
  }
  EXPECT_NEAR(farthest, 2.25, 1e-9);
  ParticleSet particles;
  particles.x = {0, 1, 5};
  particles.y = particles.z = {0, 0, 0};
  GeometrySource balls;
  balls.index = {0, 1, 2};
  balls.radius = {1};
  EXPECT_EQ(visible_spheres(particles, {}, balls, {}, {}, {{{1, 0, 0}, 0.5}}).size(), 1u);
  // Of a field what a plane cuts in part is still to be seen.
  FieldSource field;
  field.index = {0, 1, 2};
  field.radius = {1};
  EXPECT_EQ(visible_spheres(particles, {field}, {}, {}, {}, {{{1, 0, 0}, 0.5}}).size(), 2u);
  EXPECT_EQ(visible_spheres(particles, {}, balls, {}, {}, {{{1, 0, 0}, -5}}).size(), 3u)
      << "nothing is left";
}

// Corners of one that shows nothing, with as many particles beside it as would make them strays.
TEST(VisibleSpheres, HoldAGridBesideManyParticles) {
  FieldSource source = bell();
  ParticleSet particles;
  GeometrySource geometry;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    for (auto* axis : {&particles.x, &particles.y, &particles.z}) axis->push_back(1);
    geometry.index.push_back(i);
  }
  geometry.radius = {0.1F};
  Field none;
  none.isosurfaces.push_back({2, {}, 1});
  const Camera camera = fit_camera({}, visible_spheres(particles, {source}, geometry, {none}), 1);
  EXPECT_NEAR(camera.target.x, 10, 2);
  EXPECT_GT(length(camera.eye - camera.target), 20);
}

TEST(VisibleSpheres, ReachAsFarAsIsosurfacesMay) {
  ParticleSet particles;
  for (auto* axis : {&particles.x, &particles.y, &particles.z}) *axis = {0};
  FieldSource source;
  source.index = {0};
  source.radius = {2};
  source.weight = {3};
  source.kernel.support_factor = 4;
  const auto radius_at = [&](const std::vector<double>& levels, bool looks) {
    Field field;
    for (const double level : levels) field.isosurfaces.push_back({level, {}, 1});
    const auto values_at = [](std::size_t f, std::span<const Point3d> points) {
      EXPECT_EQ(f, 0U);
      return std::vector<double>(points.size(), 3);
    };
    const auto spheres =
        visible_spheres(particles, {source}, {}, {field}, looks ? values_at : FieldValuesAt());
    EXPECT_EQ(spheres.size(), 1U);
    return spheres[0].radius;
  };
  // 3.75 exp(-q^2 / 2) is the level, and what lies farthest out counts.
  EXPECT_NEAR(radius_at({1}, true), 2 * std::sqrt(2 * std::log(3.75)), 1e-6);
  EXPECT_NEAR(radius_at({1, 0.01, 2}, true), 2 * std::sqrt(2 * std::log(375)), 1e-6);
  EXPECT_NEAR(radius_at({1e-9}, true), 8, 1e-6) << "no kernel goes on beyond its support";
  EXPECT_NEAR(radius_at({4}, true), 0, 1e-6);
  EXPECT_NEAR(radius_at({-1}, true), 0, 1e-6);
  EXPECT_NEAR(radius_at({0}, true), 8, 1e-6);
  EXPECT_NEAR(radius_at({1}, false), 8, 1e-6);
  source.weight = {-3, 3};
  EXPECT_NEAR(radius_at({1}, true), 8, 1e-6) << "of both signs the field says nothing of kernels";
}

}  // namespace
}  // namespace motes
