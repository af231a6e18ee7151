// Bonds by distance against brute force over many images, in double precision.
#include "surface/find_bonds.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "particles/elements.h"
#include "particles/minimum_image.h"
#include "support/random_cells.h"
#include "surface/make_sticks.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Two fields in one tree, which share a third of the particles.
std::vector<FieldSource> overlapping_fields(const ParticleSet& particles) {
  std::vector<FieldSource> fields(2);
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    if (!std::isfinite(particles.x[i] + particles.y[i] + particles.z[i])) continue;
    if (i % 3 != 0) fields[0].index.push_back(i);
    if (i % 3 != 1) fields[1].index.push_back(i);
  }
  for (FieldSource& field : fields) field.radius = field.weight = {1};
  return fields;
}

std::vector<Bond> bonds_of(const ParticleSet& particles, const std::vector<bool>& among) {
  const auto fields = overlapping_fields(particles);
  KernelOrder order;
  const KernelSet kernels = build_kernel_set(particles, fields, &order);
  return find_bonds(particles, among, particles_in_order(fields, order), kernels);
}
std::vector<Bond> bonds_of(const ParticleSet& particles) {
  return bonds_of(particles, std::vector<bool>(particles.size(), true));
}

using Pair = std::pair<std::uint32_t, std::uint32_t>;

/// Lengths of the bonds between two atoms' images, and which pairs have one within `doubt` of a
/// limit.
struct Expected {
  std::map<Pair, std::vector<double>> lengths;
  std::set<Pair> doubtful;
};

Expected brute_force_bonds(const ParticleSet& particles) {
  constexpr double doubt = 1e-9;  // positions are the same; only sums round
  Expected expected;
  std::vector<const Element*> elements;
  for (const std::uint16_t species : particles.species) {
    elements.push_back(find_element(particles.species_names[species]));
  }
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    for (std::uint32_t j = i; j < particles.size(); ++j) {
      const Element *const a = elements[i], *const b = elements[j];
      if (a == nullptr || b == nullptr || (a->number == 1 && b->number == 1)) continue;
      if (is_metal(*a) && is_metal(*b)) continue;
      const double most = double(a->covalent_radius) + double(b->covalent_radius) + 0.45;
      const auto take = [&](const Vector3d& v) {
        const double d = length(v);
        if (std::abs(d - most) < doubt || std::abs(d - 0.4) < doubt)
          expected.doubtful.emplace(i, j);
        if (d > 0.4 && d < most) expected.lengths[{i, j}].push_back(d);
      };
      const Vector3d v = particles.position(j) - particles.position(i);
      if (particles.cell) {
        for_images(*particles.cell, v, most, take);
      } else {
        take(v);
      }
    }
  }
  return expected;
}

void expect_brute_force(const ParticleSet& particles, const std::string& what) {
  const std::vector<Bond> found = bonds_of(particles);
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [](const Bond& a, const Bond& b) {
    return std::tie(a.first, a.second, a.image) < std::tie(b.first, b.second, b.image);
  })) << what;
  const MinimumImage image(particles.cell);
  std::map<Pair, std::vector<double>> lengths;
  for (const Bond& bond : found) {
    const Vector3d v = particles.position(bond.second) - particles.position(bond.first);
    const double d = length(image(v) + image.shift(bond.image));
    // A bond to an image of itself is seen from both its ends.
    for (int end = bond.first == bond.second ? 0 : 1; end < 2; ++end) {
      lengths[{bond.first, bond.second}].push_back(d);
    }
  }
  Expected expected = brute_force_bonds(particles);
  for (const Pair& pair : expected.doubtful) {
    lengths.erase(pair);
    expected.lengths.erase(pair);
  }
  ASSERT_EQ(lengths.size(), expected.lengths.size()) << what;
  for (auto& [pair, all] : expected.lengths) {
    std::vector<double>& mine = lengths[pair];
    std::sort(all.begin(), all.end());
    std::sort(mine.begin(), mine.end());
    ASSERT_EQ(mine.size(), all.size()) << what << ": " << pair.first << " " << pair.second;
    for (std::size_t k = 0; k < all.size(); ++k) EXPECT_NEAR(mine[k], all[k], 1e-9) << what;
  }
}

