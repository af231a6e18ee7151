// What is fitted to the data: that all of it is in view, and that pictures are neither fog nor
// block.
#include "scene/fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

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
  const bool is_as_near_as_may_be = nearest < 0.0501 * length(box.diagonal());
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

TEST(DefaultStepSize, IsHalfASmallRadiusWithinBounds) {
  std::vector<FieldSource> fields(2);
  fields[0].radius = {2};
  fields[0].index.assign(1, 0);
  fields[1].index.assign(99, 0);
  fields[1].radius.assign(99, 3);
  fields[1].radius[7] = 1e-6f;
  EXPECT_EQ(default_step_size(fields, {{0, 0, 0}, {1, 1, 1}}), 1.5);
  EXPECT_NEAR(default_step_size(fields, {{0, 0, 0}, {2e5, 0, 0}}), 2e5 / 2048, 1e-9);
}

TEST(DefaultStepSize, FollowsTheRadiiThatCoverMostOfThePicture) {
  std::vector<FieldSource> fields(1);
  fields[0].index.assign(100, 0);
  fields[0].radius.assign(100, 1);  // half of the particles cover a hundredth of the picture
  for (std::size_t i = 0; i < 50; ++i) fields[0].radius[i] = 0.1f;
  EXPECT_EQ(default_step_size(fields, {{0, 0, 0}, {1, 1, 1}}), 0.5);
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
}

/// Rays through `make_value(ray, sample)`.
template <class F>
RayProfiles profiles_of(std::size_t rays, std::size_t samples, double spacing, F&& make_value) {
  RayProfiles profiles;
  profiles.ray_begin.push_back(0);
  for (std::size_t r = 0; r < rays; ++r) {
    for (std::size_t k = 0; k < samples; ++k) {
      profiles.values.push_back(static_cast<float>(make_value(r, k)));
    }
    profiles.ray_begin.push_back(profiles.values.size());
    profiles.spacing.push_back(spacing);
  }
  return profiles;
}

/// Extinction of `f` at `value`, by its definition.
double extinction_at(const TransferFunction& f, double value) {
  const auto at = [&f](double v) { return f.log_scale ? std::log10(v) : v; };
  if (value <= f.points.front().value) return f.points.front().extinction;
  for (std::size_t k = 1; k < f.points.size(); ++k) {
    const auto &a = f.points[k - 1], &b = f.points[k];
    if (value > b.value) continue;
    const double s = (at(value) - at(a.value)) / (at(b.value) - at(a.value));
    return a.extinction + s * (b.extinction - a.extinction);
  }
  return f.points.back().extinction;
}

/// Of the rays that meet any extinction.
double mean_opacity(const TransferFunction& f, const RayProfiles& profiles) {
  double sum = 0;
  int hits = 0;
  for (std::size_t r = 0; r < profiles.spacing.size(); ++r) {
    double depth = 0;
    for (std::size_t k = profiles.ray_begin[r]; k < profiles.ray_begin[r + 1]; ++k) {
      depth += extinction_at(f, profiles.values[k]) * profiles.spacing[r];
    }
    if (depth > 0) ++hits;
    sum += 1 - std::exp(-depth);
  }
  return sum / hits;
}

double wavy(std::size_t r, std::size_t k) {
  return std::max(0.0, std::sin(0.3 * static_cast<double>(k)) + std::cos(static_cast<double>(r)));
}

TEST(FitTransferFunction, IsNeitherFogNorBlockWhateverTheUnits) {
  for (const double unit : {1.0, 1e-20, 1e20}) {
    for (const double length_unit : {1.0, 1e-6, 1e24}) {
      const RayProfiles profiles =
          profiles_of(300, 200, 0.1 * length_unit,
                      [unit](std::size_t r, std::size_t k) { return unit * wavy(r, k); });
      const TransferFunction f = fit_transfer_function({}, {}, profiles, 0.7);
      EXPECT_FALSE(f.log_scale);
      EXPECT_EQ(f.points.front().extinction, 0);
      EXPECT_NEAR(mean_opacity(f, profiles), 0.7, 0.01) << unit << " " << length_unit;
    }
  }
}

