// Nearest images against brute force over many of them, and the bonds of files.
#include "particles/bonds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "particles/minimum_image.h"
#include "support/random_cells.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// The length of the shortest of v's images.
double brute_force_distance(const Cell& cell, const Vector3d& v) {
  double nearest = length(v);
  for_images(cell, v, 0, [&](const Vector3d& w) { nearest = std::min(nearest, length(w)); });
  return nearest;
}

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
