// What clip planes leave of balls and sticks.
#include "surface/cut.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>

#include "surface/random_surface.h"

namespace motes {
namespace {

TEST(Cut, LeavesTheBallsAndSticksOfParticlesOnTheKeptSide) {
  std::size_t num_kept = 0, num_cut = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const RandomSurface scene = random_surface(seed);
    const KernelSet& kernels = *scene.kernels;
    const std::size_t middle = kernels.size() / 2;
    const Vector3d normal = normalize(Vector3d{0.3, -1, 0.5 + seed});
    const Vector3d through{kernels.x[middle], kernels.y[middle], kernels.z[middle]};
    const ClipPlane plane{normal, dot(normal, through) + 1e-6};
    const Surface left = cut(scene.surface, {&plane, 1});
    std::size_t stick = 0;
    for (std::size_t p = 0; p < kernels.size(); ++p) {
      SCOPED_TRACE(fmt::format("{}, particle {}", scene.description, p));
      const Vector3d x{kernels.x[p], kernels.y[p], kernels.z[p]};
      const bool kept = dot(normal, x) <= plane.distance;
      ++(kept ? num_kept : num_cut);
      EXPECT_EQ(left.radius[p] > 0, kept && scene.surface.radius[p] > 0);
      if (left.radius[p] > 0) {
        EXPECT_EQ(left.radius[p], scene.surface.radius[p]);
      }
      const Sticks& all = scene.surface.sticks;
      for (std::size_t s = all.begin.empty() ? 0 : all.begin[p];
           kept && !all.begin.empty() && s < all.begin[p + 1]; ++s, ++stick) {
        ASSERT_LT(stick, left.sticks.size());
        EXPECT_EQ(left.sticks.x[stick], all.x[s]);
        EXPECT_EQ(left.sticks.y[stick], all.y[s]);
        EXPECT_EQ(left.sticks.z[stick], all.z[s]);
        EXPECT_EQ(left.sticks.owner[stick], p % Bvh::leaf_size);
        EXPECT_EQ(left.sticks.radius_of(stick), all.radius_of(s));
      }
    }
    EXPECT_EQ(stick, left.sticks.size()) << scene.description;
  }
  EXPECT_GT(num_kept, 500u);
  EXPECT_GT(num_cut, 500u);
}

// Planes cut away what is beyond any of them.
TEST(Cut, LeavesWhatNoPlaneCutsAway) {
  const RandomSurface scene = random_surface(1);
  const KernelSet& kernels = *scene.kernels;
  const std::size_t middle = kernels.size() / 2;
  const ClipPlane planes[] = {{{1, 0, 0}, kernels.x[middle]}, {{0, -1, 0}, -kernels.y[middle]}};
  const Surface left = cut(scene.surface, planes);
  std::size_t by_one = 0;
  for (std::size_t p = 0; p < kernels.size(); ++p) {
    const bool first = kernels.x[p] > kernels.x[middle], second = kernels.y[p] < kernels.y[middle];
    if (scene.surface.radius[p] > 0) {
      EXPECT_EQ(left.radius[p] > 0, !first && !second) << p;
      by_one += first != second;
    }
  }
  EXPECT_GT(by_one, 0u);
}

}  // namespace
}  // namespace motes
