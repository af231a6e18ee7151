// Crossings of rays and isosurfaces of grids against dense marching and bisection of the
// reference's field in double precision.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "isosurface/isosurface.h"
#include "reference/grid.h"
#include "render/grid_fields.h"
#include "render/isosurface_frame.h"
#include "render/render_tile.h"
#include "scene/scene.h"

namespace motes {
namespace {

/// A small skew grid of smooth random waves, and levels of both signs.
struct Case {
  std::shared_ptr<const Grid> grid;
  Reconstruction reconstruction{};
  GridFields fields;
  KernelSet kernels;
  IsosurfaceFrame frame;
  RayGrid rays;
  std::string description;
};

std::shared_ptr<const Grid> make_grid(std::mt19937& random, bool periodic) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Grid grid;
  grid.name = "test";
  grid.dims = {12, 9, 14};
  grid.origin = {uniform(-20, 20), uniform(-20, 20), uniform(-20, 20)};
  grid.steps = {Vector3d{0.5, 0.1, 0}, {-0.2, 0.7, 0.1}, {0.2, 0, -0.6}};
  grid.periodic = periodic;
  Vector3d waves[3];
  double phases[3];
  for (int w = 0; w < 3; ++w) {
    waves[w] = {uniform(-1.2, 1.2), uniform(-1.2, 1.2), uniform(-1.2, 1.2)};
    phases[w] = uniform(0, 6);
  }
  for (std::size_t k = 0; k < grid.dims[2]; ++k) {
    for (std::size_t j = 0; j < grid.dims[1]; ++j) {
      for (std::size_t i = 0; i < grid.dims[0]; ++i) {
        const Vector3d p{double(i), double(j), double(k)};
        double sum = 0;
        for (int w = 0; w < 3; ++w) sum += std::sin(dot(waves[w], p) + phases[w]);
        grid.values.push_back(static_cast<float>(sum));
      }
    }
  }
  return std::make_shared<const Grid>(std::move(grid));
}

void make_case(int seed, Case& c) {
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  c.reconstruction = std::array{Reconstruction::trilinear, Reconstruction::tricubic,
                                Reconstruction::tricubic_smoothing}[seed % 3];
  c.grid = make_grid(random, seed % 2 == 1);
  FieldSource source;
  source.name = "test";
  source.grid = c.grid;
  source.interpolation = c.reconstruction;
  c.kernels = build_kernel_set({}, {source});
  c.fields = make_grid_fields({source});
  set_units(c.fields, c.kernels);
  const double scale = c.kernels.length_scale;
  const Point3d center = volume_box(c.kernels, c.fields).center();
  // From outside, or, now and then, from within.
  const double away = seed % 5 == 0 ? 1 : uniform(8, 40);
  Camera camera;
  camera.target = center;
  camera.eye = center + away * normalize(Vector3d{uniform(-1, 1), uniform(-1, 1), 1});
  ResolvedScene scene;
  FrameContext context;
  context.kernels = &c.kernels;
  context.orthographic = seed % 4 < 2;
  const double step = uniform(0.1, 0.3) * scale;
  const double first = std::floor(std::max(away - 8, 0.0) * scale / step);
  context.view = {camera_axes(camera),
                  Point3d{} + scale * (camera.eye - c.kernels.origin),
                  {static_cast<std::int64_t>(first), step}};
  const Bounds3d box = volume_box(c.kernels, c.fields);
  context.box = {Point3d{} + scale * (box.min - c.kernels.origin),
                 Point3d{} + scale * (box.max - c.kernels.origin)};
  for (const double value : {uniform(0.1, 1.5), uniform(-1.5, -0.1)}) {
    scene.isosurfaces.push_back({0, value, seed % 3 == 1 ? 1.0F : 0.4F, {{1, 1, 1}}});
  }
  ImagePlane plane;
  plane.width = plane.height = 4;
  c.frame = make_isosurfaces(scene, context, c.fields, plane, {}, {}).frame;
  const double half = context.orthographic ? 4 * scale : 4 / std::max(away, 4.0);
  c.rays = {-half, half, half / 10, -half / 9, -1, 2, 20, 13};
  c.description = fmt::format("seed {}", seed);
}

struct Truth {
  std::uint32_t level;
  double depth;
  bool cap = false;
};

class BruteForce {
 public:
  explicit BruteForce(const Case& c) : case_(c), field_(*c.grid, c.reconstruction) {}

