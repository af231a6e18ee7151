// The engines' form of tabulated kernels against the curve itself.
#include "field/radial_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace motes {
namespace {

template <class F>
Kernel tabulated(int steps, double support, F&& value) {
  Kernel kernel;
  kernel.shape.type = KernelType::tabulated;
  kernel.shape.profile.spacing = support / steps;
  for (int i = 0; i <= steps; ++i) {
    kernel.shape.profile.values.push_back(value(i * kernel.shape.profile.spacing));
  }
  return kernel;
}

double bell(double q) { return std::exp(-0.5 * q * q); }

Kernel rough_table(int steps) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(0.5, 1);
  return tabulated(steps, 2.5, [&](double) { return value(random); });
}

/// The largest differences from the curve, over its largest value and its steepest slope.
struct Errors {
  double value = 0, slope = 0;
};

Errors errors_of(const RadialTable& table, const Kernel& kernel) {
  Errors errors;
  double largest = 0, steepest = 0;
  constexpr int places = 10000;
  for (int k = 0; k < places; ++k) {
    const double q = k * kernel.support() / places;
    const double scale = static_cast<double>(table.segments_per_unit);
    const double place = (table.of_squares ? q * q : q) * scale;
    const auto i =
        static_cast<std::size_t>(std::min(place, static_cast<double>(table.last_segment)));
    const double t = place - static_cast<double>(i);
    const float* const c = table.coefficients.data() + RadialTable::record_size * i;
    const double c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3];
    const double by_place = c1 + t * (2 * c2 + 3 * t * c3);
    const RadialValue truth = evaluate(kernel, q);
    largest = std::max(largest, std::abs(truth.value));
    steepest = std::max(steepest, std::abs(truth.steepness * q));
    errors.value =
        std::max(errors.value, std::abs(c0 + t * (c1 + t * (c2 + t * c3)) - truth.value));
    errors.slope =
        std::max(errors.slope,
                 std::abs(by_place * scale * (table.of_squares ? 2 * q : 1) + truth.steepness * q));
  }
  return {errors.value / largest, errors.slope / steepest};
}

void expect_same_curve(const RadialTable& table, const Kernel& kernel) {
  const Errors errors = errors_of(table, kernel);
  EXPECT_LT(errors.value, 2e-6);
  EXPECT_LT(errors.slope, 2e-5);
}

TEST(RadialTable, IsOfSquaresWhereTheCurveIsSmooth) {
  for (const int steps : {200, 256, 1000}) {
    const Kernel kernel = tabulated(steps, 2.8, bell);
    const RadialTable table = make_radial_table(kernel);
    EXPECT_TRUE(table.of_squares) << steps;
    EXPECT_TRUE(table.has_few());
    expect_same_curve(table, kernel);
  }
}

TEST(RadialTable, KeepsTheStepsOfShortTables) {
  for (const int steps : {1, 7, 32}) {
    const Kernel kernel = rough_table(steps);
    const RadialTable table = make_radial_table(kernel);
    EXPECT_FALSE(table.of_squares) << steps;
    EXPECT_TRUE(table.has_few());
    EXPECT_EQ(table.coefficients.size(),
              RadialTable::record_size * static_cast<std::size_t>(steps));
    expect_same_curve(table, kernel);
  }
}

TEST(RadialTable, KeepsTheStepsOfLongRoughTables) {
  const Kernel kernel = rough_table(100);
  const RadialTable table = make_radial_table(kernel);
  EXPECT_FALSE(table.has_few());
  EXPECT_EQ(table.coefficients.size(), RadialTable::record_size * 100);
  expect_same_curve(table, kernel);
}

/// A curve like |q|^3 at 0 has no third derivative in q^2 there, a short one in q does.
TEST(RadialTable, IsOfDistancesWhereTheseAreWhatTheCurveIsSmoothIn) {
  const Kernel kernel = tabulated(2000, 1, [](double q) { return 1 - 3 * q * q + 2 * q * q * q; });
  const RadialTable table = make_radial_table(kernel);
  EXPECT_FALSE(table.of_squares);
  EXPECT_TRUE(table.has_few());
  expect_same_curve(table, kernel);
}

}  // namespace
}  // namespace motes
