// Hits of camera rays and of single rays against brute force, on every instruction set.
#include "surface/trace.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "render/render_tile.h"
#include "support/particles_at.h"
#include "surface/brute_force.h"
#include "surface/random_surface.h"

namespace motes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The first hit of a line among solids, all `more` larger.
struct First {
  double depth = infinity;
  const Solid* solid = nullptr;
};
First first_hit(const Line& line, const std::vector<Solid>& solids, double more, double tile) {
  First first;
  for (const Solid& solid : solids) {
    const double at = std::max(
        dot(solid.center - line.origin, line.direction) / dot(line.direction, line.direction), 0.0);
    const double depth =
        cross(line, solid, more * (5 * (solid.radius + length(solid.half)) + tile * at))
            .first_after(0);
    if (depth < first.depth) first = {depth, &solid};
  }
  return first;
}

const Solid* find(const std::vector<Solid>& solids, const SurfaceHit& hit) {
  const auto it = std::find_if(solids.begin(), solids.end(), [&](const Solid& solid) {
    return solid.particle == hit.particle && solid.stick == hit.stick;
  });
  return it == solids.end() ? nullptr : &*it;
}

/// Holds hits against brute force, and counts.
class Judge {
 public:
  explicit Judge(const Surface& surface) : solids_(solids_of(surface)) {}

  /// `tile`: what is decided to 1e-6 of it, for each unit of depth.
  void check(const Line& line, double tile, const SurfaceHit& hit, const std::string& what) {
    constexpr double doubt = 2e-6;
    ++rays;
    const First expected = first_hit(line, solids_, 0, tile);
    const First larger = first_hit(line, solids_, doubt, tile);
    const First smaller = first_hit(line, solids_, -doubt, tile);
    // Grazed: a little decides what is hit.
    const double scale = length(line.direction);
    const double between = scale * std::abs(larger.depth - smaller.depth);
    const bool clear = (std::isinf(larger.depth) && std::isinf(smaller.depth)) ||
                       between < 1e-3 * (expected.solid == nullptr ? 0 : expected.solid->radius);
    if (!clear) {
      ++doubtful;
    } else if (expected.solid == nullptr) {
      EXPECT_FALSE(hit.any()) << what;
    } else {
      hits += 1;
      ASSERT_TRUE(hit.any()) << what;
      // Among solids that are hit at nearly the same depth the choice is free.
      const double tolerance =
          between + 1e-6 * expected.solid->radius + 3e-7 * scale * expected.depth;
      EXPECT_NEAR(scale * hit.depth, scale * expected.depth, tolerance) << what;
    }
    if (hit.any()) check_exactness(line, hit, what);
  }

  int rays = 0, hits = 0, doubtful = 0;

 private:
  /// Depth and normal of what was hit, whether it was the first or not.
  void check_exactness(const Line& line, const SurfaceHit& hit, const std::string& what) const {
    const Solid* solid = find(solids_, hit);
    ASSERT_NE(solid, nullptr) << what;
    EXPECT_GT(hit.depth, 0) << what;
    const Crossing crossing = cross(line, *solid, 0);
    if (!crossing.any()) return;  // grazed
    const double depth = crossing.first_after(0);
    const double chord = crossing.leaves - crossing.enters;
    // Near the rim the depth is the root of a small difference.
    const double scale = length(line.direction);
    const double sharpness = std::max(chord * scale / solid->radius, 1e-6);
    const double error = (1e-9 * solid->radius + 1e-12 * hit.depth * scale) / sharpness;
    if (chord * scale < 1e-5 * solid->radius) return;
    EXPECT_NEAR(hit.depth * scale, depth * scale, error) << what;
    const Vector3d normal(hit.normal);
    EXPECT_NEAR(length(normal), 1, 1e-6) << what;
    EXPECT_LE(dot(normal, line.direction), 1e-6 * scale) << what;
    Vector3d expected = normal_at(*solid, line.at(depth));
    if (dot(expected, line.direction) > 0) expected = -expected;
    EXPECT_LT(length(normal - expected), 2e-6 + error / solid->radius) << what;
  }

  std::vector<Solid> solids_;
};

class OnEveryInstructionSet : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { force_instruction_set(GetParam()); }
  void TearDown() override { force_instruction_set(""); }
};
using SurfaceTrace = OnEveryInstructionSet;

