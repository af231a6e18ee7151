// What a coarse grid of rays over the view sees of the fields.
#include "render/view_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "support/particles_at.h"

namespace motes {
namespace {

constexpr float radius = 0.5f;
constexpr double sigma = 2;

/// Looks at the origin from z = 10.
Camera camera_along_z() {
  Camera camera;
  camera.eye = {0, 0, 10};
  camera.target = {0, 0, 0};
  return camera;
}

/// Kernels at `points`: one field for each of the scales, all weights 1.
KernelSet kernels_at(const std::vector<Point3d>& points, const std::vector<double>& kernel_scales) {
  const ParticleSet particles = particles_at(points);
  std::vector<FieldSource> fields;
  fields.reserve(kernel_scales.size());
  for (const double kernel_scale : kernel_scales) {
    fields.push_back(field_of_all(particles, radius, 1, {sigma, kernel_scale}));
  }
  return build_kernel_set(particles, fields);
}

double sum_of_values(const RayProfiles& profile, std::size_t ray) {
  const auto at = [&](std::size_t i) {
    return profile.values.begin() + static_cast<std::ptrdiff_t>(profile.ray_begin[i]);
  };
  return std::accumulate(at(ray), at(ray + 1), 0.0);
}

// The rays of an orthographic camera that sees the kernel's box, no more and no less, stand for
// equal shares of it: together they integrate the truncated Gaussian.
TEST(SampleView, IntegratesAKernelOverTheView) {
  const KernelSet kernels = kernels_at({{0, 0, 0}}, {1, 3});
  Camera camera = camera_along_z();
  const double side = 2 * sigma * radius;
  camera.orthographic_height = side;
  const std::vector<RayProfiles> profiles = sample_view(kernels, camera, 64, 64);
  ASSERT_EQ(profiles.size(), 2u);
  const double truncated = std::erf(sigma / std::numbers::sqrt2) -
                           std::sqrt(2 / std::numbers::pi) * sigma * std::exp(-sigma * sigma / 2);
  const double mass = std::pow(2 * std::numbers::pi, 1.5) * std::pow(radius, 3) * truncated;
  for (std::size_t f = 0; f < 2; ++f) {
    const RayProfiles& profile = profiles[f];
    const std::size_t num_rays = profile.spacing.size();
    ASSERT_GT(num_rays, 100u);
    ASSERT_EQ(profile.ray_begin.size(), num_rays + 1);
    EXPECT_EQ(profile.ray_begin.front(), 0u);
    EXPECT_EQ(profile.ray_begin.back(), profile.values.size());
    double sum = 0;
    for (std::size_t i = 0; i < num_rays; ++i) {
      sum += profile.spacing[i] * sum_of_values(profile, i) * side * side /
             static_cast<double>(num_rays);
    }
    const double expected = (f == 0 ? 1 : 3) * mass;
    EXPECT_NEAR(sum, expected, 0.02 * expected);
  }
}

// A wide picture sees its sides too: its aspect is that of the rays.
TEST(SampleView, SpreadsItsRaysOverTheWholePicture) {
  const KernelSet kernels = kernels_at({{-5, 0, 0}, {5, 0, 0}}, {1});
  Camera camera = camera_along_z();
  camera.orthographic_height = 2;
  const auto seen = [&](int width) {
    const RayProfiles profile = sample_view(kernels, camera, width, 100).front();
    return std::count_if(profile.values.begin(), profile.values.end(),
                         [](float value) { return value > 0; });
  };
  EXPECT_EQ(seen(100), 0);  // x from -1 to 1
  EXPECT_GT(seen(600), 0);  // x from -6 to 6
}

// The box goes from z = -5 to z = 5 and the view through its front and back faces alone.
TEST(SampleView, SpacesObliqueRaysByTheirLength) {
  const KernelSet kernels = kernels_at({{-4, -4, -4}, {4, 4, 4}}, {1});
  Camera camera = camera_along_z();
  camera.fov_degrees = 30;
  const RayProfiles profile = sample_view(kernels, camera, 64, 64).front();
  double longest = 0;
  for (std::size_t i = 0; i < profile.spacing.size(); ++i) {
    const auto count = static_cast<double>(profile.ray_begin[i + 1] - profile.ray_begin[i]);
    const double depths = profile.spacing[i] * count / 10;
    EXPECT_GE(depths, 1 - 1e-9);
    longest = std::max(longest, depths);
  }
  const double tangent = std::tan(15 * std::numbers::pi / 180);
  EXPECT_NEAR(longest, std::sqrt(1 + 2 * tangent * tangent), 0.01);  // in a corner
}

TEST(SampleView, HasNoRaysWhereNothingIsInView) {
  Camera camera = camera_along_z();
  camera.target = {0, 0, 20};
  const std::vector<RayProfiles> profiles =
      sample_view(kernels_at({{0, 0, 0}}, {1}), camera, 64, 64);
  ASSERT_EQ(profiles.size(), 1u);
  EXPECT_TRUE(profiles[0].values.empty());
  EXPECT_TRUE(profiles[0].spacing.empty());
  EXPECT_EQ(profiles[0].ray_begin, std::vector<std::size_t>{0});
}

TEST(SampleView, TakesFewerPointsWhereManyKernelsOverlap) {
  const auto num_points = [](std::size_t num_particles) {
    const KernelSet kernels = kernels_at(std::vector<Point3d>(num_particles), {1});
    return sample_view(kernels, camera_along_z(), 64, 64).front().values.size();
  };
  EXPECT_LT(num_points(8000), num_points(1) / 2);
  EXPECT_GT(num_points(8000), 0u);
}

class LastFraction : public Progress {
 public:
  void update(std::string_view, double fraction) override {
    EXPECT_GT(fraction, value);
    value = fraction;
  }
  double value = 0;
};

TEST(SampleView, ReportsProgressAndRepeatsItself) {
  const KernelSet kernels = kernels_at({{0, 0, 0}, {0.3, 0.2, 0.1}}, {1});
  LastFraction progress;
  const RayProfiles first = sample_view(kernels, camera_along_z(), 64, 64, &progress).front();
  EXPECT_EQ(progress.value, 1);
  const RayProfiles second = sample_view(kernels, camera_along_z(), 64, 64).front();
  EXPECT_EQ(first.values, second.values);
  EXPECT_EQ(first.spacing, second.spacing);
}

}  // namespace
}  // namespace motes
