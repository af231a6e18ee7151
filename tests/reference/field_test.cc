// The field of the reference against closed forms and its own differences.
#include "reference/field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/particles_at.h"

namespace motes::reference {
namespace {

constexpr double pi = std::numbers::pi;

/// One particle at the origin.
std::vector<ParticleKernel> lone_kernel(double radius, double support_factor, double amplitude) {
  return {{.center = {0, 0, 0},
           .radius = radius,
           .support_radius = support_factor * radius,
           .amplitude = amplitude}};
}

TEST(ReferenceField, IsAGaussianOfStandardDeviationRadius) {
  const auto kernel = lone_kernel(0.5, 2, 3);
  EXPECT_DOUBLE_EQ(evaluate_field(kernel, {0, 0, 0}).value, 3);
  EXPECT_DOUBLE_EQ(evaluate_field(kernel, {0.5, 0, 0}).value, 3 * std::exp(-0.5));
  EXPECT_DOUBLE_EQ(evaluate_field(kernel, {0, 0.3, 0.4}).value, 3 * std::exp(-0.5));
  EXPECT_EQ(evaluate_field(kernel, {0, 0, 0}).gradient, Vector3d{});
  EXPECT_DOUBLE_EQ(evaluate_field(kernel, {0, 0.5, 0}).gradient.y, -3 * std::exp(-0.5) / 0.5);
}

TEST(ReferenceField, EndsAtTheSupportBoundaryWhichBelongsToIt) {
  const auto kernel = lone_kernel(0.5, 2, 3);
  const FieldValue on = evaluate_field(kernel, {0, 0, 1});
  EXPECT_DOUBLE_EQ(on.value, 3 * std::exp(-2.));
  EXPECT_EQ(on.boundary_distance, 0);
  EXPECT_EQ(on.num_kernels, 1U);
  const FieldValue beyond = evaluate_field(kernel, {0, 0, 1.001});
  EXPECT_EQ(beyond.value, 0);
  EXPECT_EQ(beyond.gradient, Vector3d{});
  EXPECT_EQ(beyond.num_kernels, 0U);
  EXPECT_NEAR(beyond.boundary_distance, 0.001, 1e-12);
  EXPECT_NEAR(evaluate_field(kernel, {0, 0, 0.9}).boundary_distance, 0.1, 1e-12);
}

TEST(ReferenceField, SumsKernelsAndTheirAbsoluteValues) {
  auto kernels = lone_kernel(1, 3, 2);
  kernels.push_back({.center = {1, 0, 0}, .radius = 1, .support_radius = 3, .amplitude = -2});
  const FieldValue middle = evaluate_field(kernels, {0.5, 0, 0});
  EXPECT_NEAR(middle.value, 0, 1e-15);
  EXPECT_DOUBLE_EQ(middle.absolute, 4 * std::exp(-0.125));
  EXPECT_DOUBLE_EQ(middle.gradient.x, -2 * std::exp(-0.125));  // both pull to the same side
}

TEST(ReferenceField, LineIntegralOfAWideGaussian) {
  // Untruncated: int phi dl = amplitude sqrt(2 pi) r exp(-b^2 / 2 r^2) at distance b.
  const double radius = 0.7, amplitude = 1.3, b = 0.4, step = 0.01;
  const auto kernel = lone_kernel(radius, 9, amplitude);
  double sum = 0;
  for (int i = -1000; i < 1000; ++i) {
    sum += step * evaluate_field(kernel, {(i + 0.5) * step, b, 0}).value;
  }
  EXPECT_NEAR(sum,
              amplitude * std::sqrt(2 * pi) * radius * std::exp(-b * b / (2 * radius * radius)),
              1e-10);
}

TEST(ReferenceField, TruncatedIntegralAgreesWithQuadrature) {
  for (const double sigma : {0.5, 1., 2., 3., 6.}) {
    const double radius = 0.8;
    // Midpoint rule over shells.
    const int shells = 20000;
    const double thickness = sigma * radius / shells;
    double sum = 0;
    for (int i = 0; i < shells; ++i) {
      const double d = (i + 0.5) * thickness;
      sum += 4 * pi * d * d * std::exp(-d * d / (2 * radius * radius)) * thickness;
    }
    EXPECT_NEAR(truncated_gaussian_integral(radius, sigma) / sum, 1, 1e-7) << sigma;
  }
  const double whole = std::pow(2 * pi, 1.5);
  EXPECT_NEAR(truncated_gaussian_integral(1, 2) / whole, 0.739, 5e-4);
  EXPECT_NEAR(truncated_gaussian_integral(1, 30) / whole, 1, 1e-14);
}

TEST(ReferenceField, GradientIsTheDerivative) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<ParticleKernel> kernels;
  for (int i = 0; i < 60; ++i) {
    const double radius = 0.2 + 0.15 * unit(random);
    kernels.push_back({.center = {unit(random), unit(random), unit(random)},
                       .radius = radius,
                       .support_radius = 2 * radius,
                       .amplitude = unit(random)});
  }
  const double h = 1e-5;
  int checked = 0;
  while (checked < 200) {
    const Point3d x{unit(random), unit(random), unit(random)};
    const FieldValue field = evaluate_field(kernels, x);
    if (field.boundary_distance < 2 * h) continue;  // a difference across the jump means nothing
    for (int axis = 0; axis < 3; ++axis) {
      Vector3d d;
      d[axis] = h;
      const double difference =
          (evaluate_field(kernels, x + d).value - evaluate_field(kernels, x - d).value) / (2 * h);
      EXPECT_NEAR(field.gradient[axis], difference, 1e-6);
    }
    ++checked;
  }
}

TEST(ReferenceKernels, ComeFromPositionsRadiiWeightsAndScale) {
  const ParticleSet particles = particles_at({{1e6, 0, 0}, {1e6 + 0.015625, 0, 0}, {1e6, 1, 0}});
  FieldSource source;
  source.kernel = {.support_factor = 3, .kernel_scale = 2};
  source.index = {1, 2};
  source.radius = {0.5F};
  source.weight = {1.5F, -1};
  auto kernels = particle_kernels(particles, source);
  ASSERT_EQ(kernels.size(), 2U);
  EXPECT_EQ(kernels[0].center, (Point3d{1e6 + 0.015625, 0, 0}));
  EXPECT_EQ(kernels[1].radius, 0.5);
  EXPECT_EQ(kernels[1].support_radius, 1.5);
  EXPECT_EQ(kernels[0].amplitude, 3);
  EXPECT_EQ(kernels[1].amplitude, -2);

  source.normalise = true;  // the kernel's integral becomes kappa k
  kernels = particle_kernels(particles, source);
  EXPECT_NEAR(kernels[0].amplitude * truncated_gaussian_integral(0.5, 3), 3, 1e-14);
}

}  // namespace
}  // namespace motes::reference