constexpr Color black{0, 0, 0}, white{1, 1, 1};

TEST(FitOpacity, IsHigherOverBrightBackgrounds) {
  const RayProfiles wave = profiles_of(300, 200, 0.1, wavy);
  EXPECT_NEAR(fit_opacity({wave}, white), 0.9, 1e-6);
  EXPECT_NEAR(fit_opacity({wave}, {0.5f, 0.5f, 0.5f}), 0.8, 1e-6);
  EXPECT_NEAR(fit_opacity({wave}, {9, 9, 9}), 0.9, 1e-6);
  EXPECT_NEAR(1 - std::pow(1 - fit_opacity({wave, wave}, white), 2), 0.9, 1e-6);
}

TEST(FitOpacity, SharesRaysAmongTheFieldsThatTheyMeet) {
  const RayProfiles wave = profiles_of(300, 200, 0.1, wavy);
  EXPECT_EQ(fit_opacity({wave}, black), 0.7);
  EXPECT_NEAR(1 - std::pow(1 - fit_opacity({wave, wave, wave, wave}, black), 4), 0.7, 1e-6);
  // Fields on rays of their own take nothing from each other.
  const auto only = [](std::size_t parity) {
    return profiles_of(300, 200, 0.1, [parity](std::size_t r, std::size_t) {
      return r % 2 == parity ? 1.0 : 0.0;
    });
  };
  EXPECT_NEAR(fit_opacity({only(0), only(1)}, black), 0.7, 1e-6);
}

TEST(FitTransferFunction, IsLogarithmicWhereValuesSpanDecades) {
  const RayProfiles profiles = profiles_of(
      300, 200, 1, [](std::size_t r, std::size_t k) { return std::pow(10.0, 6 * wavy(r, k) - 3); });
  TransferFunction f = fit_transfer_function({}, {}, profiles, 0.7);
  EXPECT_TRUE(f.log_scale);
  EXPECT_GT(f.points.front().value, 0);
  EXPECT_GT(mean_opacity(f, profiles), 0.3 - 0.01);
  EXPECT_LT(mean_opacity(f, profiles), 0.7 + 0.01);
  f = fit_transfer_function(NamedTransferFunction{"heat", {}, {}, false}, {}, profiles, 0.7);
  EXPECT_FALSE(f.log_scale);
}

/// Rays past a centre, near to far: a density that falls with a power of the distance.
RayProfiles halo(double steepness) {
  return profiles_of(400, 101, 0.02, [steepness](std::size_t r, std::size_t k) {
    const double past = 0.002 * static_cast<double>(r),
                 along = 0.02 * (static_cast<double>(k) - 50);
    return std::pow(1e-3 + past * past + along * along, -steepness / 2);
  });
}

TEST(FitTransferFunction, ShowsDenseCoresThroughTheirOutskirts) {
  for (const double steepness : {4.0, 6.0, 8.0}) {
    const RayProfiles profiles = halo(steepness);
    const TransferFunction f = fit_transfer_function({}, {}, profiles, 0.7);
    ASSERT_TRUE(f.log_scale);
    double in_front = 0;  // of the core, on the ray through the centre
    for (std::size_t k = 0; k < 50; ++k) in_front += 0.02 * extinction_at(f, profiles.values[k]);
    EXPECT_GT(std::exp(-in_front), 0.4) << steepness;
    EXPECT_GT(mean_opacity(f, profiles), 0.3 - 0.01) << steepness;
    EXPECT_LT(mean_opacity(f, profiles), 0.7) << steepness;
  }
}

