// What is fitted to the data: that all of it is in view, and that pictures are neither fog nor
// block.
#include "scene/fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "core/error.h"

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

double extent_in_image(const Camera& camera, double aspect, const Bounds3d& box) {
  double extent = 0;
  for (const double x : {box.min.x, box.max.x}) {
    for (const double y : {box.min.y, box.max.y}) {
      for (const double z : {box.min.z, box.max.z}) {
        const auto [u, v] = project(camera, aspect, {x, y, z});
        if (std::isnan(u)) return NAN;
        extent = std::max({extent, std::abs(u), std::abs(v)});
      }
    }
  }
  return extent;
}

RC_GTEST_PROP(FitCamera, ShowsTheWholeBoxAndFillsTheImage, ()) {
  const auto number = [](int low, int high) { return *rc::gen::inRange(low, high) / 16.0; };
  const Point3d corner{number(-9999, 9999), number(-9999, 9999), number(-9999, 9999)};
  const Bounds3d box{corner, corner + Vector3d{number(0, 999), number(0, 999), number(1, 999)}};
  const double aspect = number(4, 64);
  Scene scene;
  if (*rc::gen::arbitrary<bool>()) scene.fov_degrees = number(16, 2400);
  if (*rc::gen::arbitrary<bool>()) scene.up = Vector3d{number(-99, 99), number(1, 99), 0};
  const double extent = extent_in_image(fit_camera(scene, box, aspect), aspect, box);
  RC_ASSERT(extent > 0.9);
  RC_ASSERT(extent < 0.98);
}

TEST(FitCamera, LooksAtTheLargestFace) {
  const auto forward = [](double x, double y, double z) {
    return camera_axes(fit_camera({}, {{0, 0, 0}, {x, y, z}}, 1)).forward;
  };
  EXPECT_LT(forward(10, 10, 10).z, -0.8);
  EXPECT_LT(forward(10, 10, 2).z, -0.8);
  EXPECT_LT(forward(2, 10, 10).x, -0.8);
  EXPECT_GT(forward(10, 2, 10).y, 0.8);
  EXPECT_EQ(forward(10, 10, 0), (Vector3d{0, 0, -1}));
  EXPECT_EQ(fit_camera({}, {{0, 0, 0}, {10, 2, 10}}, 1).up, (Vector3d{0, 0, 1}));
}

TEST(FitCamera, KeepsWhatTheSceneSays) {
  const Bounds3d box{{0, 0, 0}, {2, 2, 2}};
  Scene scene;
  scene.eye = {1, 9, 1};
  Camera camera = fit_camera(scene, box, 1);
  EXPECT_EQ(camera.eye, (Point3d{1, 9, 1}));
  EXPECT_EQ(camera.target, (Point3d{1, 1, 1}));
  EXPECT_EQ(camera.up, (Vector3d{0, 0, 1})) << "y would be parallel to the view";
  scene.eye = {1, 1, 1};
  EXPECT_NO_THROW(fit_camera(scene, box, 1));
  scene.target = {1, 1, 1};
  EXPECT_THROW(fit_camera(scene, box, 1), Error);
  scene.eye.reset();
  scene.target = {0, 0, 0};
  camera = fit_camera(scene, box, 1);
  EXPECT_EQ(camera.target, (Point3d{0, 0, 0}));
  EXPECT_LT(extent_in_image(camera, 1, box), 0.98);
  scene.orthographic_height = 5;
  EXPECT_FALSE(std::isnan(extent_in_image(fit_camera(scene, box, 1), 1, box)));
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

TEST(VisibleBox, HasATypicalSupportAroundTheCentres) {
  std::vector<FieldSource> fields(1);
  fields[0].index.assign(9, 0);
  fields[0].radius.assign(9, 3);
  fields[0].radius[8] = 1000;
  EXPECT_EQ(visible_box(fields, {{0, 0, 0}, {1, 2, 3}}), (Bounds3d{{-6, -6, -6}, {7, 8, 9}}));
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
      const TransferFunction f = fit_transfer_function({}, {}, profiles, 1);
      EXPECT_FALSE(f.log_scale);
      EXPECT_EQ(f.points.front().extinction, 0);
      EXPECT_NEAR(mean_opacity(f, profiles), 0.7, 0.01) << unit << " " << length_unit;
    }
  }
}

