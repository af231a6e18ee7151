// The engines' form of tabulated kernels against the curve itself.
#include "field/radial_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

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

/// Like |q|^3 at 0, which has no third derivative in q^2 there.
double with_a_cube(double q) { return 1 - 3 * q * q + 2 * q * q * q; }

Kernel rough_table(int steps) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(0.5, 1);
  return tabulated(steps, 2.5, [&](double) { return value(random); });
}

/// The largest differences from the curve, over its largest value and its steepest slope.
struct Errors {
  double value = 0, slope = 0;
};

/// `coefficient(k, i)` is the k-th one, of `count`, of segment i.
template <class F>
Errors errors_of(const TableSegments& segments, std::size_t count, F&& coefficient,
                 const Kernel& kernel) {
  Errors errors;
  double largest = 0, steepest = 0;
  constexpr int places = 10000;
  for (int k = 0; k < places; ++k) {
    const double q = k * kernel.support() / places;
    const double scale = static_cast<double>(segments.per_unit);
    const double place = (segments.of_squares ? q * q : q) * scale;
    const double i = std::floor(std::min(place, static_cast<double>(segments.last)));
    const double t = place - i - 0.5;
    double value = 0, by_place = 0;
    for (std::size_t c = count; c-- > 0;) {
      by_place = by_place * t + value;
      value = value * t + static_cast<double>(coefficient(c, static_cast<std::size_t>(i)));
    }
    const double by_distance = by_place * scale * (segments.of_squares ? 2 * q : 1);
    const RadialValue truth = evaluate(kernel, q);
    largest = std::max(largest, std::abs(truth.value));
    steepest = std::max(steepest, std::abs(truth.steepness * q));
    errors.value = std::max(errors.value, std::abs(value - truth.value));
    errors.slope = std::max(errors.slope, std::abs(by_distance + truth.steepness * q));
  }
  return {errors.value / largest, errors.slope / steepest};
}

void expect_small(const Errors& errors) {
  EXPECT_LT(errors.value, 2e-6);
  EXPECT_LT(errors.slope, 2e-5);
}

void expect_steps(const RadialTable& table, const Kernel& kernel) {
  ASSERT_EQ(table.num_steps(), kernel.shape.profile.values.size() - 1);
  expect_small(errors_of(
      table.steps, RadialTable::record_size,
      [&](std::size_t k, std::size_t i) { return table.records[RadialTable::record_size * i + k]; },
      kernel));
}

void expect_smooth(const RadialTable& table, const Kernel& kernel) {
  ASSERT_TRUE(table.is_smooth());
  ASSERT_EQ(table.rows.size(), RadialTable::smooth_row * (RadialTable::smooth_degree + 1));
  for (const std::size_t copy : {std::size_t{0}, RadialTable::smooth_segments}) {
    expect_small(errors_of(
        table.smooth, RadialTable::smooth_degree + 1,
        [&](std::size_t k, std::size_t i) {
          return table.rows[RadialTable::smooth_row * k + copy + i];
        },
        kernel));
  }
}

TEST(RadialTable, HasTheStepsOfEveryTable) {
  for (const int steps : {1, 7, 32, 64, 100}) {
    SCOPED_TRACE(steps);
    const Kernel kernel = rough_table(steps);
    expect_steps(make_radial_table(kernel), kernel);
  }
  const Kernel kernel = tabulated(1000, 2.8, bell);
  expect_steps(make_radial_table(kernel), kernel);
}

TEST(RadialTable, IsOfSquaresWhereTheCurveIsSmooth) {
  for (const int steps : {200, 256, 1000}) {
    SCOPED_TRACE(steps);
    const Kernel kernel = tabulated(steps, 2.8, bell);
    const RadialTable table = make_radial_table(kernel);
    expect_smooth(table, kernel);
    EXPECT_TRUE(table.smooth.of_squares);
  }
}

TEST(RadialTable, IsOfDistancesWhereTheseAreWhatTheCurveIsSmoothIn) {
  const Kernel kernel = tabulated(2000, 1, with_a_cube);
  const RadialTable table = make_radial_table(kernel);
  expect_smooth(table, kernel);
  EXPECT_FALSE(table.smooth.of_squares);
}

/// Of as many steps as there are segments, each step is a polynomial already.
TEST(RadialTable, TakesStepsThatAreSegmentsForSmooth) {
  for (const int steps : {1, 2, 4, 8}) {
    SCOPED_TRACE(steps);
    const Kernel kernel = rough_table(steps);
    expect_smooth(make_radial_table(kernel), kernel);
  }
}

TEST(RadialTable, DoesNotSmoothWhatIsRough) {
  for (const int steps : {7, 9, 32, 100, 1000}) {
    EXPECT_FALSE(make_radial_table(rough_table(steps)).is_smooth()) << steps;
  }
  // One value of a smooth curve off by 1e-4: of the steepest slope that is a hundredth.
  Kernel kernel = tabulated(256, 2.8, bell);
  kernel.shape.profile.values[100] += 1e-4;
  EXPECT_FALSE(make_radial_table(kernel).is_smooth());
}

}  // namespace
}  // namespace motes
