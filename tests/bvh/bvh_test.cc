#include "bvh/bvh.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace motes {
namespace {

struct Cloud {
  std::vector<float> x, y, z, radius;
  void add(float px, float py, float pz, float r) {
    x.push_back(px);
    y.push_back(py);
    z.push_back(pz);
    radius.push_back(r);
  }
  std::vector<Sphere> spheres() const {
    std::vector<Sphere> out;
    for (std::size_t i = 0; i < x.size(); ++i) out.push_back({x[i], y[i], z[i], radius[i]});
    return out;
  }
  Cloud in_spatial_order() const { return reordered(spatial_order(spheres())); }
  Cloud reordered(std::span<const std::uint32_t> order) const {
    Cloud out;
    for (const std::uint32_t i : order) out.add(x[i], y[i], z[i], radius[i]);
    return out;
  }
};

Cloud random_cloud(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  Cloud cloud;
  for (std::size_t i = 0; i < n; ++i) {
    cloud.add(coordinate(random), coordinate(random), coordinate(random),
              std::abs(coordinate(random)));
  }
  return cloud;
}

Bounds3f child_box(const Bvh::Node& node, std::size_t c) {
  return {{node.min_x[c], node.min_y[c], node.min_z[c]},
          {node.max_x[c], node.max_y[c], node.max_z[c]}};
}

/// Every particle lies in its leaf's box and in those of all nodes above, and its radius is at most
/// theirs; boxes are tight; children that are not there have no box.
void expect_invariants(const Bvh& bvh, const Cloud& cloud) {
  ASSERT_EQ(bvh.num_particles, cloud.x.size());
  ASSERT_LE(bvh.level_begin.size(), static_cast<std::size_t>(Bvh::max_levels));
  std::size_t particles_of_child = Bvh::leaf_size;
  for (std::size_t level = bvh.level_begin.size(); level-- > 0; particles_of_child *= Bvh::width) {
    const std::size_t begin = bvh.level_begin[level];
    const std::size_t end =
        level + 1 < bvh.level_begin.size() ? bvh.level_begin[level + 1] : bvh.nodes.size();
    for (std::size_t node = begin; node < end; ++node) {
      for (std::size_t c = 0; c < Bvh::width; ++c) {
        const std::size_t first = ((node - begin) * Bvh::width + c) * particles_of_child;
        const std::size_t last = std::min(first + particles_of_child, cloud.x.size());
        Bounds3f tight;
        float max_radius = 0;
        for (std::size_t p = first; p < last; ++p) {
          tight.add(Point3f{cloud.x[p], cloud.y[p], cloud.z[p]});
          max_radius = std::max(max_radius, cloud.radius[p]);
        }
        const Bounds3f box = child_box(bvh.nodes[node], c);
        if (first >= last) {
          EXPECT_TRUE(box.empty());
        } else {
          EXPECT_EQ(box, tight) << "level " << level << " node " << node << " child " << c;
          EXPECT_EQ(bvh.nodes[node].max_radius[c], max_radius);
        }
      }
    }
  }
  if (!cloud.x.empty()) {
    EXPECT_EQ(bvh.level_begin.front(), 0u);
    EXPECT_EQ(bvh.level_begin.size() == 1 ? bvh.nodes.size() : bvh.level_begin[1], 1u);
  }
}

void expect_permutation(std::span<const std::uint32_t> order, std::size_t n) {
  ASSERT_EQ(order.size(), n);
  std::vector<std::uint32_t> sorted(order.begin(), order.end());
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(sorted[i], i);
}

Bvh build_and_check(const Cloud& cloud) {
  const auto order = spatial_order(cloud.spheres());
  expect_permutation(order, cloud.x.size());
  const Cloud sorted = cloud.reordered(order);
  Bvh bvh = build_bvh(sorted.x, sorted.y, sorted.z, sorted.radius);
  expect_invariants(bvh, sorted);
  return bvh;
}

TEST(Bvh, HoldsInvariantsForAllSizesAroundItsWidths) {
  for (const std::size_t n : {0, 1, 2, 15, 16, 17, 127, 128, 129, 1023, 1024, 1025, 20000}) {
    SCOPED_TRACE(n);
    build_and_check(random_cloud(n, static_cast<unsigned>(n)));
  }
}

TEST(Bvh, TakesCoincidentParticles) {
  Cloud cloud;
  for (int i = 0; i < 5000; ++i) cloud.add(1, 2, 3, 0.5f);
  build_and_check(cloud);
}

TEST(Bvh, TakesPositionsInAPlaneAndOnALine) {
  Cloud plane, line;
  for (int i = 0; i < 3000; ++i) {
    plane.add(static_cast<float>(i % 50), static_cast<float>(i) / 50, 7, 1);
    line.add(static_cast<float>(i), 0, 0, 1);
  }
  build_and_check(plane);
  build_and_check(line);
}

/// A leaf's mean extent tells whether neighbours in the order are neighbours in space.
double mean_leaf_extent(const Cloud& sorted, std::size_t skip) {
  double sum = 0;
  std::size_t leaves = 0;
  for (std::size_t first = 0; first + Bvh::leaf_size <= sorted.x.size() - skip;
       first += Bvh::leaf_size) {
    Bounds3f box;
    for (std::size_t p = first; p < first + Bvh::leaf_size; ++p) {
      box.add(Point3f{sorted.x[p], sorted.y[p], sorted.z[p]});
    }
    const Vector3f d = box.diagonal();
    sum += std::max({d.x, d.y, d.z});
    ++leaves;
  }
  return sum / static_cast<double>(leaves);
}

TEST(SpatialOrder, KeepsNeighboursTogetherInSpiteOfAFarOutlier) {
  const Cloud cloud = random_cloud(20000, 5);
  const double usual = mean_leaf_extent(cloud.in_spatial_order(), 0);
  EXPECT_LT(usual, 0.4);  // 16 of 20000 in a box of 2: a cube of 0.19
  Cloud with_outlier = cloud;
  with_outlier.add(1e8f, 1e8f, 1e8f, 1);
  EXPECT_LT(mean_leaf_extent(with_outlier.in_spatial_order(), Bvh::leaf_size), 1.3 * usual);
}

// On a full grid of 2^k cells a side, the curve goes from neighbour to neighbour: once through all.
TEST(SpatialOrder, IsAHilbertCurve) {
  for (const int side : {2, 4, 16, 64}) {  // the last is sorted by several threads
    Cloud cloud;
    for (int i = 0; i < side * side * side; ++i) {
      const int row = i / side % side, layer = i / side / side;
      cloud.add(static_cast<float>(i % side), static_cast<float>(row), static_cast<float>(layer),
                1);
    }
    const Cloud sorted = cloud.in_spatial_order();
    for (std::size_t i = 1; i < sorted.x.size(); ++i) {
      const float steps = std::abs(sorted.x[i] - sorted.x[i - 1]) +
                          std::abs(sorted.y[i] - sorted.y[i - 1]) +
                          std::abs(sorted.z[i] - sorted.z[i - 1]);
      ASSERT_EQ(steps, 1) << side << ", particle " << i;
    }
  }
}

/// Many particles in few places, unevenly: one of them holds half.
Cloud crowded_cloud(std::size_t n) {
  const Cloud places = random_cloud(1000, 3);
  std::mt19937 random(4);
  Cloud cloud;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t p = i % 2 == 0 ? 0 : random() % places.x.size();
    cloud.add(places.x[p], places.y[p], places.z[p], places.radius[p]);
  }
  return cloud;
}