  Point3d point(std::uint32_t ray, double depth) const {
    const auto width = static_cast<std::uint32_t>(case_.rays.width);
    const double u =
        case_.rays.u + (case_.rays.column + static_cast<int>(ray % width)) * case_.rays.du;
    const double v =
        case_.rays.v + (case_.rays.row + static_cast<int>(ray / width)) * case_.rays.dv;
    const SurfaceView& view = case_.frame.view;
    const Vector3d across = u * view.axes.x + v * view.axes.y;
    const Point3d internal = view.orthographic ? view.eye + across + depth * view.axes.forward
                                               : view.eye + depth * (view.axes.forward + across);
    return case_.kernels.origin + (internal - Point3d{}) / case_.kernels.length_scale;
  }
  /// The distance to the hull's faces, and the field where that is within.
  struct Sample {
    std::optional<reference::FieldValue> field;
    double face_distance = 0;
  };
  Sample at(std::uint32_t ray, double depth) const {
    const Point3d p = point(ray, depth);
    Sample sample;
    double room = std::numeric_limits<double>::infinity();
    for (const ClipPlane& face : field_.faces()) {
      room = std::min(room, face.distance - dot(normalize(face.normal), Vector3d(p)));
    }
    sample.face_distance = std::abs(room);
    if (room >= 0) sample.field = field_.at(p);
    return sample;
  }

  /// Both sides of a crossing lie in the hull.
  std::vector<Truth> crossings(std::uint32_t ray) const {
    constexpr int fineness = 4;
    const double step = case_.frame.planes.step / fineness;
    std::vector<Truth> found;
    std::optional<double> before;
    const double begin = case_.frame.planes.depth(0);
    for (int i = 0; i <= case_.frame.last_plane * fineness; ++i) {
      const double z = begin + i * step;
      const auto sample = at(ray, z).field;
      std::optional<double> here;
      if (sample) here = sample->value;
      for (const IsosurfaceLevel& level : case_.frame.fields[0].levels) {
        const double v = value_of(level);
        if (!before || !here || (*before > v) == (*here > v)) continue;
        double low = z - step, high = z;
        for (int k = 0; k < 40; ++k) {
          const double middle = 0.5 * (low + high);
          ((at(ray, middle).field->value > v) == (*before > v) ? low : high) = middle;
        }
        found.push_back({level.number, low});
      }
      before = here;
    }
    return found;
  }
  /// Where the ray enters or leaves the hull within what a level encloses.
  std::vector<Truth> caps(std::uint32_t ray) const {
    const double step = case_.frame.planes.step, begin = case_.frame.planes.depth(0);
    std::vector<Truth> found;
    bool before = at(ray, begin).field.has_value();
    for (int i = 1; i <= case_.frame.last_plane; ++i) {
      double low = begin + (i - 1) * step, high = low + step;
      const bool here = at(ray, high).field.has_value();
      if (here != before) {
        for (int k = 0; k < 40; ++k) {
          const double middle = 0.5 * (low + high);
          (at(ray, middle).field.has_value() == before ? low : high) = middle;
        }
        const double value = at(ray, before ? low : high).field->value;
        for (const IsosurfaceLevel& level : case_.frame.fields[0].levels) {
          const double v = value_of(level);
          if (v > 0 ? value > v + doubt : value < v - doubt)
            found.push_back({level.number, low, true});
        }
      }
      before = here;
    }
    return found;
  }
  static constexpr double doubt = 1e-3;  // of the field on a face, where its slope is not looked at

  /// The normal of the face that a place lies on, outwards.
  Vector3d face_normal(std::uint32_t ray, double depth) const {
    const Point3d p = point(ray, depth);
    const auto faces = field_.faces();
    const auto room = [&](const ClipPlane& face) {
      return std::abs(face.distance / length(face.normal) -
                      dot(normalize(face.normal), Vector3d(p)));
    };
    return normalize(
        std::min_element(faces.begin(), faces.end(), [&](const ClipPlane& a, const ClipPlane& b) {
          return room(a) < room(b);
        })->normal);
  }

  double value_of(const IsosurfaceLevel& level) const {
    return level.value / case_.kernels.fields[0].value_scale;
  }