/// In the cell and so many edges around it.
ParticleSet random_atoms(CellSource& source, const Cell& cell, std::size_t n, double around = 0.3) {
  static const std::array<std::string, 5> species{"Si", "O", "H", "Cs", "water"};
  std::vector<std::pair<std::string, Point3d>> atoms;
  for (std::size_t i = 0; i < n; ++i) {
    const auto part = [&] { return (1 + 2 * around) * source.uniform() - around; };
    atoms.emplace_back(species[static_cast<std::size_t>(5 * source.uniform())],
                       Point3d{1, 2, 3} + part() * cell.vectors[0] + part() * cell.vectors[1] +
                           part() * cell.vectors[2]);
  }
  ParticleSet particles = atoms_at(atoms);
  particles.cell = cell;
  return particles;
}

TEST(FindBonds, AgreesWithBruteForceInSkewedCells) {
  CellSource source(2);
  std::size_t bonds = 0;
  for (int round = 0; round < 60; ++round) {
    // From cells narrower than a bond to such that have many bins.
    const double edge = 3 * std::exp(3.0 * source.uniform());
    const Cell cell = source.draw(edge);
    const ParticleSet particles = random_atoms(source, cell, 60);
    expect_brute_force(particles, fmt::format("round {}", round));
    bonds += bonds_of(particles).size();
  }
  EXPECT_GT(bonds, 4000U);
}

// As trajectories have them whose molecules stay whole while they wander.
TEST(FindBonds, AgreesWithBruteForceFarOutsideTheCell) {
  CellSource source(5);
  std::size_t bonds = 0;
  for (int round = 0; round < 8; ++round) {
    const Cell cell = source.draw(10);
    const ParticleSet particles = random_atoms(source, cell, 120, round < 4 ? 2 : 40);
    expect_brute_force(particles, fmt::format("round {}", round));
    bonds += bonds_of(particles).size();
  }
  EXPECT_GT(bonds, 500U);
}

TEST(FindBonds, AgreesWithBruteForceInLargeCells) {
  CellSource source(6);
  for (int round = 0; round < 4; ++round) {
    expect_brute_force(random_atoms(source, source.draw(40), 400), fmt::format("round {}", round));
  }
}

TEST(FindBonds, KeepsToTheAtomsThatItIsAmong) {
  CellSource source(7);
  const ParticleSet particles = random_atoms(source, source.draw(12), 300);
  std::vector<bool> among(particles.size());
  for (std::size_t i = 0; i < among.size(); ++i) among[i] = i % 2 == 0 || i < 100;
  std::vector<Bond> expected = bonds_of(particles);
  std::erase_if(expected, [&](const Bond& b) { return !among[b.first] || !among[b.second]; });
  EXPECT_GT(expected.size(), 100U);
  EXPECT_EQ(bonds_of(particles, among), expected);
}

TEST(FindBonds, AgreesWithBruteForceWithoutACell) {
  CellSource source(3);
  for (const double edge : {1., 5., 30.}) {
    const Cell cube{{}, {Vector3d{edge, 0, 0}, Vector3d{0, edge, 0}, Vector3d{0, 0, edge}}, {}};
    ParticleSet particles = random_atoms(source, cube, 400);
    particles.cell.reset();
    expect_brute_force(particles, fmt::format("edge {}", edge));
  }
}

TEST(FindBonds, TakesBondsAcrossTheFacesOfACell) {
  ParticleSet particles = atoms_at({{"Si", {0.2, 5, 5}}, {"O", {9, 5, 5}}});
  EXPECT_THAT(bonds_of(particles), IsEmpty());
  particles.cell =
      Cell{{}, {Vector3d{10, 0, 0}, Vector3d{0, 10, 0}, Vector3d{0, 0, 10}}, {true, true, true}};
  EXPECT_THAT(bonds_of(particles), ElementsAre(Bond{0, 1}));
  particles.cell->periodic = {false, true, true};
  EXPECT_THAT(bonds_of(particles), IsEmpty());
}

