// Kernels in the tree's order: what is stored of radii and weights, built and refitted.
#include "field/kernel_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "support/particles_at.h"

namespace motes {
namespace {

constexpr std::size_t num_particles = 1000;
constexpr std::size_t padded = 1008;  // whole leaves
constexpr std::size_t leaf_bytes = 64;

ParticleSet random_particles() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-4, 4);
  std::vector<Point3d> points;
  for (std::size_t i = 0; i < num_particles; ++i) {
    points.push_back({coordinate(random), coordinate(random), coordinate(random)});
  }
  return particles_at(points);
}

/// `count` values from `low` to `high`, in no order.
std::vector<float> values(std::size_t count, float low, float high) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(low, high);
  std::vector<float> all(count);
  std::generate(all.begin(), all.end(), [&] { return value(random); });
  return all;
}

/// A field of all particles with these radii and weights, one or one each.
FieldSource field_with(std::vector<float> radius, std::vector<float> weight) {
  FieldSource field;
  field.name = "field";
  for (std::uint32_t i = 0; i < num_particles; ++i) field.index.push_back(i);
  field.radius = std::move(radius);
  field.weight = std::move(weight);
  return field;
}

/// The kernels of `set` are those of `fields`, each in the place that `order` gives it.
void expect_values(const KernelSet& set, const KernelOrder& order,
                   const std::vector<FieldSource>& fields) {
  const auto scale = static_cast<float>(set.length_scale);
  float largest = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const std::size_t f = set.field.empty() ? 0 : set.field[i];
    const std::size_t j = order.kernels[i] - order.begins[f];
    ASSERT_EQ(set.radius[i], fields[f].radius_of(j) * scale) << i;
    ASSERT_EQ(*set.radius.from(i), set.radius[i]) << i;
    ASSERT_EQ(set.weight[i], static_cast<float>(fields[f].weight_of(j) * set.fields[f].value_scale))
        << i;
    largest = std::max(largest, set.radius[i]);
  }
  EXPECT_EQ(*std::ranges::max_element(set.bvh.nodes.front().max_radius), largest);
}

TEST(PerKernel, ReadsOneValueLikeAnArrayOfIt) {
  PerKernel shared, stored;
  shared.share(2.5f);
  stored.allocate(40);
  for (std::size_t i = 0; i < 40; ++i) stored.at(i) = 2.5f;
  EXPECT_EQ(shared.bytes(), leaf_bytes);
  EXPECT_EQ(stored.bytes(), 3 * leaf_bytes);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(shared[i], stored[i]);
    // What a vector loads from there on, up to the end of the leaf.
    for (std::size_t j = i; j < 40 && j / 16 == i / 16; ++j) {
      EXPECT_EQ(shared.from(i)[j - i], stored.from(i)[j - i]) << i << " " << j;
    }
  }
  EXPECT_EQ(shared.first(40).size(), 1U);
  EXPECT_EQ(stored.first(40).size(), 40U);
}

TEST(KernelSet, KeepsNoArrayOfWhatAllKernelsShare) {
  const ParticleSet particles = random_particles();
  const std::vector<float> radii = values(num_particles, 0.3f, 0.6f),
                           weights = values(num_particles, -2, 3);
  // Whether one is given, or many that are the same.
  const std::vector<float> one = {0.75f}, same(num_particles, 0.75f);
  struct Case {
    std::vector<float> radius, weight;
    std::size_t bytes;
  };
  constexpr std::size_t positions = 12 * padded, array = 4 * padded;
  for (const Case& c :
       {Case{one, same, positions + 2 * leaf_bytes}, Case{same, one, positions + 2 * leaf_bytes},
        Case{radii, one, positions + array + leaf_bytes},
        Case{same, weights, positions + leaf_bytes + array},
        Case{radii, weights, positions + 2 * array}}) {
    const std::vector<FieldSource> fields{field_with(c.radius, c.weight)};
    KernelOrder order;
    const KernelSet set = build_kernel_set(particles, fields, &order);
    EXPECT_EQ(set.particle_bytes(), c.bytes);
    expect_values(set, order, fields);
  }
}

TEST(KernelSet, SharesOneValueAmongFields) {
  const ParticleSet particles = random_particles();
  // A field's internal weights are its weights times a power of two.
  std::vector<FieldSource> fields{field_with({0.5f}, {0.75f}), field_with({0.5f}, {6})};
  KernelOrder order;
  KernelSet set = build_kernel_set(particles, fields, &order);
  EXPECT_TRUE(set.radius.is_shared());
  EXPECT_TRUE(set.weight.is_shared());
  expect_values(set, order, fields);
  // Each field has one value, but they are two.
  fields[1].radius = {0.25f};
  fields[1].weight = {-6};
  set = build_kernel_set(particles, fields, &order);
  EXPECT_FALSE(set.radius.is_shared());
  EXPECT_FALSE(set.weight.is_shared());
  expect_values(set, order, fields);
  // Weights over the cube of radii that differ.
  std::vector<FieldSource> normalised{field_with(values(num_particles, 0.3f, 0.6f), {1})};
  normalised[0].normalise = true;
  EXPECT_FALSE(build_kernel_set(particles, normalised).weight.is_shared());
  normalised[0].radius = {0.5f};
  EXPECT_TRUE(build_kernel_set(particles, normalised).weight.is_shared());
}

TEST(KernelSet, FieldsWithoutParticlesShareNothingAndSpoilNothing) {
  const ParticleSet particles = random_particles();
  FieldSource none;
  none.radius = {7};
  none.weight = {3};
  const std::vector<FieldSource> fields{field_with({0.5f}, {1}), none};
  KernelOrder order;
  const KernelSet set = build_kernel_set(particles, fields, &order);
  EXPECT_TRUE(set.radius.is_shared());
  EXPECT_TRUE(set.weight.is_shared());
  expect_values(set, order, fields);
}

TEST(KernelSet, RefitsFromSharedToStoredAndBack) {
  const ParticleSet particles = random_particles();
  const std::vector<FieldSource> shared{field_with({0.5f}, {1})};
  const std::vector<FieldSource> stored{
      field_with(values(num_particles, 0.3f, 0.6f), values(num_particles, 1, 2))};
  KernelOrder order;
  KernelSet set = build_kernel_set(particles, shared, &order);
  const std::size_t least = set.particle_bytes();
  for (const auto* fields : {&stored, &shared, &stored, &stored, &shared}) {
    ASSERT_TRUE(refit_kernel_set(particles, *fields, order, set));
    EXPECT_EQ(set.radius.is_shared(), fields == &shared);
    EXPECT_EQ(set.weight.is_shared(), fields == &shared);
    expect_values(set, order, *fields);
    EXPECT_EQ(set.particle_bytes(), fields == &shared ? least : 20 * padded);
  }
}

}  // namespace
}  // namespace motes