 private:
  const Case& case_;
  reference::GridField field_;
};

class GridIsosurfaces : public testing::TestWithParam<int> {};

TEST_P(GridIsosurfaces, AreCrossedWhereTheReferencesFieldCrosses) {
  Case c;
  make_case(GetParam(), c);
  const BruteForce truth(c);
  const double step = c.frame.planes.step;
  std::vector<std::vector<Truth>> expected;
  std::vector<std::vector<Truth>> caps;
  for (std::uint32_t ray = 0; ray < c.rays.size(); ++ray) {
    expected.push_back(truth.crossings(ray));
    caps.push_back(truth.caps(ray));
  }
  std::size_t crossings = 0, turned = 0, num_caps = 0;
  for (const std::string& target : instruction_sets()) {
    force_instruction_set(target);
    std::vector<IsosurfaceHit> hits;
    trace_isosurfaces(c.frame, c.rays, hits);
    auto hit = hits.begin();
    for (std::uint32_t ray = 0; ray < c.rays.size(); ++ray) {
      const auto& truths = expected[ray];
      const std::string where = fmt::format("{}, {}, ray {}", c.description, target, ray);
      std::vector<bool> seen(truths.size()), cap_seen(caps[ray].size());
      double last = std::numeric_limits<double>::infinity();
      for (; hit != hits.end() && hit->ray == ray; ++hit) {
        if (hit->opacity >= 1) last = hit->depth;
        const auto at = truth.at(ray, hit->depth);
        for (std::size_t i = 0; i < caps[ray].size(); ++i) {
          const Truth& cap = caps[ray][i];
          if (cap.level != hit->level || std::abs(cap.depth - hit->depth) > 1e-4 * step) continue;
          const Vector3d along = truth.point(ray, 1) - truth.point(ray, 0);
          Vector3d normal = truth.face_normal(ray, cap.depth);
          if (dot(normal, along) > 0) normal = -normal;
          cap_seen[i] = cap_seen[i] || length(normal - Vector3d(hit->normal)) < 1e-5;
        }
        // On a face: whether the crossing is within is a matter of rounding.
        if (at.face_distance * c.kernels.length_scale < 2e-3 * step) continue;
        ASSERT_TRUE(at.field) << where;
        const IsosurfaceLevel& level = c.frame.fields[0].levels[hit->level];
        const Vector3d along = truth.point(ray, hit->depth + step) - truth.point(ray, hit->depth);
        // 1e-4 of a step from bisection; the field is right to 1e-5 of its largest values, 3 here,
        // which index coordinates in single precision take part in.
        constexpr double rounding = 3e-5;
        const double tolerance = 1e-4 * std::abs(dot(at.field->gradient, along)) + rounding;
        EXPECT_NEAR(at.field->value, truth.value_of(level), 2 * tolerance) << where;
        Vector3d normal = normalize(at.field->gradient);
        const double grazing = std::abs(dot(normal, normalize(along)));
        // To the side that the ray comes from, which the field tells: a gradient made of
        // differences may be turned to the other where the ray grazes the surface.
        const double aside = 2e-3 * step;
        const auto before = truth.at(ray, hit->depth - aside).field;
        const auto after = truth.at(ray, hit->depth + aside).field;
        if (before && after && std::abs(after->value - before->value) > 2 * rounding) {
          if (after->value > before->value) normal = -normal;
          EXPECT_LE(length(normal - Vector3d(hit->normal)), 2e-3) << where;
          turned += dot(normal, along) > 0 ? 1 : 0;
        }
        for (std::size_t i = 0; i < truths.size(); ++i) {
          if (truths[i].level != hit->level) continue;
          const double slack = (1e-3 + 1e-3 / std::max(grazing, 1e-2)) * step;
          if (std::abs(truths[i].depth - hit->depth) <= slack) seen[i] = true;
        }
        ++crossings;
      }
      for (std::size_t i = 0; i < truths.size(); ++i) {
        if (truths[i].depth > last - 1e-3 * step) continue;
        // Pairs within a step may be missed, and so may what lies on a face.
        bool pair = false;
        for (std::size_t j = 0; j < truths.size(); ++j) {
          pair = pair || (j != i && truths[j].level == truths[i].level &&
                          std::abs(truths[j].depth - truths[i].depth) <= step);
        }
        const double face = truth.at(ray, truths[i].depth).face_distance;
        if (pair || face * c.kernels.length_scale < 2e-3 * step) continue;
        EXPECT_TRUE(seen[i]) << where << " misses " << truths[i].depth;
      }
      for (std::size_t i = 0; i < caps[ray].size(); ++i) {
        if (caps[ray][i].depth > last + 1e-3 * step) continue;
        EXPECT_TRUE(cap_seen[i]) << where << " misses the cap at " << caps[ray][i].depth;
        ++num_caps;
      }
    }
    EXPECT_EQ(hit, hits.end());
  }
  force_instruction_set("");
  EXPECT_GT(crossings, 60 * instruction_sets().size());
  EXPECT_GT(num_caps, 10 * instruction_sets().size());
  if (c.reconstruction == Reconstruction::trilinear) {
    EXPECT_GT(turned, 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, GridIsosurfaces, testing::Range(0, 6));

/// Sets c.frame to opaque isosurfaces of a cube from -4 to 4 of 9 x 9 x 9 samples, value_of(layer),
/// seen from (0, 0, 20) against z. Returns the internal length of 1.
template <class ValueOf>
double make_cube(const std::vector<double>& levels, ValueOf&& value_of, Case& c) {
  auto grid = std::make_shared<Grid>();
  grid->name = "cube";
  grid->dims = {9, 9, 9};
  grid->origin = {-4, -4, -4};
  grid->steps = {Vector3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t i = 0; i < 729; ++i) grid->values.push_back(value_of(i / 81));
  c.grid = grid;
  FieldSource source;
  source.grid = c.grid;
  c.kernels = build_kernel_set({}, {source});
  c.fields = make_grid_fields({source});
  set_units(c.fields, c.kernels);
  const double scale = c.kernels.length_scale, side = 4 * scale;
  ResolvedScene scene;
  for (const double value : levels) scene.isosurfaces.push_back({0, value, 1, {{1, 1, 1}}});
  FrameContext context;
  context.kernels = &c.kernels;
  Camera camera;
  camera.eye = {0, 0, 20};
  camera.target = {};
  context.view = {
      camera_axes(camera), Point3d{} + scale * (camera.eye - c.kernels.origin), {0, 0.5 * scale}};
  context.box = {{-side, -side, -side}, {side, side, side}};
  c.frame = make_isosurfaces(scene, context, c.fields, {}, {}, {}).frame;
  return scale;
}

// No value of the grid is the level's: there is only the face to be met.
TEST(GridIsosurface, IsABoxWhereTheLevelEnclosesAll) {
  for (const float sign : {1.0F, -1.0F}) {
    Case c;
    const double scale = make_cube(
        {static_cast<double>(sign)}, [sign](std::size_t) { return 2 * sign; }, c);
    for (const std::string& target : instruction_sets()) {
      force_instruction_set(target);
      std::vector<IsosurfaceHit> hits;
      trace_isosurfaces(c.frame, {-0.2, 0.2, 0.025, -0.025, 0, 0, 17, 17}, hits);
      ASSERT_EQ(hits.size(), 17U * 17U) << target;
      for (const IsosurfaceHit& hit : hits) {
        EXPECT_NEAR(hit.depth, 16 * scale, 1e-4 * scale) << target;
        EXPECT_NEAR(hit.normal.z, 1, 1e-6) << target;
      }
    }
    force_instruction_set("");
  }
}

// On a face what is farther from 0 is seen, in whatever order the scene has the levels.
TEST(GridIsosurface, ShowsTheInnermostOfSeveralCaps) {
  Case c;
  make_cube(
      {0.5, 1.5, 1.0}, [](std::size_t) { return 2.0F; }, c);
  std::vector<IsosurfaceHit> hits;
  trace_isosurfaces(c.frame, {0, 0, 0.01, 0.01, 0, 0, 1, 1}, hits);
  ASSERT_EQ(hits.size(), 1u);
  EXPECT_EQ(hits[0].level, 1u);
}

TEST(GridIsosurface, HidesTheLightOfWhatIsWithin) {
  // A field that is the height along z above the grid's middle: level 1 is a plane.
  Case c;
  const double scale = make_cube(
      {1}, [](std::size_t layer) { return static_cast<float>(layer) - 4; }, c);
  IsosurfaceFrame wide = c.frame;  // what else is drawn makes the box larger
  wide.box = {Point3d{} + 2.0 * Vector3d(wide.box.min), Point3d{} + 2.0 * Vector3d(wide.box.max)};
  const Point3d start = Point3d{} + scale * (Point3d{0.2, 0.1, -0.6} - c.kernels.origin);
  const std::vector<Vector3f> all = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0.6F, 0, 0.8F}};
  // From beside the field: what the level encloses is met at its face.
  const Point3d beside = Point3d{} + scale * (Point3d{-5, 0.1, 2} - c.kernels.origin);
  for (const std::string& target : instruction_sets()) {
    force_instruction_set(target);
    std::vector<Vector3f> far = all, near = all;
    prune(c.frame, start, {0, 0, 1}, 3 * scale, far);
    ASSERT_EQ(far.size(), 2u) << target;
    EXPECT_EQ(far[0].z, -1);
    EXPECT_EQ(far[1].x, 1);
    prune(c.frame, start, {0, 0, 1}, 1.5 * scale, near);
    EXPECT_EQ(near.size(), 4u) << target;
    std::vector<Vector3f> capped = {{1, 0, 0}, {-1, 0, 0}, {0.8F, 0, -0.6F}};
    prune(wide, beside, {-1, 0, 0}, 8 * scale, capped);
    ASSERT_EQ(capped.size(), 1u) << target;
    EXPECT_EQ(capped[0].x, -1);
  }
  force_instruction_set("");
}

}  // namespace
}  // namespace motes
