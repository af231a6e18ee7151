// Crossings of rays and isosurfaces against dense marching and bisection of the reference's field
// in double precision.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "isosurface/isosurface.h"
#include "reference/field.h"
#include "render/render_tile.h"
#include "support/particles_at.h"

namespace motes {
namespace {

/// A few particles of one field in a box of side 8, seen by an orthographic or perspective camera.
struct Case {
  ParticleSet particles;
  FieldSource field;
  std::vector<std::uint16_t> species;
  KernelSet kernels;
  IsosurfaceFrame frame;
  RayGrid grid;
  std::string description;
};

KernelShape shape_of(int number) {
  KernelShape shape;
  shape.type = static_cast<KernelType>(number);
  if (shape.type == KernelType::tabulated) {
    shape.profile.spacing = 0.5;
    shape.profile.values = {1, 0.8, 0.4, 0.1, 0};
  }
  return shape;
}

void make_case(int seed, Case& c) {
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<Point3d> points;
  points.reserve(40);
  for (int i = 0; i < 40; ++i) points.push_back({uniform(-4, 4), uniform(-4, 4), uniform(-4, 4)});
  c.particles = particles_at(points);
  Kernel kernel;
  kernel.shape = shape_of(seed % 7);
  kernel.support_factor = uniform(1.5, 4);
  c.field = field_of_all(c.particles, 1, 1, kernel);
  c.field.radius.clear();
  c.field.weight.clear();
  const bool negative = seed % 3 == 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    c.field.radius.push_back(static_cast<float>(uniform(0.4, 1)));
    c.field.weight.push_back(static_cast<float>(uniform(negative ? -1 : 0.3, 1)));
  }
  KernelOrder order;
  c.kernels = build_kernel_set(c.particles, {c.field}, &order);
  for (const std::uint32_t i : order.kernels) c.species.push_back(i % 3);
  const double scale = c.kernels.length_scale;
  Camera camera;
  camera.eye = {uniform(-3, 3), uniform(-3, 3), seed % 5 == 0 ? 1 : uniform(9, 30)};
  camera.target = {0.1, 0.2, -0.3};
  c.frame.kernels = &c.kernels;
  c.frame.species = c.species.data();
  c.frame.view = {camera_axes(camera), Point3d{} + scale * (camera.eye - c.kernels.origin),
                  seed % 2 == 1};
  const double step = uniform(0.1, 0.4) * scale;
  const double near = std::max(length(camera.eye - Point3d{}) - 16, 0.0) * scale;
  c.frame.planes = {static_cast<std::int64_t>(near / step), step};
  c.frame.last_plane = static_cast<int>(32 * scale / step);
  FieldIsosurfaces levels;
  for (int i = 0; i < 1 + seed % 3; ++i) {
    levels.levels.push_back(
        {static_cast<std::uint32_t>(i),
         static_cast<float>(uniform(negative ? -0.4 : 0.05, 0.9) * c.kernels.fields[0].value_scale),
         seed % 4 == 0 ? 1.0F : 0.4F,
         {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  }
  c.frame.fields = {levels};
  const double half = c.frame.view.orthographic ? 5 * scale : 0.4;
  c.grid = {-half, half, half / 10, -half / 9, -3, 2, 24, 17};
  c.description =
      fmt::format("seed {}, {} kernels, {} levels", seed, seed % 7, levels.levels.size());
}

/// A crossing as the reference has it.
struct Truth {
  std::uint32_t level;
  double depth;
  bool jump;  ///< a kernel ends there
};

class BruteForce {
 public:
  explicit BruteForce(const Case& c)
      : case_(c), kernels_(reference::particle_kernels(c.particles, c.field)) {}

  Point3d point(std::uint32_t ray, double depth) const {
    const RayGrid& grid = case_.grid;
    const auto width = static_cast<std::uint32_t>(grid.width);
    const double u = grid.u + (grid.column + static_cast<int>(ray % width)) * grid.du;
    const double v = grid.v + (grid.row + static_cast<int>(ray / width)) * grid.dv;
    const SurfaceView& view = case_.frame.view;
    const Vector3d across = u * view.axes.x + v * view.axes.y;
    const Point3d internal = view.orthographic ? view.eye + across + depth * view.axes.forward
                                               : view.eye + depth * (view.axes.forward + across);
    return case_.kernels.origin + (internal - Point3d{}) / case_.kernels.length_scale;
  }
  reference::FieldValue field(std::uint32_t ray, double depth) const {
    return reference::evaluate_field(kernels_, point(ray, depth));
  }

  std::vector<Truth> crossings(std::uint32_t ray) const {
    constexpr int fineness = 8;
    const SamplePlanes& planes = case_.frame.planes;
    const double step = planes.step / fineness;
    const auto value = [&](double z, double level) { return field(ray, z).value > level; };
    std::vector<Truth> found;
    for (const IsosurfaceLevel& level : case_.frame.fields[0].levels) {
      const double v = static_cast<double>(level.value) / case_.kernels.fields[0].value_scale;
      double low = planes.depth(0);
      bool in_low = value(low, v);
      for (int i = 1; i <= case_.frame.last_plane * fineness; ++i) {
        const double high = planes.depth(0) + i * step;
        const bool in_high = value(high, v);
        if (in_low != in_high) {
          double a = low, b = high;
          for (int k = 0; k < 40; ++k) {
            const double middle = 0.5 * (a + b);
            (value(middle, v) == in_low ? a : b) = middle;
          }
          const double distance = field(ray, a).boundary_distance * case_.kernels.length_scale;
          found.push_back({level.number, a, distance < 1e-3 * planes.step});
        }
        low = high;
        in_low = in_high;
      }
    }
    std::sort(found.begin(), found.end(),
              [](const Truth& a, const Truth& b) { return a.depth < b.depth; });
    return found;
  }

 private:
  const Case& case_;
  std::vector<reference::ParticleKernel> kernels_;
};

/// Crossings that may be missed: pairs of a level within a step.
bool is_near_pair(const std::vector<Truth>& truths, std::size_t i, double step) {
  for (std::size_t j = 0; j < truths.size(); ++j) {
    if (j != i && truths[j].level == truths[i].level &&
        std::abs(truths[j].depth - truths[i].depth) <= step) {
      return true;
    }
  }
  return false;
}

class Isosurfaces : public testing::TestWithParam<int> {};

TEST_P(Isosurfaces, AreCrossedWhereTheReferencesFieldCrosses) {
  std::size_t pairs = 0, missed_pairs = 0, crossings = 0;
  for (int seed = 7 * GetParam(); seed < 7 * GetParam() + 7; ++seed) {
    Case c;
    make_case(seed, c);
    const BruteForce truth(c);
    std::vector<std::vector<Truth>> expected;
    for (std::uint32_t ray = 0; ray < c.grid.size(); ++ray) {
      expected.push_back(truth.crossings(ray));
    }
    const double step = c.frame.planes.step;
    for (const std::string& target : instruction_sets()) {
      force_instruction_set(target);
      std::vector<IsosurfaceHit> hits;
      trace_isosurfaces(c.frame, c.grid, hits);
      auto hit = hits.begin();
      for (std::uint32_t ray = 0; ray < c.grid.size(); ++ray) {
        const auto& truths = expected[ray];
        const std::string where = fmt::format("{}, {}, ray {}", c.description, target, ray);
        std::vector<bool> seen(truths.size());
        const auto first = hit;
        double last = std::numeric_limits<double>::infinity();
        for (; hit != hits.end() && hit->ray == ray; ++hit) {
          if (hit != first) {
            EXPECT_GE(hit->depth, (hit - 1)->depth) << where;
          }
          if (hit->opacity >= 1) last = hit->depth;
          double nearest = std::numeric_limits<double>::infinity();
          std::size_t best = 0;
          for (std::size_t i = 0; i < truths.size(); ++i) {
            const double d = std::abs(truths[i].depth - hit->depth);
            if (truths[i].level != hit->level || d >= nearest) continue;
            nearest = d;
            best = i;
          }
          // 1e-4 of a step from bisection; rounding of the field over its slope where a ray grazes.
          const auto at = truth.field(ray, hit->depth);
          const double slope = std::abs(
              dot(at.gradient, truth.point(ray, hit->depth + step) - truth.point(ray, hit->depth)));
          const double rounding = 4e-6 * at.absolute / std::max(slope, 1e-12);
          if (rounding > 0.5) continue;  // whether it crosses at all is a matter of rounding
          const double tolerance = (1e-4 + rounding) * step;
          if (nearest > tolerance) {
            // A pair so near that it lies between the points of the march.
            const double before = truth.field(ray, hit->depth - tolerance).value;
            const double after = truth.field(ray, hit->depth + tolerance).value;
            const double level =
                c.frame.fields[0].levels[hit->level].value / c.kernels.fields[0].value_scale;
            EXPECT_NE(before > level, after > level) << where << " at " << hit->depth;
            continue;
          }
          seen[best] = true;
          ++crossings;
          if (truths[best].jump) continue;
          Vector3d normal = normalize(at.gradient);
          if (dot(normal, truth.point(ray, 2 * step) - truth.point(ray, step)) > 0) {
            normal = -normal;
          }
          const double bend = 1e-4 * at.absolute / (length(at.gradient) + 1e-12);
          EXPECT_LE(length(normal - Vector3d(hit->normal)), 2e-3 + bend) << where;
        }
        for (std::size_t i = 0; i < truths.size(); ++i) {
          if (truths[i].depth > last - 1e-3 * step) continue;
          if (is_near_pair(truths, i, step)) {
            ++pairs;
            missed_pairs += seen[i] ? 0 : 1;
            continue;
          }
          const auto at = truth.field(ray, truths[i].depth);
          EXPECT_TRUE(seen[i]) << where << " misses " << truths[i].depth << ", field " << at.value;
        }
      }
      EXPECT_EQ(hit, hits.end());
    }
    force_instruction_set("");
  }
  EXPECT_GT(crossings, 300 * instruction_sets().size());
  // Most of the pairs that a step leaves between two planes are found by the field's slopes.
  EXPECT_LE(static_cast<double>(missed_pairs), 0.2 * static_cast<double>(pairs) + 5);
}
INSTANTIATE_TEST_SUITE_P(Random, Isosurfaces, testing::Range(0, 4));

// A ray that is inside of a ball for a twentieth of a step only, wherever the planes lie.
TEST(Isosurface, IsMetByRaysThatGrazeIt) {
  Case c;
  c.particles = particles_at({{0, 0, 0}, {50, 0, 0}});
  c.field = field_of_all(c.particles, 1, 1, {.support_factor = 4});
  c.kernels = build_kernel_set(c.particles, {c.field});
  c.frame.kernels = &c.kernels;
  c.frame.fields = {
      {0, {{0, static_cast<float>(0.5 * c.kernels.fields[0].value_scale), 0.5F, {{1, 1, 1}}}}, {}}};
  const double scale = c.kernels.length_scale, step = 0.4, half_chord = 0.01;
  const double offset = std::sqrt(2 * std::log(2) - half_chord * half_chord);
  c.grid = {offset * scale, 0, scale, scale, 0, 0, 1, 1};
  for (int phase = 0; phase < 20; ++phase) {
    Camera camera;
    camera.eye = {0, 0, 10 + step * phase / 20};
    camera.target = {0, 0, 0};
    c.frame.view = {camera_axes(camera), Point3d{} + scale * (camera.eye - c.kernels.origin), true};
    c.frame.planes = {0, step * scale};
    c.frame.last_plane = 60;
    std::vector<IsosurfaceHit> hits;
    trace_isosurfaces(c.frame, c.grid, hits);
    ASSERT_EQ(hits.size(), 2u) << phase;
    EXPECT_NEAR(hits[0].depth / scale, camera.eye.z - half_chord, 2e-4);
    EXPECT_NEAR(hits[1].depth / scale, camera.eye.z + half_chord, 2e-4);
  }
}

TEST(Isosurface, DoesNotDependOnTheOtherRaysOfTheGrid) {
  Case c;
  make_case(4, c);
  std::vector<IsosurfaceHit> all, part;
  trace_isosurfaces(c.frame, c.grid, all);
  RayGrid smaller = c.grid;
  smaller.column += 5;
  smaller.row += 3;
  smaller.width -= 9;
  smaller.height -= 4;
  trace_isosurfaces(c.frame, smaller, part);
  ASSERT_FALSE(part.empty());
  std::size_t next = 0;
  for (const IsosurfaceHit& hit : all) {
    const int column = static_cast<int>(hit.ray) % c.grid.width - 5;
    const int row = static_cast<int>(hit.ray) / c.grid.width - 3;
    if (column < 0 || column >= smaller.width || row < 0 || row >= smaller.height) continue;
    ASSERT_LT(next, part.size());
    EXPECT_EQ(part[next].depth, hit.depth);
    EXPECT_EQ(part[next].color, hit.color);
    ++next;
  }
  EXPECT_EQ(next, part.size());
}

TEST(Isosurface, MixesTheColoursOfParticlesByTheirKernels) {
  Case c;
  make_case(1, c);
  std::vector<IsosurfaceHit> hits;
  trace_isosurfaces(c.frame, c.grid, hits);
  ASSERT_FALSE(hits.empty());
  const BruteForce truth(c);
  const auto kernels = reference::particle_kernels(c.particles, c.field);
  for (const IsosurfaceHit& hit : hits) {
    double weights[3] = {}, sum = 0;
    for (std::size_t i = 0; i < kernels.size(); ++i) {
      const double phi =
          std::abs(reference::evaluate_field({kernels[i]}, truth.point(hit.ray, hit.depth)).value);
      weights[i % 3] += phi;
      sum += phi;
    }
    if (truth.field(hit.ray, hit.depth).boundary_distance < 1e-4) continue;
    EXPECT_NEAR(hit.color.r, weights[0] / sum, 1e-3);
    EXPECT_NEAR(hit.color.g, weights[1] / sum, 1e-3);
    EXPECT_NEAR(hit.color.b, weights[2] / sum, 1e-3);
  }
}

TEST(Isosurface, HidesLightFromFarAway) {
  // Kernels 60 radii apart; each alone is a ball at value 0.5.
  const ParticleSet particles = particles_at({{0, 0, 0}, {60, 0, 0}, {0, 60, 0}});
  Kernel kernel;
  kernel.support_factor = 4;
  const FieldSource field = field_of_all(particles, 1, 1, kernel);
  const KernelSet kernels = build_kernel_set(particles, {field});
  const double scale = kernels.length_scale;
  const auto internal = [&](const Point3d& p) { return Point3d{} + scale * (p - kernels.origin); };
  IsosurfaceFrame frame;
  frame.kernels = &kernels;
  frame.planes = {0, 0.2 * scale};
  frame.box = {internal(kernels.box().min), internal(kernels.box().max)};
  const auto value = static_cast<float>(0.5 * kernels.fields[0].value_scale);
  frame.fields = {{0, {{0, value, 1, {{1, 1, 1}}}}, {}}};
  const double ball = std::sqrt(-2 * std::log(0.5));
  const Vector3d normal{std::sqrt(0.5), std::sqrt(0.5), 0};
  const Point3d place = Point3d{} + ball * normal;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> aside(-0.06, 0.06);
  for (const std::string& target : instruction_sets()) {
    force_instruction_set(target);
    int hidden = 0, open = 0;
    for (int i = 0; i < 200; ++i) {
      // A few at once, as for soft shadows; alternately towards one or both of the others.
      std::vector<Vector3f> directions;
      std::vector<Vector3f> expected;
      for (int k = 0; k < 5; ++k) {
        const bool first = i % 2 == 0 || k < 2;
        const Point3d far = first ? Point3d{60, 0, 0} : Point3d{0, 60, 0};
        const Vector3d d = normalize(normalize(far - place) +
                                     Vector3d{aside(random), aside(random), aside(random)});
        const Vector3d to = far - place;
        const double distance = length(to - dot(to, d) * d);
        // Samples 0.3 apart may miss what is grazed by less than that.
        if (distance > 0.97 * ball && distance < 1.03 * ball) continue;
        directions.emplace_back(d);
        if (distance > ball) expected.emplace_back(d);
      }
      hidden += static_cast<int>(directions.size() - expected.size());
      open += static_cast<int>(expected.size());
      const std::vector<Vector3f> all = directions;
      prune(frame, internal(place), normal, std::numeric_limits<double>::infinity(), directions);
      EXPECT_EQ(directions, expected) << target << ", " << i;
      // Not from beyond the length that is asked for.
      directions = all;
      prune(frame, internal(place), normal, 55 * scale, directions);
      EXPECT_EQ(directions, all) << target << ", " << i;
    }
    EXPECT_GT(hidden, 50);
    EXPECT_GT(open, 50);
  }
  force_instruction_set("");
}

}  // namespace
}  // namespace motes