TEST(SpatialOrder, KeepsTheInputsOrderOfCoincidentParticles) {
  for (const std::size_t n : {3000, 400000}) {
    const Cloud cloud = crowded_cloud(n);
    const auto order = spatial_order(cloud.spheres());
    expect_permutation(order, n);
    const auto place = [&](std::uint32_t i) {
      return std::array{cloud.x[i], cloud.y[i], cloud.z[i]};
    };
    std::size_t distinct = 1;
    for (std::size_t i = 1; i < n; ++i) {
      if (place(order[i]) == place(order[i - 1])) {
        ASSERT_LT(order[i - 1], order[i]);
      } else {
        ++distinct;
      }
    }
    EXPECT_LE(distinct, 1000u);  // coincident ones are all together
  }
}

TEST(SpatialOrder, KeepsAFewHugeKernelsOutOfTheLeavesOfTheOthers) {
  Cloud cloud = random_cloud(20000, 8);
  for (float& r : cloud.radius) r *= 1e-3f;
  for (std::size_t i = 0; i < cloud.radius.size(); i += 1000) cloud.radius[i] = 0.5f;
  for (std::size_t i = 500; i < cloud.radius.size(); i += 1000) cloud.radius[i] = 1e8f;
  const Bvh bvh = build_and_check(cloud);
  // Twenty of each kind: two leaves, the second of which is shared with the next kind.
  std::size_t huge = 0, large = 0;
  traverse(
      bvh,
      [&](const Bvh::Node& node) {
        unsigned mask = 0;
        for (std::size_t c = 0; c < Bvh::width; ++c)
          mask |= (node.max_radius[c] > 0 ? 1u : 0u) << c;
        return mask;
      },
      [&](std::size_t leaf) {
        const Bvh::Node& node = bvh.nodes[bvh.level_begin.back() + leaf / Bvh::width];
        const float radius = node.max_radius[leaf % Bvh::width];
        huge += radius > 1 ? 1 : 0;
        large += radius > 0.1f && radius < 1 ? 1 : 0;
      });
  EXPECT_EQ(huge, 2u);
  EXPECT_LE(large, 2u);
}

