// Kernels of all shapes against their definitions, written out a second time, and quadrature.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "reference/field.h"
#include "scene/kernel.h"
#include "support/particles_at.h"

namespace motes::reference {
namespace {

std::vector<Kernel> all_kernels() {
  std::vector<Kernel> kernels;
  for (const double sigma : {0.5, 2.0, 6.0}) kernels.push_back({.support_factor = sigma});
  for (const KernelType type :
       {KernelType::cubic_spline, KernelType::quintic_spline, KernelType::wendland_c2,
        KernelType::wendland_c4, KernelType::wendland_c6}) {
    kernels.push_back({.shape = {type, {}}});
  }
  kernels.push_back({.shape = {KernelType::tabulated, {"", 0.7, {1, 0}}}});
  kernels.push_back({.shape = {KernelType::tabulated, {"", 0.3, {1, 0.7, 0.8, -0.2, 0.1, 0}}}});
  kernels.push_back({.shape = {KernelType::tabulated, {"", 2, {0.2, 0.3, 0.3, 0.1}}}});
  return kernels;
}

TEST(Kernels, AreThoseOfTheirDefinitions) {
  for (const Kernel& kernel : all_kernels()) {
    SCOPED_TRACE(name_of(kernel.shape.type));
    EXPECT_EQ(kernel.support(), support_of(kernel));
    for (int i = 0; i <= 200; ++i) {
      const double q = kernel.support() * i / 200;
      const RadialValue value = evaluate(kernel, q);
      const ShapeValue truth = evaluate_shape(kernel.shape, q);
      EXPECT_NEAR(value.value, truth.value, 1e-13) << q;
      EXPECT_NEAR(-value.steepness * q, truth.derivative, 1e-12) << q;
    }
    EXPECT_EQ(evaluate(kernel, 1.001 * kernel.support()).value, 0);
    // The limit at the centre, where the definition has 0 / 0; kernels are round there.
    EXPECT_NEAR(evaluate(kernel, 0).steepness, evaluate(kernel, 1e-7).steepness, 1e-5);
  }
}

TEST(Kernels, IntegrateToWhatTheySay) {
  for (const Kernel& kernel : all_kernels()) {
    EXPECT_NEAR(kernel.integral() / kernel_integral(kernel), 1, 2e-8) << name_of(kernel.shape.type);
  }
}

TEST(Kernels, HaveTheStandardDeviationsThatTheySay) {
  for (const KernelType type :
       {KernelType::cubic_spline, KernelType::quintic_spline, KernelType::wendland_c2,
        KernelType::wendland_c4, KernelType::wendland_c6}) {
    const Kernel kernel{.shape = {type, {}}};
    const int shells = 4000;
    double sum = 0, square = 0;
    for (int i = 0; i < shells; ++i) {
      const double q = (i + 0.5) * kernel.support() / shells;
      const double mass = q * q * evaluate_shape(kernel.shape, q).value;
      sum += mass;
      square += mass * q * q / 3;
    }
    EXPECT_NEAR(kernel.standard_deviation(), std::sqrt(square / sum), 2e-6) << name_of(type);
  }
}

TEST(Kernels, NormalisedOnesIntegrateToTheirWeight) {
  // A grid of boxes over the support; the mean of a smooth kernel's jumps at their faces is small.
  for (const Kernel& kernel : all_kernels()) {
    if (kernel.shape.type == KernelType::gaussian) continue;  // its jump takes a finer grid
    FieldSource source;
    source.kernel = kernel;
    source.normalise = true;
    source.index = {0};
    source.radius = {0.8F};
    source.weight = {2.5F};
    const auto kernels = particle_kernels(particles_at({{0, 0, 0}}), source);
    const int boxes = 60;
    const double side = 2 * kernels[0].support_radius / boxes;
    double sum = 0;
    for (int i = 0; i < boxes * boxes * boxes; ++i) {
      const auto middle = [&](int n) { return (n + 0.5 - boxes / 2.) * side; };
      const Point3d x{middle(i % boxes), middle(i / boxes % boxes), middle(i / boxes / boxes)};
      sum += side * side * side * evaluate_field(kernels, x).value;
    }
    const bool jumps =
        kernel.shape.type == KernelType::tabulated && kernel.shape.profile.values.back() != 0;
    EXPECT_NEAR(sum, 2.5, jumps ? 0.02 : 0.002) << name_of(kernel.shape.type);
  }
}

}  // namespace
}  // namespace motes::reference