TEST(FitTransferFunction, SeveralFieldsShareTheOpacity) {
  const RayProfiles profiles = profiles_of(300, 200, 0.1, wavy);
  const double one = mean_opacity(fit_transfer_function({}, {}, profiles, 4), profiles);
  EXPECT_NEAR(1 - std::pow(1 - one, 4), 0.7, 0.02);
}

TEST(FitTransferFunction, IsLogarithmicWhereValuesSpanDecades) {
  const RayProfiles profiles = profiles_of(
      300, 200, 1, [](std::size_t r, std::size_t k) { return std::pow(10.0, 6 * wavy(r, k) - 3); });
  TransferFunction f = fit_transfer_function({}, {}, profiles, 1);
  EXPECT_TRUE(f.log_scale);
  EXPECT_GT(f.points.front().value, 0);
  EXPECT_NEAR(mean_opacity(f, profiles), 0.7, 0.01);
  f = fit_transfer_function(NamedTransferFunction{"heat", {}, {}, false}, {}, profiles, 1);
  EXPECT_FALSE(f.log_scale);
}

TEST(FitTransferFunction, ValuesOfBothSignsAreSymmetricAboutZero) {
  const RayProfiles profiles = profiles_of(300, 200, 0.1, [](std::size_t r, std::size_t k) {
    return std::sin(0.1 * static_cast<double>(r + k));
  });
  const TransferFunction f = fit_transfer_function({}, {}, profiles, 1);
  EXPECT_EQ(f.points.front().value, -f.points.back().value);
  EXPECT_EQ(f.points.front().extinction, f.points.back().extinction);
  EXPECT_EQ(f.points[16].extinction, 0);
  EXPECT_NEAR(mean_opacity(f, profiles), 0.7, 0.02);
}

TEST(FitTransferFunction, KeepsWhatTheSceneSays) {
  const RayProfiles profiles = profiles_of(300, 200, 0.1, wavy);
  const TransferFunction points{{{1, {1, 0, 0}, 3}}, false};
  EXPECT_EQ(fit_transfer_function(points, {}, profiles, 1), points);
  const NamedTransferFunction named{"heat", {{0.5, 1.5}}, 7, {}};
  EXPECT_EQ(fit_transfer_function(named, {}, profiles, 1),
            named_transfer_function("heat", 0.5, 1.5, 7));
}

TEST(FitTransferFunction, SpeciesColoursAreOneColour) {
  const Color red{1, 0, 0};
  const TransferFunction f = fit_transfer_function(NamedTransferFunction{"species", {}, {}, {}},
                                                   red, profiles_of(300, 200, 0.1, wavy), 1);
  for (const auto& point : f.points) EXPECT_EQ(point.color, red);
  EXPECT_EQ(f.points.front().extinction, 0);
}

TEST(FitTransferFunction, AnswersViewsOfNothingAndOfOneValue) {
  const auto nothing = [](std::size_t, std::size_t) { return 0; };
  EXPECT_NO_THROW(fit_transfer_function({}, {}, RayProfiles{{}, {0}, {}}, 1));
  EXPECT_NO_THROW(fit_transfer_function({}, {}, profiles_of(9, 9, 1, nothing), 1));
  const RayProfiles slab = profiles_of(9, 9, 1, [](std::size_t, std::size_t) { return 3; });
  EXPECT_NEAR(mean_opacity(fit_transfer_function({}, {}, slab, 1), slab), 0.7, 0.01);
}

}  // namespace
}  // namespace motes