TEST(SpatialOrder, IsOneCurveWhereAllKernelsAreSmallerThanTheirSpacing) {
  const Cloud tiny = [] {
    Cloud cloud = random_cloud(20000, 9);
    for (float& r : cloud.radius) r *= 1e-3f;
    return cloud;
  }();
  Cloud equal = tiny;
  equal.radius.assign(equal.radius.size(), 1e-3f);
  EXPECT_EQ(spatial_order(tiny.spheres()), spatial_order(equal.spheres()));
}

TEST(SpatialOrder, IsTheSameForAnyNumberOfThreads) {
  const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism, 5);
  Cloud cloud = random_cloud(300000, 6);
  for (std::size_t i = 0; i < cloud.x.size(); i += 2) cloud.x[i] *= 1e-5f;  // crowded cells too
  const std::vector<Sphere> spheres = cloud.spheres();
  const auto order_with = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return spatial_order(spheres); });
  };
  const auto alone = order_with(1);
  expect_permutation(alone, spheres.size());
  EXPECT_EQ(order_with(5), alone);
}

RC_GTEST_PROP(Bvh, InvariantsHoldWhateverThePositions, ()) {
  // Few distinct values of very different size: many coincidences and degenerate boxes.
  const auto coordinates = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-4, 5));
  Cloud cloud;
  for (std::size_t i = 0; i + 2 < coordinates.size(); ++i) {
    const auto value = [&](std::size_t j) {
      return std::ldexp(static_cast<float>(coordinates[j]),
                        10 * coordinates[(j + 1) % coordinates.size()]);
    };
    cloud.add(value(i), value(i + 1), value(i + 2), std::abs(value(i)));
  }
  build_and_check(cloud);
}

TEST(Refit, FitsTheBoundsToWhereTheParticlesAre) {
  for (const std::size_t n : {1, 17, 5000}) {
    Cloud cloud = random_cloud(n, 11).in_spatial_order();
    Bvh bvh = build_bvh(cloud.x, cloud.y, cloud.z, cloud.radius);
    const Cloud elsewhere = random_cloud(n, 12);
    cloud.x = elsewhere.x;
    cloud.radius = elsewhere.radius;
    refit_bvh(bvh, cloud.x, cloud.y, cloud.z, cloud.radius);
    expect_invariants(bvh, cloud);
  }
}

TEST(LeafArea, IsThatOfTheLeavesBoxesExtendedByTheirRadii) {
  Cloud cloud;
  EXPECT_EQ(leaf_area(build_bvh(cloud.x, cloud.y, cloud.z, cloud.radius)), 0);
  for (int i = 0; i < 16; ++i) cloud.add(5, 6, 7, 0.5f);
  cloud.add(1, 2, 3, 1);
  cloud.add(2, 4, 3, 0.5f);
  // A cube of 1, and a box of 1 x 2 x 0, which a radius of 1 makes 3 x 4 x 2.
  EXPECT_DOUBLE_EQ(leaf_area(build_bvh(cloud.x, cloud.y, cloud.z, cloud.radius)),
                   6 + 2 * (12 + 8 + 6));
}

TEST(Traverse, VisitsEveryLeafOnceAndOnlyThoseThatAreHit) {
  const Cloud cloud = random_cloud(5000, 2);
  const Bvh bvh = build_and_check(cloud);
  std::vector<int> visits(bvh.num_leaves(), 0);
  const auto present = [](const Bvh::Node& node) {
    unsigned mask = 0;
    for (std::size_t c = 0; c < Bvh::width; ++c) {
      if (!child_box(node, c).empty()) mask |= 1u << c;
    }
    return mask;
  };
  traverse(bvh, present, [&](std::size_t leaf) { ++visits.at(leaf); });
  EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), [](int v) { return v == 1; }));
  int none = 0;
  traverse(
      bvh, [](const Bvh::Node&) { return 0u; }, [&](std::size_t) { ++none; });
  EXPECT_EQ(none, 0);
}

}  // namespace
}  // namespace motes
