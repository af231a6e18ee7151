// Bonds and nearest images against brute force over many images, in double precision.
#include "particles/bonds.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "particles/elements.h"
#include "particles/minimum_image.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Calls use(w) with the images w of v in the cell, all that are as short as v or as `reach`.
template <class F>
void for_images(const Cell& cell, const Vector3d& v, double reach, F&& use) {
  const std::array<Vector3d, 3>& e = cell.vectors;
  const double volume = dot(e[0], cross(e[1], e[2]));
  std::array<int, 3> most{};
  for (std::size_t a = 0; a < 3; ++a) {
    // From v to such an image it is so far at most, and planes of images are so far apart:
    const double way = length(v) + std::max(length(v), reach);
    const double spacing = std::abs(volume) / length(cross(e[(a + 1) % 3], e[(a + 2) % 3]));
    if (cell.periodic[a]) most[a] = static_cast<int>(way / spacing) + 1;
  }
  for (int i = -most[0]; i <= most[0]; ++i) {
    for (int j = -most[1]; j <= most[1]; ++j) {
      for (int k = -most[2]; k <= most[2]; ++k) {
        use(v + double(i) * e[0] + double(j) * e[1] + double(k) * e[2]);
      }
    }
  }
}

/// The length of the shortest of v's images.
double brute_force_distance(const Cell& cell, const Vector3d& v) {
  double nearest = length(v);
  for_images(cell, v, 0, [&](const Vector3d& w) { nearest = std::min(nearest, length(w)); });
  return nearest;
}

/// A cell with edges of up to `edge` in all directions, any of them periodic.
class CellSource {
 public:
  explicit CellSource(unsigned seed) : random_(seed) {}
  Cell draw(double edge) {
    Cell cell;
    do {
      for (Vector3d& v : cell.vectors) v = draw_vector(edge);
    } while (std::abs(dot(cell.vectors[0], cross(cell.vectors[1], cell.vectors[2]))) <
             0.05 * edge * edge * edge);
    for (bool& periodic : cell.periodic) periodic = uniform() < 0.75;
    return cell;
  }
  Vector3d draw_vector(double edge) {
    return {edge * (2 * uniform() - 1), edge * (2 * uniform() - 1), edge * (2 * uniform() - 1)};
  }
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }

 private:
  std::mt19937 random_;
};

TEST(MinimumImage, IsTheNearestOfManyInSkewedCells) {
  CellSource source(1);
  for (int round = 0; round < 300; ++round) {
    const Cell cell = source.draw(3);
    const MinimumImage image(cell);
    for (int i = 0; i < 10; ++i) {
      const Vector3d v = source.draw_vector(3);
      const Vector3d nearest = image(v);
      EXPECT_NEAR(length(nearest), brute_force_distance(cell, v), 1e-9);
      // It is an image, and that of -v lies opposite.
      EXPECT_NEAR(brute_force_distance(cell, nearest - v), 0, 1e-9);
      EXPECT_EQ(image(-v), -nearest);
    }
  }
}

TEST(MinimumImage, TakesEdgesFarLongerThanTheyAreApart) {
  const Cell cell{{}, {Vector3d{1, 0, 0}, Vector3d{1e4 + 0.3, 1, 0}, Vector3d{-700, 400, 1}}, {}};
  Cell periodic = cell;
  periodic.periodic = {true, true, true};
  const MinimumImage image(periodic);
  ASSERT_EQ(image.edges().size(), 3U);
  for (const Vector3d& edge : image.edges()) EXPECT_LT(length(edge), 2);
  EXPECT_LT(length(image({5e5, -3e4, 77})), 1.5);
  const Vector3d v{5, 6, 7};
  EXPECT_EQ(MinimumImage(cell)(v), v);
}

TEST(MinimumImage, LeavesOutEdgesThatSpanNothing) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Cell flat{
      {}, {Vector3d{2, 0, 0}, Vector3d{4, 0, 0}, Vector3d{0, infinity, 0}}, {true, true, true}};
  EXPECT_EQ(MinimumImage(flat)({4.5, 1, 1}), Vector3d(0.5, 1, 1));
  EXPECT_THAT(MinimumImage(std::nullopt).edges(), IsEmpty());
}

