// Neighbour distances and smoothing lengths against brute force and closed forms.
#include "particles/neighbors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "particles/smoothing.h"

namespace motes {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

struct Cloud {
  std::vector<float> x, y, z;
  Coordinates coordinates() const { return {x, y, z}; }
};

Cloud random_cloud(std::size_t n, float edge, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(0, edge);
  Cloud cloud;
  for (std::size_t i = 0; i < n; ++i) {
    cloud.x.push_back(uniform(generator));
    cloud.y.push_back(uniform(generator));
    cloud.z.push_back(uniform(generator));
  }
  return cloud;
}

Cell cubic_cell(double edge) {
  return {
      {}, {Vector3d{edge, 0, 0}, Vector3d{0, edge, 0}, Vector3d{0, 0, edge}}, {true, true, true}};
}

double brute_force(const Cloud& cloud, std::size_t i, int k, const std::optional<Cell>& cell) {
  std::vector<double> distances;
  const int reach = cell ? 1 : 0;
  for (int a = -reach; a <= reach; ++a) {
    for (int b = -reach; b <= reach; ++b) {
      for (int c = -reach; c <= reach; ++c) {
        Vector3d shift;
        if (cell) {
          shift = double(a) * cell->vectors[0] + double(b) * cell->vectors[1] +
                  double(c) * cell->vectors[2];
        }
        for (std::size_t j = 0; j < cloud.x.size(); ++j) {
          if (j == i && a == 0 && b == 0 && c == 0) continue;
          distances.push_back(std::hypot(cloud.x[j] - cloud.x[i] + shift.x,
                                         cloud.y[j] - cloud.y[i] + shift.y,
                                         cloud.z[j] - cloud.z[i] + shift.z));
        }
      }
    }
  }
  const auto kth = distances.begin() + (k - 1);
  std::nth_element(distances.begin(), kth, distances.end());
  return *kth;
}

void expect_brute_force(const Cloud& cloud, int k, const std::optional<Cell>& cell) {
  const std::vector<float> distances = NeighborTree(cloud.coordinates(), cell).kth_distances(k);
  ASSERT_EQ(distances.size(), cloud.x.size());
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const double expected = brute_force(cloud, i, k, cell);
    ASSERT_NEAR(distances[i], expected, 1e-5 * (1 + expected)) << "particle " << i << ", k " << k;
  }
}

TEST(NeighborTree, AgreesWithBruteForce) {
  for (const std::size_t n : {2U, 13U, 100U, 777U}) {
    const Cloud cloud = random_cloud(n, 10, static_cast<unsigned>(n));
    expect_brute_force(cloud, 1, std::nullopt);
    if (n > 32) expect_brute_force(cloud, 32, std::nullopt);
  }
}

TEST(NeighborTree, AgreesWithBruteForceThroughPeriodicBoundaries) {
  const Cloud cloud = random_cloud(300, 10, 5);
  expect_brute_force(cloud, 32, cubic_cell(10));
  Cell triclinic = cubic_cell(10);
  triclinic.vectors[1] = {3, 9, 0};
  triclinic.vectors[2] = {-4, 2, 8};
  expect_brute_force(cloud, 7, triclinic);
}

TEST(NeighborTree, CountsCoincidentParticlesAndImagesAsNeighbours) {
  const Cloud coincident{{1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  EXPECT_EQ(NeighborTree(coincident.coordinates(), {}).kth_distances(2),
            std::vector<float>({0, 0, 0}));
  const Cloud lone{{1}, {1}, {1}};
  EXPECT_EQ(NeighborTree(lone.coordinates(), {}).kth_distances(1)[0], infinity);
  EXPECT_FLOAT_EQ(NeighborTree(lone.coordinates(), cubic_cell(4)).kth_distances(1)[0], 4);
}

TEST(NeighborTree, LeavesOutPositionsThatAreNotFinite) {
  const Cloud cloud{{0, std::nanf(""), 3, infinity}, {0, 0, 0, 0}, {0, 0, 0, 0}};
  const NeighborTree tree(cloud.coordinates(), {});
  EXPECT_EQ(tree.size(), 2U);
  EXPECT_EQ(tree.kth_distances(1), std::vector<float>({3, infinity, 3, infinity}));
}

TEST(NeighborTree, AnswersForTheWantedAloneAmongAll) {
  const Cloud cloud = random_cloud(777, 10, 3);
  const NeighborTree tree(cloud.coordinates(), {});
  const std::vector<float> all = tree.kth_distances(5);
  std::vector<bool> wanted(777);
  for (std::size_t i = 0; i < wanted.size(); i += 3) wanted[i] = true;
  const std::vector<float> some = tree.kth_distances(5, wanted);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(some[i], wanted[i] ? all[i] : infinity) << i;
  }
}

TEST(NeighborTree, SurvivesManyCoincidentParticles) {
  const Cloud cloud{std::vector<float>(50000, 1.0F), std::vector<float>(50000, 2.0F),
                    std::vector<float>(50000, 3.0F)};
  const NeighborTree tree(cloud.coordinates(), {});
  for (const float distance : tree.sample_nearest_distances(100)) EXPECT_EQ(distance, 0);
}

TEST(SmoothingLengths, HoldTheMassOf32ParticlesAtTheDensity) {
  const std::vector<float> mass{2, 2, 0, 1}, density{0.5F, 4, 1, -1};
  const std::vector<float> h = smoothing_lengths_from_density(mass, density);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_NEAR(4.0 / 3 * std::numbers::pi * std::pow(h[i], 3) * density[i], 32 * mass[i], 1e-4);
  }
  EXPECT_EQ(h[2], 0);
  EXPECT_EQ(h[3], 0);
}

TEST(SmoothingLengths, ReachThe32ndNeighbour) {
  const Cloud cloud = random_cloud(400, 10, 9);
  const std::vector<float> h =
      smoothing_lengths_from_neighbors(cloud.coordinates(), cubic_cell(10));
  EXPECT_NEAR(h[17], brute_force(cloud, 17, 32, cubic_cell(10)), 1e-4);
}

TEST(SmoothingLengths, OfFewParticlesAreScaledTo32) {
  const Cloud pair{{0, 1}, {0, 0}, {0, 0}};
  EXPECT_NEAR(smoothing_lengths_from_neighbors(pair.coordinates(), {})[0], std::cbrt(32.0), 1e-5);
  const Cloud lone{{0}, {0}, {0}};
  EXPECT_EQ(smoothing_lengths_from_neighbors(lone.coordinates(), {})[0], 0);
}

TEST(SmoothingLengths, CubicSplineHasTheStatedStandardDeviation) {
  // sigma^2 = <r^2>/3 of W(q) = 1 - 6q^2 + 6q^3 (q < 1/2), 2(1-q)^3 (q < 1), q = r/H.
  double norm = 0, second_moment = 0;
  const int steps = 100000;
  for (int i = 0; i < steps; ++i) {
    const double q = (i + 0.5) / steps;
    const double w = q < 0.5 ? 1 - 6 * q * q + 6 * q * q * q : 2 * std::pow(1 - q, 3);
    norm += w * q * q;
    second_moment += w * q * q * q * q;
  }
  EXPECT_NEAR(1 / std::sqrt(second_moment / norm / 3), support_per_sigma, 1e-4);
}

}  // namespace
}  // namespace motes
