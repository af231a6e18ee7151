// What is fitted to the data besides the camera: that pictures are neither fog nor block.
#include "scene/fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "core/error.h"
#include "scene/fit_levels.h"

namespace motes {
namespace {

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

}  // namespace
}  // namespace motes