INSTANTIATE_TEST_SUITE_P(All, SurfaceTrace, testing::ValuesIn(instruction_sets()),
                         [](const auto& set) {
                           std::string name = set.param;
                           std::erase_if(name, [](char c) { return std::isalnum(c) == 0; });
                           return name;
                         });

TEST_P(SurfaceTrace, FindsTheFirstHitsOfCameraRays) {
  int rays = 0, hits = 0, doubtful = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const RandomSurface scene = random_surface(seed);
    Judge judge(scene.surface);
    for (unsigned v = 0; v < 3; ++v) {
      const RandomView random = random_view(scene, 3 * seed + v);
      const RayGrid& grid = random.grid;
      SurfaceHits found;
      trace(scene.surface, random.view, grid, found);
      double tile = 16 * std::max(std::abs(grid.du), std::abs(grid.dv));
      if (random.view.orthographic) tile = 0;  // its width is that of solids or less
      for (int i = 0; i < static_cast<int>(grid.size()); ++i) {
        const int column = grid.column + i % grid.width, row = grid.row + i / grid.width;
        const Line line =
            camera_line(random.view, grid.u + column * grid.du, grid.v + row * grid.dv);
        judge.check(line, tile, found[static_cast<std::size_t>(i)],
                    fmt::format("{}\n{}\nray {}, {}", scene.description, random.description,
                                i % grid.width, i / grid.width));
        if (HasFailure()) return;
      }
    }
    rays += judge.rays;
    hits += judge.hits;
    doubtful += judge.doubtful;
  }
  EXPECT_GT(hits, rays / 5);
  EXPECT_LT(doubtful, rays / 50) << "of " << rays;
}

TEST_P(SurfaceTrace, FindsTheFirstHitsOfSingleRays) {
  int rays = 0, hits = 0, doubtful = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const RandomSurface scene = random_surface(seed);
    Judge judge(scene.surface);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto draw = [&] { return Vector3d{uniform(random), uniform(random), uniform(random)}; };
    const Bounds3f box = bounds_of(scene.kernels->bvh);
    const double size = length(Vector3d(box.diagonal())) + scene.spacing;
    for (int i = 0; i < 150; ++i) {
      Line line{Point3d(box.center()) + size * draw(), draw()};
      // Towards something, mostly, and along an axis now and then.
      if (i % 3 != 0) {
        const Point3d target = Point3d(box.center()) + 0.3 * size * draw();
        line.direction = std::exp(10 * uniform(random)) * (target - line.origin);
      }
      if (i % 10 == 0) line.direction[i / 10 % 3] = line.direction[(i / 10 + 1) % 3] = 0;
      if (length(line.direction) == 0) continue;
      // Decided to 2e-7 of the distance.
      judge.check(line, 0.1 * length(line.direction),
                  trace(scene.surface, line.origin, line.direction),
                  fmt::format("{}\nray {}", scene.description, i));
      if (HasFailure()) return;
    }
    rays += judge.rays;
    hits += judge.hits;
    doubtful += judge.doubtful;
  }
  EXPECT_GT(hits, rays / 10);
  EXPECT_LT(doubtful, rays / 50) << "of " << rays;
}

/// Whether a line from a point meets anything before `length`, what it starts on left out: the
/// first of a solid's two crossings that lies beyond a thousandth of its radius counts.
bool meets_any(const Line& line, const std::vector<Solid>& solids, const SurfacePoint& from,
               double length, double more) {
  return std::any_of(solids.begin(), solids.end(), [&](const Solid& solid) {
    if (solid.particle == from.particle && solid.stick == from.stick) return false;
    const double larger = more * (solid.radius + motes::length(solid.half) +
                                  0.3 * motes::length(solid.center - line.origin));
    return cross(line, solid, larger).first_after((1e-3 - 100 * more) * solid.radius) <
           length * (1 + more);
  });
}