// Silicon has four neighbours, a centred cubic cell eight, a chain one on each side.
TEST(FindBonds, TakesAllImagesInTheCellsOfCrystals) {
  const double a = 5.431;
  ParticleSet silicon = atoms_at({{"Si", {0, 0, 0}}, {"Si", {a / 4, a / 4, a / 4}}});
  silicon.cell =
      Cell{{},
           {Vector3d{0, a / 2, a / 2}, Vector3d{a / 2, 0, a / 2}, Vector3d{a / 2, a / 2, 0}},
           {true, true, true}};
  EXPECT_EQ(bonds_of(silicon).size(), 4U);
  ParticleSet centred = atoms_at({{"Kr", {0, 0, 0}}, {"Kr", {1.43, 1.43, 1.43}}});
  centred.cell = Cell{
      {}, {Vector3d{2.86, 0, 0}, Vector3d{0, 2.86, 0}, Vector3d{0, 0, 2.86}}, {true, true, true}};
  // 2.48 between the two; 2.86 between images of each, three ways: 1.16 + 1.16 + 0.45 = 2.77.
  EXPECT_EQ(bonds_of(centred).size(), 8U);
  for (auto& vector : centred.cell->vectors) vector = 0.96 * vector;
  EXPECT_EQ(bonds_of(centred).size(), 8U + 3U + 3U);
  ParticleSet chain = atoms_at({{"C", {0.2, 5, 5}}, {"C", {1.7, 5, 5}}});
  chain.cell =
      Cell{{}, {Vector3d{3, 0, 0}, Vector3d{0, 10, 0}, Vector3d{0, 0, 10}}, {true, true, true}};
  EXPECT_EQ(bonds_of(chain).size(), 2U);
}

TEST(FindBonds, KeepsToItsRule) {
  EXPECT_THAT(bonds_of(atoms_at({{"H", {0, 0, 0}}, {"H", {0.74, 0, 0}}})), IsEmpty());
  EXPECT_THAT(bonds_of(atoms_at({{"O", {0, 0, 0}}, {"H", {0.96, 0, 0}}})), ElementsAre(Bond{0, 1}));
  // 0.66 + 0.76 + 0.45
  EXPECT_THAT(bonds_of(atoms_at({{"O", {0, 0, 0}}, {"C", {1.86, 0, 0}}})), ElementsAre(Bond{0, 1}));
  EXPECT_THAT(bonds_of(atoms_at({{"O", {0, 0, 0}}, {"C", {1.88, 0, 0}}})), IsEmpty());
  EXPECT_THAT(bonds_of(atoms_at({{"O", {0, 0, 0}}, {"O", {0.39, 0, 0}}})), IsEmpty());
  EXPECT_THAT(bonds_of(atoms_at({{"O", {0, 0, 0}}, {"clay", {1, 0, 0}}})), IsEmpty());
  // Metals are bonded to others, not to each other.
  EXPECT_THAT(bonds_of(atoms_at({{"Fe", {0, 0, 0}}, {"Cu", {2.5, 0, 0}}})), IsEmpty());
  EXPECT_THAT(bonds_of(atoms_at({{"Fe", {0, 0, 0}}, {"O", {1.9, 0, 0}}})), ElementsAre(Bond{0, 1}));
  EXPECT_THAT(bonds_of(atoms_at({{"Ge", {0, 0, 0}}, {"Ge", {2.4, 0, 0}}})),
              ElementsAre(Bond{0, 1}));
}

TEST(FindBonds, TakesWhatHasNoAtoms) {
  EXPECT_THAT(bonds_of(ParticleSet()), IsEmpty());
  ParticleSet particles = atoms_at({{"O", {0, 0, 0}}, {"C", {1.2, 0, 0}}});
  particles.x[0] = std::nanf("");
  EXPECT_THAT(bonds_of(particles), IsEmpty());
  particles.species.clear();
  EXPECT_THAT(bonds_of(particles), IsEmpty());
}

TEST(FindBonds, TakesAtomsFarApart) {
  const ParticleSet particles = atoms_at(
      {{"C", {0, 0, 0}}, {"C", {1e12, 0, 0}}, {"C", {0, 1.25, 0}}, {"C", {0, -3e9, 8e11}}});
  EXPECT_THAT(bonds_of(particles), ElementsAre(Bond{0, 2}));
}

TEST(FindBonds, AreTheSameForAnyNumberOfThreads) {
  const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism, 5);
  CellSource source(4);
  const Cell cube{
      {}, {Vector3d{90, 0, 0}, Vector3d{0, 90, 0}, Vector3d{0, 0, 90}}, {true, true, true}};
  const ParticleSet particles = random_atoms(source, cube, 50000);
  const auto bonds_with = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return bonds_of(particles); });
  };
  const std::vector<Bond> alone = bonds_with(1);
  EXPECT_GT(alone.size(), 50000U);
  EXPECT_EQ(bonds_with(5), alone);
}

}  // namespace
}  // namespace motes