ParticleSet atoms_at(const std::vector<std::pair<std::string, Point3d>>& atoms) {
  ParticleSet particles;
  std::vector<double> x, y, z;
  for (const auto& [species, p] : atoms) {
    particles.species.push_back(particles.species_index(species));
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  set_positions(particles, x, y, z);
  return particles;
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
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    for (std::uint32_t j = i; j < particles.size(); ++j) {
      const Element* a = find_element(particles.species_names[particles.species[i]]);
      const Element* b = find_element(particles.species_names[particles.species[j]]);
      if (a == nullptr || b == nullptr || (a->number == 1 && b->number == 1)) continue;
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
  const std::vector<Bond> found = find_bonds(particles);
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

ParticleSet random_atoms(CellSource& source, const Cell& cell, std::size_t n) {
  static const std::array<std::string, 5> species{"Si", "O", "H", "Cs", "water"};
  std::vector<std::pair<std::string, Point3d>> atoms;
  for (std::size_t i = 0; i < n; ++i) {
    // Some lie outside their cell.
    const auto part = [&] { return 1.6 * source.uniform() - 0.3; };
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
    bonds += find_bonds(particles).size();
  }
  EXPECT_GT(bonds, 4000U);
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
  EXPECT_THAT(find_bonds(particles), IsEmpty());
  particles.cell =
      Cell{{}, {Vector3d{10, 0, 0}, Vector3d{0, 10, 0}, Vector3d{0, 0, 10}}, {true, true, true}};
  EXPECT_THAT(find_bonds(particles), ElementsAre(Bond{0, 1}));
  particles.cell->periodic = {false, true, true};
  EXPECT_THAT(find_bonds(particles), IsEmpty());
}

// Silicon has four neighbours, iron in its conventional cell eight, a chain one on each side.
TEST(FindBonds, TakesAllImagesInTheCellsOfCrystals) {
  const double a = 5.431;
  ParticleSet silicon = atoms_at({{"Si", {0, 0, 0}}, {"Si", {a / 4, a / 4, a / 4}}});
  silicon.cell =
      Cell{{},
           {Vector3d{0, a / 2, a / 2}, Vector3d{a / 2, 0, a / 2}, Vector3d{a / 2, a / 2, 0}},
           {true, true, true}};
  EXPECT_EQ(find_bonds(silicon).size(), 4U);
  ParticleSet iron = atoms_at({{"Fe", {0, 0, 0}}, {"Fe", {1.43, 1.43, 1.43}}});
  iron.cell = Cell{
      {}, {Vector3d{2.86, 0, 0}, Vector3d{0, 2.86, 0}, Vector3d{0, 0, 2.86}}, {true, true, true}};
  // 2.48 between the two; 2.86 between images of each, three ways: 1.32 + 1.32 + 0.45 = 3.09.
  EXPECT_EQ(find_bonds(iron).size(), 8U + 3U + 3U);
  ParticleSet chain = atoms_at({{"C", {0.2, 5, 5}}, {"C", {1.7, 5, 5}}});
  chain.cell =
      Cell{{}, {Vector3d{3, 0, 0}, Vector3d{0, 10, 0}, Vector3d{0, 0, 10}}, {true, true, true}};
  EXPECT_EQ(find_bonds(chain).size(), 2U);
}

TEST(FindBonds, KeepsToItsRule) {
  EXPECT_THAT(find_bonds(atoms_at({{"H", {0, 0, 0}}, {"H", {0.74, 0, 0}}})), IsEmpty());
  EXPECT_THAT(find_bonds(atoms_at({{"O", {0, 0, 0}}, {"H", {0.96, 0, 0}}})),
              ElementsAre(Bond{0, 1}));
  // 0.66 + 0.76 + 0.45
  EXPECT_THAT(find_bonds(atoms_at({{"O", {0, 0, 0}}, {"C", {1.86, 0, 0}}})),
              ElementsAre(Bond{0, 1}));
  EXPECT_THAT(find_bonds(atoms_at({{"O", {0, 0, 0}}, {"C", {1.88, 0, 0}}})), IsEmpty());
  EXPECT_THAT(find_bonds(atoms_at({{"O", {0, 0, 0}}, {"O", {0.39, 0, 0}}})), IsEmpty());
  EXPECT_THAT(find_bonds(atoms_at({{"O", {0, 0, 0}}, {"clay", {1, 0, 0}}})), IsEmpty());
}

TEST(FindBonds, TakesWhatHasNoAtoms) {
  EXPECT_THAT(find_bonds(ParticleSet()), IsEmpty());
  ParticleSet particles = atoms_at({{"O", {0, 0, 0}}, {"C", {1.2, 0, 0}}});
  particles.x[0] = std::nanf("");
  EXPECT_THAT(find_bonds(particles), IsEmpty());
  particles.species.clear();
  EXPECT_THAT(find_bonds(particles), IsEmpty());
}

TEST(FindBonds, TakesAtomsFarApart) {
  const ParticleSet particles = atoms_at(
      {{"C", {0, 0, 0}}, {"C", {1e12, 0, 0}}, {"C", {0, 1.25, 0}}, {"C", {0, -3e9, 8e11}}});
  EXPECT_THAT(find_bonds(particles), ElementsAre(Bond{0, 2}));
}

TEST(FindBonds, AreTheSameForAnyNumberOfThreads) {
  const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism, 5);
  CellSource source(4);
  const Cell cube{
      {}, {Vector3d{90, 0, 0}, Vector3d{0, 90, 0}, Vector3d{0, 0, 90}}, {true, true, true}};
  const ParticleSet particles = random_atoms(source, cube, 50000);
  const auto bonds_with = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return find_bonds(particles); });
  };
  const std::vector<Bond> alone = bonds_with(1);
  EXPECT_GT(alone.size(), 50000U);
  EXPECT_EQ(bonds_with(5), alone);
}

TEST(FileBonds, AreSortedOnceEachAndNeverOfAParticleToItself) {
  ParticleSet particles = atoms_at({{"C", {0, 0, 0}}, {"C", {1, 0, 0}}, {"C", {2, 0, 0}}});
  particles.bonds = {{1, 2}, {0, 0}, {0, 1}, {2, 1}, {2, 2}};
  Warnings warnings;
  EXPECT_THAT(file_bonds(particles, warnings), ElementsAre(Bond{0, 1}, Bond{1, 2}));
  EXPECT_THAT(warnings.lines(), ElementsAre("2 bonds of a particle to itself left out"));
  particles.bonds.clear();
  EXPECT_THAT(file_bonds(particles, warnings), IsEmpty());
  EXPECT_EQ(warnings.lines().size(), 1U);
}

}  // namespace
}  // namespace motes