TEST(FitTransferFunction, RisesMoreSteeplyOverDecadesUnlessItsExtinctionIsGiven) {
  const RayProfiles profiles = halo(6);
  const auto middle_of = [](const TransferFunction& f) {
    const double middle = std::sqrt(f.points.front().value * f.points.back().value);
    return extinction_at(f, middle) / f.points.back().extinction;
  };
  for (const char* name : {"magma", "species"}) {
    NamedTransferFunction named{name, {}, {}, {}};
    const double fitted = middle_of(fit_transfer_function(named, {}, profiles, 0.7));
    EXPECT_NEAR(fitted, std::pow(0.5, 1.5), 1e-3) << name;
    named.extinction = 20;
    EXPECT_NEAR(middle_of(fit_transfer_function(named, {}, profiles, 0.7)), 0.5, 1e-6) << name;
  }
}

/// An orbital that falls off on both sides of a node.
RayProfiles orbital() {
  return profiles_of(400, 101, 0.02, [](std::size_t r, std::size_t k) {
    const double past = 0.002 * static_cast<double>(r),
                 along = 0.02 * (static_cast<double>(k) - 50);
    return along * std::exp(-8 * (past * past + along * along));
  });
}

TEST(FitTransferFunction, OfBothSignsHidesTheMiddleThatHardlyCounts) {
  const RayProfiles profiles = orbital();
  for (const std::string name : {"", "viridis", "species"}) {
    decltype(Field::transfer_function) wish;
    if (!name.empty()) wish = NamedTransferFunction{name, {}, {}, {}};
    const TransferFunction f = fit_transfer_function(wish, {}, profiles, 0.7);
    EXPECT_EQ(f.points.front().value, -f.points.back().value);
    const double last = f.points.back().extinction;
    double hidden = 0, all = 0;
    for (const double v : profiles.values) {
      EXPECT_NEAR(extinction_at(f, v), extinction_at(f, -v), 1e-6 * last);
      all += v * v;
      if (extinction_at(f, v) == 0) hidden += v * v;
    }
    EXPECT_NEAR(hidden / all, 0.15, 0.01) << name;
    EXPECT_NEAR(mean_opacity(f, profiles), 0.7, 0.01) << name;
    // Half of the extinction comes soon.
    const auto* const first = &*std::find_if(
        f.points.begin(), f.points.end(),
        [&](const auto& point) { return point.value > 0 && point.extinction >= 0.499 * last; });
    const double level = enclosing_level(profiles.values, Signs::both);
    EXPECT_LT(first->value, level + 0.07 * (f.points.back().value - level)) << name;
  }
}

TEST(FitTransferFunction, OfBothSignsHasAColourForEach) {
  const Color orange{1, 0.5f, 0}, blue{0, 0.2f, 1};
  const FieldColors colors{.own = {1, 1, 1}, .positive = orange, .negative = blue};
  const TransferFunction f = fit_transfer_function({}, colors, orbital(), 0.7);
  for (const double v : {0.01, 0.1, 1.0}) {
    EXPECT_GT(color_at(f, v).r, color_at(f, v).b);
    EXPECT_LT(color_at(f, -v).r, color_at(f, -v).b);
  }
}

TEST(FitTransferFunction, TakesAFewNegativeValuesForNone) {
  const RayProfiles clean = profiles_of(300, 200, 0.1, wavy);
  const RayProfiles ringing = profiles_of(300, 200, 0.1, [](std::size_t r, std::size_t k) {
    return wavy(r, k) > 0 ? wavy(r, k) : -1e-3;
  });
  EXPECT_EQ(fit_transfer_function({}, {}, ringing, 0.7), fit_transfer_function({}, {}, clean, 0.7));
}