TEST_P(SurfaceTrace, CountsUnoccludedRays) {
  int rays = 0, free_rays = 0, doubtful = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const RandomSurface scene = random_surface(seed);
    const std::vector<Solid> solids = solids_of(scene.surface);
    const RandomView view = random_view(scene, seed);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 200; ++i) {
      const int column = view.grid.column + i % view.grid.width;
      const int row = view.grid.row + i * 7 % view.grid.height;
      const Line camera = camera_line(view.view, view.grid.u + column * view.grid.du,
                                      view.grid.v + row * view.grid.dv);
      const SurfaceHit hit = trace(scene.surface, camera.origin, camera.direction);
      if (!hit.any()) continue;
      SurfacePoint from{camera.at(hit.depth), hit.particle, hit.stick};
      Vector3d direction = normalize(Vector3d{normal(random), normal(random), normal(random)});
      if (dot(direction, Vector3d(hit.normal)) < 0) direction = -direction;
      if (i % 20 == 0) from = {camera.origin, no_particle, no_stick};  // from anywhere
      const double length = i % 2 == 0 ? infinity : (1 + i % 7) * scene.spacing;
      const Vector3f single(direction);
      const int found = num_unoccluded(scene.surface, from, {&single, 1}, length);
      ++rays;
      const Line line{from.place, direction};
      constexpr double doubt = 2e-6;
      const bool larger = meets_any(line, solids, from, length, doubt);
      if (larger != meets_any(line, solids, from, length, -doubt)) {
        ++doubtful;
        continue;
      }
      ASSERT_EQ(found, larger ? 0 : 1) << scene.description << "\n"
                                       << view.description << "\nray " << i;
      free_rays += found;
    }
  }
  EXPECT_GT(rays, 4000);
  EXPECT_GT(free_rays, rays / 10);
  EXPECT_LT(free_rays, rays * 9 / 10);
  EXPECT_LT(doubtful, rays / 50) << "of " << rays;
}

/// A surface of balls at points, one radius for all.
struct Balls {
  KernelSet kernels;
  Surface surface;

  Balls(const std::vector<Point3d>& points, float radius) {
    const ParticleSet particles = particles_at(points);
    kernels = build_kernel_set(particles, {field_of_all(particles, 1, 1, {})});
    surface.kernels = &kernels;
    surface.radius.share(radius * static_cast<float>(kernels.length_scale));
    fit_reach(surface);
  }
  Point3d internal(const Point3d& p) const {
    const Vector3d v = kernels.length_scale * (p - kernels.origin);
    return {v.x, v.y, v.z};
  }
  SurfaceView view(const Point3d& eye, const Point3d& target) const {
    Camera camera;
    camera.eye = eye;
    camera.target = target;
    camera.up = {0.1, 1, 0};
    return {camera_axes(camera), internal(eye), false};
  }
};

TEST_P(SurfaceTrace, ShowsTheInsideOfABallToAnEyeWithinIt) {
  const Balls balls({{0, 0, 0}, {0, 0, 10}}, 2);
  const double unit = balls.kernels.length_scale;
  SurfaceHits hits;
  trace(balls.surface, balls.view({0, 0, 0.5}, {0, 0, 5}), {0, 0, 1, 1, 0, 0, 1, 1}, hits);
  ASSERT_TRUE(hits[0].any());
  EXPECT_NEAR(hits.depth[0], 1.5 * unit, 1e-12);
  EXPECT_EQ(hits[0].normal, Normal3f(0, 0, -1));
  // From the outside towards the other one.
  trace(balls.surface, balls.view({0, 0, 2.5}, {0, 0, 5}), {0, 0, 1, 1, 0, 0, 1, 1}, hits);
  EXPECT_NEAR(hits.depth[0], 5.5 * unit, 1e-12);
  // What lies behind the eye is not there.
  trace(balls.surface, balls.view({0, 0, 13}, {0, 0, 20}), {0, 0, 1, 1, 0, 0, 1, 1}, hits);
  EXPECT_FALSE(hits[0].any());
}

TEST_P(SurfaceTrace, FindsNothingWhereThereIsNothing) {
  const Balls none({}, 1);
  SurfaceHits hits;
  trace(none.surface, none.view({0, 0, 5}, {0, 0, 0}), {-1, -1, 0.1, 0.1, 0, 0, 20, 20}, hits);
  for (std::size_t i = 0; i < 400; ++i) {
    ASSERT_FALSE(hits[i].any());
    ASSERT_EQ(hits.depth[i], infinity);
  }
  EXPECT_FALSE(trace(none.surface, {0, 0, 0}, {1, 0, 0}).any());
  const Vector3f direction{1, 0, 0};
  EXPECT_EQ(num_unoccluded(none.surface, {{0, 0, 0}}, {&direction, 1}, infinity), 1);
  const Balls bare({{0, 0, 0}, {1, 1, 1}}, 0);
  EXPECT_FALSE(trace(bare.surface, {-1, -1, -1}, {1, 1, 1}).any());
}

