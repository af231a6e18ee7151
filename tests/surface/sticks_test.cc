// Sticks of bonds, and how far nodes reach.
#include "surface/make_sticks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "particles/minimum_image.h"
#include "support/particles_at.h"
#include "surface/brute_force.h"
#include "surface/random_surface.h"

namespace motes {
namespace {

/// Particles as kernels of `fields`, and which kernel is which.
struct Kernels {
  KernelSet set;
  UninitializedVector<std::uint32_t> particle_of;

  Kernels(const ParticleSet& particles, const std::vector<FieldSource>& fields) {
    KernelOrder order;
    set = build_kernel_set(particles, fields, &order);
    particle_of = particles_in_order(fields, order);
  }
};

/// The halves that the kernels of a particle own; file's lengths.
std::vector<Vector3d> halves_of(const Sticks& sticks, const Kernels& kernels,
                                std::uint32_t particle) {
  std::vector<Vector3d> halves;
  for (std::size_t i = 0; i < kernels.set.size(); ++i) {
    if (kernels.particle_of[i] != particle) continue;
    for (std::size_t s = sticks.begin[i]; s < sticks.begin[i + 1]; ++s) {
      EXPECT_EQ(sticks.owner[s], i % Bvh::leaf_size);
      halves.push_back(Vector3d{sticks.x[s], sticks.y[s], sticks.z[s]} / kernels.set.length_scale);
    }
  }
  return halves;
}

void expect_halves(const std::vector<Vector3d>& found, const std::vector<Vector3d>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LT(length(found[i] - expected[i]), 1e-5) << i;  // positions are rounded to floats
  }
}

TEST(Sticks, AreHalvesOfBondsOwnedByTheirAtoms) {
  std::vector<Point3d> points;
  points.reserve(40);
  for (int i = 0; i < 40; ++i) points.emplace_back(i, 0.1 * i * i, 0);
  const ParticleSet particles = particles_at(points);
  const Kernels kernels(particles, {field_of_all(particles, 1, 1, {})});
  const std::vector<Bond> bonds{{3, 4}, {3, 30}, {10, 39}};
  const Sticks sticks = make_sticks(particles, bonds, kernels.particle_of, kernels.set, 0.25f);
  EXPECT_EQ(sticks.size(), 6U);
  EXPECT_EQ(sticks.radius_of(5), 0.25f);
  expect_halves(halves_of(sticks, kernels, 3), {{0.5, 0.35, 0}, {13.5, 44.55, 0}});
  expect_halves(halves_of(sticks, kernels, 4), {{-0.5, -0.35, 0}});
  expect_halves(halves_of(sticks, kernels, 39), {{-14.5, -71.05, 0}});
  expect_halves(halves_of(sticks, kernels, 5), {});
}

TEST(Sticks, GoTowardsTheNearestImageInAPeriodicCell) {
  ParticleSet particles = particles_at({{0.2, 5, 5}, {9, 5, 5}, {5, 5, 5}});
  particles.cell =
      Cell{{}, {Vector3d{10, 0, 0}, Vector3d{4, 10, 0}, Vector3d{0, 0, 10}}, {true, true, true}};
  const Kernels kernels(particles, {field_of_all(particles, 1, 1, {})});
  const std::vector<Bond> bonds{{0, 1}, {1, 2}};
  const Sticks sticks = make_sticks(particles, bonds, kernels.particle_of, kernels.set, 1);
  expect_halves(halves_of(sticks, kernels, 0), {{-0.6, 0, 0}});
  expect_halves(halves_of(sticks, kernels, 1), {{0.6, 0, 0}, {-2, 0, 0}});
}

TEST(Sticks, GoTowardsTheImageThatABondIsTo) {
  ParticleSet particles = particles_at({{0.2, 5, 5}, {1.6, 5, 5}});
  particles.cell = Cell{{}, {Vector3d{3, 0, 0}, {}, {}}, {true, false, false}};
  const Kernels kernels(particles, {field_of_all(particles, 1, 1, {})});
  const bool forwards = MinimumImage(particles.cell).edges().at(0).x > 0;
  const std::int8_t on = forwards ? 1 : -1, back = forwards ? -1 : 1;
  const std::vector<Bond> bonds{{0, 1}, {0, 1, {back, 0, 0}}, {1, 1, {on, 0, 0}}};
  const Sticks sticks = make_sticks(particles, bonds, kernels.particle_of, kernels.set, 1);
  expect_halves(halves_of(sticks, kernels, 0), {{0.7, 0, 0}, {-0.8, 0, 0}});
  expect_halves(halves_of(sticks, kernels, 1),
                {{-0.7, 0, 0}, {0.8, 0, 0}, {1.5, 0, 0}, {-1.5, 0, 0}});
}

TEST(Sticks, BelongToEachKernelOfAParticleAndToNoneThatIsNotThere) {
  const ParticleSet particles = particles_at({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  FieldSource all = field_of_all(particles, 1, 1, {}), first = all;
  first.index = {0};
  const Kernels kernels(particles, {first, first});
  const std::vector<Bond> bonds{{0, 1}, {1, 2}};
  const Sticks sticks = make_sticks(particles, bonds, kernels.particle_of, kernels.set, 1);
  expect_halves(halves_of(sticks, kernels, 0), {{0.5, 0, 0}, {0.5, 0, 0}});
}

TEST(Sticks, HaveADirection) {
  ParticleSet particles = particles_at({{1, 1, 1}, {1, 1, 1}, {5, 1, 1}});
  particles.cell = Cell{{}, {Vector3d{4, 0, 0}, {}, {}}, {true, false, false}};
  const Kernels kernels(particles, {field_of_all(particles, 1, 1, {})});
  const std::vector<Bond> bonds{{0, 1}, {1, 2}};  // in one place, and an image in the same place
  const Sticks sticks = make_sticks(particles, bonds, kernels.particle_of, kernels.set, 1);
  EXPECT_EQ(sticks.size(), 0U);
  EXPECT_TRUE(sticks.begin.empty());
}

/// Farthest point of a solid from its particle's centre.
double reach_of(const Solid& solid) {
  return solid.is_ball() ? solid.radius : std::hypot(length(solid.half), solid.radius);
}

TEST(NodeReach, IsWhatTheParticlesOfEachNodeReachAndNotMuchMore) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const RandomSurface scene = random_surface(seed);
    const Bvh& bvh = scene.kernels->bvh;
    const std::vector<Solid> solids = solids_of(scene.surface);
    for (std::size_t level = 0; level < bvh.level_begin.size(); ++level) {
      const std::size_t levels_below = bvh.level_begin.size() - 1 - level;
      const std::size_t per_child = Bvh::leaf_size << 3 * levels_below;
      for (std::size_t node = bvh.level_begin[level]; node < bvh.level_end(level); ++node) {
        for (std::size_t c = 0; c < Bvh::width; ++c) {
          const std::size_t first = ((node - bvh.level_begin[level]) * Bvh::width + c) * per_child;
          double expected = -1;
          for (const Solid& solid : solids) {
            if (solid.particle / per_child != first / per_child) continue;
            expected = std::max(expected, reach_of(solid));
          }
          const double reach = scene.surface.reach.of(node)[c];
          const bool shared =
              scene.surface.radius.is_shared() && scene.surface.sticks.begin.empty();
          if (shared && first >= scene.kernels->size()) continue;
          EXPECT_GE(reach, expected) << scene.description;
          EXPECT_LE(reach, expected < 0 ? expected : 1.00001 * expected) << scene.description;
        }
      }
    }
  }
}

TEST(SurfaceMemory, IsNothingAParticleForOneRadiusAndOneColour) {
  std::vector<Point3d> points;
  points.reserve(20000);
  for (int i = 0; i < 20000; ++i) points.emplace_back(i % 100, 0.01 * i, i % 7);
  const ParticleSet particles = particles_at(points);
  const Kernels kernels(particles, {field_of_all(particles, 1, 1, {})});
  Surface surface;
  surface.kernels = &kernels.set;
  surface.radius.share(0.1f);
  fit_reach(surface);
  EXPECT_LT(surface.bytes(), 200U);
}

}  // namespace
}  // namespace motes
