// Where default radii come from, in order.
#include "particles/radii.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace motes {
namespace {

/// A cubic lattice of n^3 particles.
ParticleSet lattice(int n, float spacing) {
  ParticleSet particles;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        particles.x.push_back(static_cast<float>(i) * spacing);
        particles.y.push_back(static_cast<float>(j) * spacing);
        particles.z.push_back(static_cast<float>(k) * spacing);
      }
    }
  }
  particles.length_unit = "angstrom";
  return particles;
}

TEST(DefaultRadii, ComeFromThePropertyFirst) {
  ParticleSet particles = lattice(2, 1);
  particles.species.assign(8, particles.species_index("Si"));
  particles.properties.push_back({"radius", std::vector<float>(8, 0.25F)});
  Warnings warnings;
  EXPECT_EQ(default_radii(particles, warnings).radius, std::vector<float>(8, 0.25F));
}

TEST(DefaultRadii, ComeFromNeighboursOfTheSameSpeciesWhereAskedFor) {
  ParticleSet particles = lattice(10, 1);
  // Two interleaved lattices: the first with radii of its own.
  const std::uint16_t gas = particles.species_index("gas"), dark = particles.species_index("dark");
  std::vector<float> radius(particles.size(), NAN);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.species.push_back(particles.x[i] < 5 ? gas : dark);
    if (particles.species[i] == gas) radius[i] = 0.25F;
  }
  EXPECT_FALSE(has_sizes(particles));
  particles.radii_from_neighbors = true;
  EXPECT_TRUE(has_sizes(particles));
  particles.properties.push_back({"radius", radius});
  Warnings warnings;
  const std::vector<float> found = default_radii(particles, warnings).radius;
  ASSERT_EQ(found.size(), particles.size());
  // In the middle of the dark half: 6 neighbours at 1, 12 at sqrt(2), 8 at sqrt(3), 6 at 2.
  const std::size_t middle = 7 * 100 + 5 * 10 + 5;
  EXPECT_NEAR(found[middle], 2 / 3.651484, 1e-5);
  EXPECT_EQ(found[0], 0.25F);
  EXPECT_EQ(default_radii_source(particles), default_radii(particles, warnings).source);
}

TEST(DefaultRadii, OfManyCoincidentNeighboursAreZero) {
  ParticleSet particles = lattice(1, 1);
  for (auto* values : {&particles.x, &particles.y, &particles.z}) values->resize(200000);
  particles.radii_from_neighbors = true;
  Warnings warnings;
  EXPECT_EQ(default_radii(particles, warnings).radius, std::vector<float>(200000));
}

TEST(DefaultRadii, ComeFromTheElements) {
  ParticleSet particles = lattice(2, 1);
  particles.species.assign(8, particles.species_index("Si"));
  particles.species[3] = particles.species_index("O");
  Warnings warnings;
  const DefaultRadii radii = default_radii(particles, warnings);
  ASSERT_EQ(radii.radius.size(), 8U);
  EXPECT_FLOAT_EQ(radii.radius[0], 1.11F);
  EXPECT_FLOAT_EQ(radii.radius[3], 0.66F);
  EXPECT_TRUE(warnings.lines().empty());
}

TEST(DefaultRadii, OfAFewStrangersAreTheMeanOfTheOthers) {
  ParticleSet particles = lattice(2, 1);
  particles.species.assign(8, particles.species_index("O"));
  particles.species[0] = particles.species_index("wall");
  Warnings warnings;
  EXPECT_FLOAT_EQ(default_radii(particles, warnings).radius[0], 0.66F);
  EXPECT_THAT(warnings.lines(), testing::ElementsAre(testing::HasSubstr("wall")));
}

TEST(DefaultRadii, ComeFromTheSpacingWhereMostAreNoElements) {
  ParticleSet particles = lattice(6, 3);
  particles.species.assign(particles.size(), particles.species_index("bead"));
  particles.species[0] = particles.species_index("O");
  Warnings warnings;
  const DefaultRadii radii = default_radii(particles, warnings);
  ASSERT_EQ(radii.radius.size(), 1U);
  EXPECT_NEAR(radii.radius[0], 1.5, 1e-5);
  EXPECT_TRUE(warnings.lines().empty());
}

TEST(DefaultRadii, DoNotTakeElementsWhereLengthsAreNoAngstrom) {
  ParticleSet particles = lattice(3, 2);
  particles.species.assign(particles.size(), particles.species_index("Si"));
  particles.length_unit = "kpc/h";
  Warnings warnings;
  EXPECT_NEAR(default_radii(particles, warnings).radius[0], 1, 1e-5);
}

TEST(DefaultRadii, AreOneForALoneParticle) {
  Warnings warnings;
  EXPECT_EQ(default_radii(lattice(1, 1), warnings).radius, std::vector<float>{1});
  EXPECT_EQ(default_radii(ParticleSet{}, warnings).radius, std::vector<float>{1});
}

TEST(MeanNeighborDistance, LeavesOutCoincidentParticles) {
  ParticleSet particles = lattice(3, 2);
  for (auto* values : {&particles.x, &particles.y, &particles.z}) values->push_back(0);
  EXPECT_NEAR(mean_neighbor_distance(particles), 2, 1e-5);
}

}  // namespace
}  // namespace motes
