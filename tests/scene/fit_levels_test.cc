// Levels against what they are to enclose.
#include "scene/fit_levels.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/vec.h"

namespace motes {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

TEST(SignsOf, LeaveOutASignThatHardlyCounts) {
  EXPECT_EQ(signs_of(std::vector{0.5f, 2.0f}), Signs::positive);
  EXPECT_EQ(signs_of(std::vector{-0.5f, 0.0f}), Signs::negative);
  EXPECT_EQ(signs_of(std::vector{-1.0f, 98.0f}), Signs::both);
  EXPECT_EQ(signs_of(std::vector{-1.0f, 100.0f}), Signs::positive);
  EXPECT_EQ(signs_of(std::vector{1.0f, -100.0f}), Signs::negative);
  EXPECT_EQ(signs_of(std::vector{0.0f, 0.0f}), Signs::positive);
  EXPECT_EQ(signs_of(std::vector{-infinity, NAN, 1.0f}), Signs::positive);
  EXPECT_EQ(signs_of({}), Signs::positive);
}

/// value(p) on 41^3 points from -5 to 5 or so, so placed that no two are as far from 0.
template <class F>
std::vector<float> lattice(F&& value) {
  std::vector<float> values;
  for (int k = -20; k <= 20; ++k) {
    for (int j = -20; j <= 20; ++j) {
      for (int i = -20; i <= 20; ++i)
        values.push_back(
            static_cast<float>(value(Vector3d{i / 4.0 + 0.03, j / 4.0 + 0.07, k / 4.0 + 0.11})));
    }
  }
  return values;
}

// Within r^2 = 5.317 lie 85 % of a normal distribution in three dimensions (chi-square).
const double normal_level = std::exp(-5.317 / 2);

TEST(EnclosingLevel, OfADensityEnclosesItsIntegral) {
  const auto normal = lattice([](const Vector3d& p) { return std::exp(-dot(p, p) / 2); });
  EXPECT_NEAR(enclosing_level(normal, Signs::positive), normal_level, 0.02 * normal_level);
  const auto mirrored = lattice([](const Vector3d& p) { return -std::exp(-dot(p, p) / 2); });
  EXPECT_EQ(enclosing_level(mirrored, Signs::negative), enclosing_level(normal, Signs::positive));
  // Of an even ground nothing counts, if it is high.
  const auto low = lattice([](const Vector3d& p) { return 1e-3 + std::exp(-dot(p, p) / 2); });
  EXPECT_LT(enclosing_level(low, Signs::positive), 0.9 * normal_level);
  const auto raised = lattice([](const Vector3d& p) { return 3 + std::exp(-dot(p, p) / 2); });
  EXPECT_NEAR(enclosing_level(raised, Signs::positive), 3 + normal_level, 0.02 * normal_level);
}

TEST(EnclosingLevel, LeavesOutGroundOfATenthOfTheHighest) {
  EXPECT_NEAR(enclosing_level(std::vector{1.2f, 1.2f, 10.0f}, Signs::positive), 5.6, 0.05);
  // (nothing is lower, so that it is halfway down to 0, as of a mask)
  EXPECT_NEAR(enclosing_level(std::vector{0.8f, 0.8f, 0.8f, 10.0f}, Signs::positive), 0.4, 0.01);
}

// Of magnitudes between 1 and 1 + 1/256, which one bin holds.
TEST(EnclosingLevel, IsFinerThanItsBins) {
  std::vector<float> values{0.9999f};  // in the next one
  for (int i = 0; i < 1000; ++i) {
    values.push_back((i % 2 == 0 ? 1.0f : -1.0f) * (1 + (static_cast<float>(i) + 0.5f) / 256e3f));
  }
  EXPECT_NEAR(enclosing_level(values, Signs::both), 1 + 0.15 / 256, 0.01 / 256);
}

TEST(EnclosingLevel, OfAnAmplitudeEnclosesItsSquare) {
  const auto orbital =
      lattice([](const Vector3d& p) { return std::copysign(std::exp(-dot(p, p) / 4), p.x + 0.1); });
  const double level = std::sqrt(normal_level);
  EXPECT_NEAR(enclosing_level(orbital, Signs::both), level, 0.02 * level);
}

TEST(EnclosingLevel, LiesBetweenTheValuesOfAMask) {
  EXPECT_EQ(enclosing_level(std::vector{0.0f, 1.0f, 0.0f, 1.0f}, Signs::positive), 0.5);
  EXPECT_EQ(enclosing_level(std::vector{2.0f, 4.0f, 2.0f}, Signs::positive), 3);
  EXPECT_EQ(enclosing_level(std::vector{-2.0f, 0.0f, 2.0f}, Signs::both), 1);
}

TEST(EnclosingLevel, IsDefinedForAnyValues) {
  EXPECT_EQ(enclosing_level(std::vector{2.0f, 2.0f}, Signs::positive), 2);
  EXPECT_EQ(enclosing_level(std::vector{0.0f, 0.0f}, Signs::both), 0);
  EXPECT_EQ(enclosing_level({}, Signs::positive), 0);
  EXPECT_EQ(enclosing_level(std::vector{0.0f, 1.0f, NAN, infinity}, Signs::positive), 0.5);
}

RC_GTEST_PROP(EnclosingLevel, HasItsPartBeyondIt, (const std::vector<float>& values)) {
  const Signs signs = signs_of(values);
  const double level = enclosing_level(values, signs);
  double lowest = INFINITY, highest = 0, beyond = 0, all = 0;
  const auto magnitude = [&](float v) {
    return signs == Signs::both ? std::abs(v) : std::max(signs == Signs::positive ? v : -v, 0.0f);
  };
  for (const float v : values) {
    lowest = std::min(lowest, double{magnitude(v)});
    highest = std::max(highest, double{magnitude(v)});
  }
  if (signs == Signs::both || lowest < 0.1 * highest) lowest = 0;
  for (const float v : values) {
    const double above = magnitude(v) - lowest;
    const double part = signs == Signs::both ? above * above : above;
    all += part;
    if (above > (level - lowest) * (1 - 0.01)) beyond += part;  // a bin's width at most
  }
  RC_ASSERT(beyond >= 0.85 * all * (1 - 1e-9));
  RC_ASSERT(std::isfinite(level));
}

}  // namespace
}  // namespace motes