TEST(FitTransferFunction, PrefersItsOwnColourWhereThereAreSeveral) {
  const FieldColors colors{.own = {1, 0, 0}, .positive = {}, .negative = {}, .prefers_own = true};
  const RayProfiles profiles = profiles_of(300, 200, 0.1, wavy);
  EXPECT_EQ(
      fit_transfer_function({}, colors, profiles, 0.7),
      fit_transfer_function(NamedTransferFunction{"species", {}, {}, {}}, colors, profiles, 0.7));
  EXPECT_EQ(
      fit_transfer_function(NamedTransferFunction{"magma", {}, {}, {}}, colors, profiles, 0.7),
      fit_transfer_function(NamedTransferFunction{"magma", {}, {}, {}}, {}, profiles, 0.7));
}

TEST(FitTransferFunction, KeepsWhatTheSceneSays) {
  const RayProfiles profiles = profiles_of(300, 200, 0.1, wavy);
  const TransferFunction points{{{1, {1, 0, 0}, 3}}, false};
  EXPECT_EQ(fit_transfer_function(points, {}, profiles, 0.7), points);
  const NamedTransferFunction named{"heat", {{0.5, 1.5}}, 7, {}};
  EXPECT_EQ(fit_transfer_function(named, {}, profiles, 0.7),
            named_transfer_function("heat", 0.5, 1.5, 7));
}

TEST(FitTransferFunction, SpeciesColoursAreOneColourAndPalerAtTheEnd) {
  const Color red{1, 0, 0};
  const TransferFunction f = fit_transfer_function(NamedTransferFunction{"species", {}, {}, {}},
                                                   {.own = red, .positive = {}, .negative = {}},
                                                   profiles_of(300, 200, 0.1, wavy), 0.7);
  EXPECT_EQ(f.points.front().color, red);
  EXPECT_EQ(f.points.back().color.r, 1);
  EXPECT_EQ(f.points.back().color.g, f.points.back().color.b);
  EXPECT_GT(f.points.back().color.g, 0.2);
  EXPECT_EQ(f.points.front().extinction, 0);
}

TEST(FitTransferFunction, AnswersViewsOfNothingAndOfOneValue) {
  const auto nothing = [](std::size_t, std::size_t) { return 0; };
  EXPECT_NO_THROW(fit_transfer_function({}, {}, RayProfiles{{}, {0}, {}}, 0.7));
  EXPECT_NO_THROW(fit_transfer_function({}, {}, profiles_of(9, 9, 1, nothing), 0.7));
  const RayProfiles slab = profiles_of(9, 9, 1, [](std::size_t, std::size_t) { return 3; });
  EXPECT_NEAR(mean_opacity(fit_transfer_function({}, {}, slab, 0.7), slab), 0.7, 0.01);
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
  ASSERT_EQ(spheres.size(), 8U);
  // 85 % of a bell lie within 2.3 widths, where it is 0.07; it comes to a tenth at 3.15 of them.
  EXPECT_NEAR(farthest_x(spheres), 2 + 3.15 + 0.5, 0.5);
  for (const VisibleSphere& sphere : spheres) EXPECT_GE(sphere.center.x, 0);
  Field low;
  low.isosurfaces.push_back({1e-6, {}, 1});  // 5.26 widths
  EXPECT_NEAR(farthest_x(visible_spheres({}, {source}, {}, {low})), 2 + 5.26 + 0.5, 0.5);
  Field high;
  high.isosurfaces.push_back({0.5, {}, 1});  // 1.18 widths, and no volume
  EXPECT_NEAR(farthest_x(visible_spheres({}, {source}, {}, {high})), 2 + 1.18 + 0.5, 0.5);
}

TEST(VisibleSpheres, HoldAllOfAGridThatGoesOn) {
  FieldSource source = bell();
  Grid grid;
  grid.dims = source.grid->dims;
  grid.steps = source.grid->steps;
  grid.values = source.grid->values;
  grid.periodic = true;
  source.grid = std::make_shared<const Grid>(std::move(grid));
  EXPECT_EQ(farthest_x(visible_spheres({}, {source})), 20.5);
}

}  // namespace
}  // namespace motes
