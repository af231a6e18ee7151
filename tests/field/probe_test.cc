#include "field/probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/field.h"
#include "support/particles_at.h"

namespace motes {
namespace {

struct Cloud {
  ParticleSet particles;
  std::vector<FieldSource> fields;
};

/// Random particles in a box of 10 around `center`, two fields that share half of them.
Cloud random_cloud(const Point3d& center, bool normalise) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Point3d> points;
  Cloud cloud;
  cloud.fields.resize(2);
  for (std::uint32_t i = 0; i < 600; ++i) {
    const double x = unit(random), y = unit(random), z = unit(random);
    points.push_back(center + 10. * Vector3d{x - 0.5, y - 0.5, z - 0.5});
    for (std::size_t f = 0; f < 2; ++f) {
      if (f == 0 ? i >= 400 : i < 200) continue;
      cloud.fields[f].index.push_back(i);
      cloud.fields[f].radius.push_back(static_cast<float>(0.3 + unit(random)));
      cloud.fields[f].weight.push_back(static_cast<float>(2 * unit(random) - 0.5));
    }
  }
  cloud.fields[1].kernel = {3.0, -0.7};
  cloud.fields[1].normalise = normalise;
  cloud.particles = particles_at(points);
  return cloud;
}

void expect_reference(const Cloud& cloud, const Point3d& center) {
  const KernelSet kernels = build_kernel_set(cloud.particles, cloud.fields);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> offset(-7, 7);
  std::vector<Point3d> points;
  points.reserve(200);
  for (int i = 0; i < 200; ++i) {
    points.push_back(center + Vector3d{offset(random), offset(random), offset(random)});
  }
  const std::vector<std::vector<reference::ParticleKernel>> truths{
      reference::particle_kernels(cloud.particles, cloud.fields[0]),
      reference::particle_kernels(cloud.particles, cloud.fields[1])};
  const std::vector<FieldSample> samples = probe(kernels, points);
  ASSERT_EQ(samples.size(), 2 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t f = 0; f < 2; ++f) {
      const auto truth = reference::evaluate_field(truths[f], points[i]);
      const FieldSample& sample = samples[2 * i + f];
      // A normalised weight is kept as a float: 6e-8.
      const double tolerance = 2e-7 * truth.absolute;
      EXPECT_NEAR(sample.value, truth.value, tolerance);
      EXPECT_NEAR(length(sample.gradient - truth.gradient), 0, 10 * tolerance);
    }
  }
}

TEST(Probe, GivesTheReferencesValuesAndGradients) {
  expect_reference(random_cloud({0, 0, 0}, false), {0, 0, 0});
  expect_reference(random_cloud({0, 0, 0}, true), {0, 0, 0});
}

TEST(Probe, KeepsPrecisionFarFromTheOrigin) {
  expect_reference(random_cloud({1e6, -2e6, 3e6}, false), {1e6, -2e6, 3e6});
}

TEST(Probe, GivesNaNWhereThePointIsNone) {
  const Cloud cloud = random_cloud({0, 0, 0}, false);
  const std::vector<Point3d> points{{std::nan(""), 0, 0}};
  EXPECT_TRUE(std::isnan(probe(build_kernel_set(cloud.particles, cloud.fields), points)[0].value));
}

}  // namespace
}  // namespace motes