TEST_P(SurfaceTrace, DoesNotSeeWhatPadsTheLastLeaf) {
  // Padding lies far out in the direction of (1, 1, 1): seen between these two, were it there.
  const Balls balls({{2, -2, 0}, {-2, 2, 0}}, 1);
  ASSERT_EQ(balls.kernels.x.size(), Bvh::leaf_size);
  EXPECT_FALSE(trace(balls.surface, {-1, -1, -1}, {1, 1, 1}).any());
  const Vector3f direction(normalize(Vector3d{1, 1, 1}));
  EXPECT_EQ(num_unoccluded(balls.surface, {{-1, -1, -1}}, {&direction, 1}, infinity), 1);
  const Camera camera{{-1, -1, -1}, {0, 0, 0}, {0, 1, 0}, 45, {}};
  // Sixteen digits leave it where it is to about a radius: one of some rays would meet it.
  for (const double step : {0.02, 0.25}) {
    SurfaceHits hits;
    trace(balls.surface, {camera_axes(camera), camera.eye, true},
          {0, 0, step, step, -40, -40, 81, 81}, hits);
    for (std::size_t i = 0; i < hits.depth.size(); ++i) {
      ASSERT_TRUE(!hits[i].any() || hits.depth[i] < 10) << i;
    }
  }
}

TEST_P(SurfaceTrace, TellsTheSameOfARayWhateverTheOthersAre) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RandomSurface scene = random_surface(seed);
    const RandomView random = random_view(scene, seed);
    RayGrid grid = random.grid;
    grid.column = -21;
    grid.row = 5;
    grid.width = 50;
    grid.height = 37;
    SurfaceHits all, part;
    trace(scene.surface, random.view, grid, all);
    RayGrid piece = grid;
    piece.column += 9;
    piece.row += 14;
    piece.width = 23;
    piece.height = 11;
    trace(scene.surface, random.view, piece, part);
    for (int i = 0; i < static_cast<int>(piece.size()); ++i) {
      const SurfaceHit one = part[static_cast<std::size_t>(i)];
      const int in_all = (i / piece.width + 14) * grid.width + i % piece.width + 9;
      const SurfaceHit same = all[static_cast<std::size_t>(in_all)];
      ASSERT_EQ(one.depth, same.depth) << scene.description;
      ASSERT_EQ(one.particle, same.particle) << scene.description;
      ASSERT_EQ(one.stick, same.stick) << scene.description;
      ASSERT_EQ(one.normal, same.normal) << scene.description;
    }
  }
}

// Balls at few places, and rays through lattice points: coincidences, tangents, equal depths.
RC_GTEST_PROP(SurfaceTraceOfALattice, AgreesWithBruteForce, ()) {
  const auto places = *rc::gen::nonEmpty<std::vector<std::array<int, 3>>>(
      rc::gen::container<std::vector<std::array<int, 3>>>(
          rc::gen::container<std::array<int, 3>>(rc::gen::inRange(-2, 3))));
  std::vector<Point3d> points;
  points.reserve(places.size());
  for (const auto& [x, y, z] : places) points.emplace_back(0.5 * x, 0.5 * y, 0.5 * z);
  const Balls balls(points, 0.125f * static_cast<float>(*rc::gen::inRange(1, 9)));
  SurfaceView view = balls.view({0, 0, 8}, {0, 0, 0});
  view.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  view.orthographic = *rc::gen::arbitrary<bool>();
  const double step = view.orthographic ? balls.kernels.length_scale / 4 : 1. / 32;
  const RayGrid grid{0, 0, step, -step, -9, -9, 19, 19};
  SurfaceHits hits;
  trace(balls.surface, view, grid, hits);
  Judge judge(balls.surface);
  for (int i = 0; i < static_cast<int>(grid.size()); ++i) {
    const int column = grid.column + i % grid.width, row = grid.row + i / grid.width;
    judge.check(camera_line(view, column * grid.du, row * grid.dv), 16 * step,
                hits[static_cast<std::size_t>(i)], fmt::format("ray {}, {}", column, row));
  }
  RC_ASSERT(!testing::Test::HasFailure());
}

}  // namespace
}  // namespace motes
