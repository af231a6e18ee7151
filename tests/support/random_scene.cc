#include "support/random_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "reference/field.h"
#include "support/particles_at.h"

namespace motes {
namespace {

/// Draws of one seed.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : random_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.;
  }
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  /// 0 to n - 1.
  int below(int n) { return static_cast<int>(uniform(0, n)); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  Vector3d in_cube() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
  Vector3d direction() {
    for (;;) {
      const Vector3d v = in_cube();
      if (length(v) > 0.1 && length(v) < 1) return normalize(v);
    }
  }
  Color color() {
    return {static_cast<float>(uniform(0, 1)), static_cast<float>(uniform(0, 1)),
            static_cast<float>(uniform(0, 1))};
  }

 private:
  std::mt19937 random_;  // its numbers are the same everywhere, unlike the distributions
};

/// Where the data lie, and how large they are.
struct Extent {
  Point3d center;
  double size = 1;     ///< half the side of the cube that holds the particles
  double spacing = 1;  ///< mean distance of neighbours
};

Extent draw_extent(Draw& draw, int num_particles) {
  Extent extent;
  extent.size = draw.log_uniform(0.01, 100);
  if (draw.chance(0.1)) extent.size = draw.chance(0.5) ? 1e24 : 1e-10;
  if (draw.chance(0.3)) {
    extent.center =
        Point3d{} + 1e4 * extent.size * draw.in_cube();  // 1e6 with features of some units
  }
  extent.spacing = 2 * extent.size / std::cbrt(num_particles);
  return extent;
}

ParticleSet draw_particles(Draw& draw, const Extent& extent, int num_particles) {
  std::vector<Point3d> points;
  const bool flat = draw.chance(0.1), coincident = draw.chance(0.1);
  for (int i = 0; i < num_particles; ++i) {
    Point3d p = extent.center + extent.size * draw.in_cube();
    if (flat) p.y = extent.center.y;
    if (coincident && i % 3 == 2) p = points.back();
    points.push_back(p);
  }
  return particles_at(points);
}

/// Mostly Gaussians; tables with a step at their end, and with values of both signs: rough ones,
/// mostly short, and smooth ones.
KernelShape draw_shape(Draw& draw) {
  KernelShape shape;
  if (draw.chance(0.6)) return shape;
  shape.type = static_cast<KernelType>(1 + draw.below(6));
  if (shape.type != KernelType::tabulated) return shape;
  const bool smooth = draw.chance(0.3), negative = draw.chance(0.3), ends = draw.chance(0.5);
  const int num_points = smooth ? 257 : draw.chance(0.8) ? 2 + draw.below(9) : ends ? 40 : 70;
  shape.profile.spacing = draw.uniform(1.5, 3) / num_points;
  for (int i = 0; i < num_points; ++i) {
    const double q = static_cast<double>(i) / (num_points - 1), left = 1 - q;
    const double random = draw.uniform(negative ? -0.5 : 0.5, 1);
    const double rough = random * (ends ? left : 0.1 + left);
    shape.profile.values.push_back(smooth ? std::exp(-4 * q * q) : rough);
  }
  return shape;
}

FieldSource draw_field(Draw& draw, const Extent& extent, int num_particles, int field,
                       int num_fields, bool disjoint, double weight_scale) {
  FieldSource source;
  source.name = fmt::format("field{}", field);
  source.kernel.support_factor = draw.chance(0.4) ? 2 : draw.uniform(1, 4);
  source.kernel.kernel_scale = draw.chance(0.5) ? 1 : draw.log_uniform(0.1, 10);
  source.kernel.shape = draw_shape(draw);
  // A table of both signs may have no integral to speak of.
  source.normalise = source.kernel.shape.type != KernelType::tabulated && draw.chance(0.3);
  const double share = draw.uniform(0.2, 1);
  for (int i = 0; i < num_particles; ++i) {
    const bool taken = disjoint ? i % num_fields == field : draw.chance(share);
    if (taken) source.index.push_back(static_cast<std::uint32_t>(i));
  }
  if (source.index.empty()) source.index = {0};

  const double mean_radius = extent.spacing * draw.log_uniform(0.15, 0.8);
  const double spread = draw.chance(0.2) ? 5 : 1.5;
  const std::size_t num_radii = draw.chance(0.4) ? 1 : source.index.size();
  for (std::size_t i = 0; i < num_radii; ++i) {
    source.radius.push_back(static_cast<float>(mean_radius * draw.log_uniform(1 / spread, spread)));
  }
  const int kind = draw.below(3);  // all alike, positive, of both signs
  const std::size_t num_weights = kind == 0 ? 1 : source.index.size();
  for (std::size_t i = 0; i < num_weights; ++i) {
    const double sign = kind == 2 && draw.chance(0.4) ? -1 : 1;
    source.weight.push_back(static_cast<float>(sign * weight_scale * draw.uniform(0.3, 1.5)));
  }
  return source;
}

/// The largest sum of absolute kernels at some of the field's particles: what the values can be.
double typical_value(const ParticleSet& particles, const FieldSource& source) {
  const auto kernels = reference::particle_kernels(particles, source);
  double typical = 0;
  for (std::size_t i = 0; i < kernels.size(); i += 1 + kernels.size() / 30) {
    typical = std::max(typical, reference::evaluate_field(kernels, kernels[i].center).absolute);
  }
  return typical;
}

/// Points over the values that the field takes, no steeper than float values can follow.
TransferFunction draw_transfer_function(Draw& draw, double typical, double opaque_length) {
  TransferFunction f;
  f.log_scale = draw.chance(0.3);
  const int kinds[] = {1, 2, 2, 3, 6, 20, 40};
  const int num_points = kinds[draw.below(7)];
  const double low = f.log_scale ? -2.5 : draw.uniform(-0.3, 0.3);
  const double high = f.log_scale ? 0.2 : low + draw.uniform(0.5, 1);
  const double highest = draw.log_uniform(0.2, 10) / opaque_length;
  const bool clear_start = draw.chance(0.7);
  for (int i = 0; i < num_points; ++i) {
    const double t = num_points == 1 ? 0.5 : static_cast<double>(i) / (num_points - 1);
    // Those of 40 are evenly spaced, as in named maps; the others are not.
    const double at = low + t * (num_points == 40 ? 1 : 0.7 + 0.3 * t) * (high - low);
    const double ramp = num_points > 6 ? draw.uniform(0.8, 1) * t : draw.uniform(0, 1);
    const bool clear = clear_start && i <= num_points / 4 && num_points > 1;
    f.points.push_back({.value = typical * (f.log_scale ? std::pow(10, at) : at),
                        .color = draw.color(),
                        .extinction = clear ? 0 : highest * ramp});
  }
  return f;
}

const char* draw_camera(Draw& draw, const Extent& extent, Camera& camera) {
  camera.fov_degrees = draw.uniform(20, 60);
  camera.target = extent.center + 0.2 * extent.size * draw.in_cube();
  const Vector3d from = draw.direction();
  camera.up = draw.direction();
  while (length(cross(from, camera.up)) < 0.1) camera.up = draw.direction();
  const double distance = extent.size * draw.uniform(2, 5);
  camera.eye = camera.target + distance * from;
  switch (draw.below(7)) {
    case 0:
      return "outside";
    case 1:
      camera.eye = camera.target + extent.size * draw.uniform(0.01, 1) * from;
      return "inside";
    case 2:
      camera.orthographic_height = extent.size * draw.uniform(0.5, 3);
      return "orthographic";
    case 3:
      camera.eye = camera.target + 0.5 * extent.size * from;
      camera.orthographic_height = extent.size * draw.uniform(0.5, 3);
      return "orthographic inside";
    case 4: {
      // The image's middle looks exactly along an axis.
      const int axis = draw.below(3);
      camera.target = extent.center;
      camera.eye = extent.center;
      camera.eye[axis] += draw.chance(0.5) ? distance : -distance;
      camera.up = {};
      camera.up[(axis + 1) % 3] = 1;
      if (draw.chance(0.3)) camera.orthographic_height = 2 * extent.size;
      return "along an axis";
    }
    case 5:
      camera.eye = camera.target + extent.size * draw.uniform(0.1, 1.5) * from;
      camera.fov_degrees = draw.uniform(90, 150);
      return "wide angle";
    default:
      // The data lie to the side or behind, partly.
      camera.eye = camera.target + extent.size * draw.uniform(0.5, 1.5) * from;
      camera.target = camera.eye + extent.size * draw.direction();
      while (length(cross(camera.target - camera.eye, camera.up)) < 0.1 * extent.size) {
        camera.up = draw.direction();
      }
      return "looking elsewhere";
  }
}

Lighting draw_lighting(Draw& draw) {
  Lighting lighting;
  lighting.enabled = draw.chance(0.5);
  lighting.ambient = draw.uniform(0, 0.5);
  lighting.diffuse = draw.uniform(0, 1);
  lighting.specular = draw.chance(0.3) ? 0 : draw.uniform(0, 0.4);
  lighting.shininess = draw.log_uniform(1, 60);
  if (draw.chance(0.4)) lighting.lights[0].direction = 3. * draw.direction();
  if (draw.chance(0.2)) {
    lighting.lights[0].intensity = draw.uniform(0, 1);
    for (int n = draw.below(3); n > 0; --n) {
      lighting.lights.push_back({draw.direction(), draw.uniform(0, 1)});
    }
  }
  return lighting;
}

/// Through the middle of the data or near it; some across others, so that little or nothing is
/// left.
std::vector<ClipPlane> draw_clip_planes(Draw& draw, const Extent& extent) {
  std::vector<ClipPlane> planes;
  if (draw.chance(0.7)) return planes;
  for (int i = draw.below(3); i >= 0; --i) {
    const Vector3d normal = draw.direction();
    const double distance =
        dot(normal, extent.center - Point3d{}) + draw.uniform(-0.5, 1) * extent.size;
    planes.push_back({draw.uniform(0.5, 2) * normal, distance});
  }
  return planes;
}

}  // namespace

RandomScene random_scene(std::uint32_t seed) {
  Draw draw(seed);
  RandomScene result;
  ResolvedScene& scene = result.scene;
  const auto num_particles =
      static_cast<int>(draw.chance(0.2) ? draw.uniform(1, 10) : draw.log_uniform(10, 400));
  const Extent extent = draw_extent(draw, num_particles);
  result.particles = draw_particles(draw, extent, num_particles);

  const int num_fields = draw.chance(0.5) ? 1 : 2 + draw.below(7);
  const bool disjoint = draw.chance(0.5);
  const double weight_scale = draw.chance(0.7) ? 1 : draw.log_uniform(1e-6, 1e6);
  double smallest_support = 4 * extent.size;
  for (int f = 0; f < num_fields; ++f) {
    FieldSource source =
        draw_field(draw, extent, num_particles, f, num_fields, disjoint, weight_scale);
    const double typical = typical_value(result.particles, source);
    scene.transfer_functions.push_back(
        draw_transfer_function(draw, typical, extent.size * draw.uniform(0.5, 2)));
    const float radius = *std::min_element(source.radius.begin(), source.radius.end());
    smallest_support = std::min(smallest_support, radius * source.kernel.support());
    scene.fields.push_back(std::move(source));
  }

  const char* view = draw_camera(draw, extent, scene.camera);
  // Some samples across a kernel, but no more than some hundred a ray.
  scene.step_size = std::max(smallest_support * draw.log_uniform(0.1, 1.5), extent.size / 40);
  const std::pair<int, int> sizes[] = {{37, 23}, {16, 16}, {19, 45}, {1, 1}, {33, 3}};
  std::tie(scene.render.width, scene.render.height) = sizes[draw.chance(0.6) ? 0 : draw.below(5)];
  const double terminations[] = {0.97, 0.97, 0.5, 0.9, 1};
  scene.render.termination_opacity = terminations[draw.below(5)];
  scene.render.lighting = draw_lighting(draw);
  scene.render.clip_planes = draw_clip_planes(draw, extent);
  result.description = fmt::format(
      "seed {}: {} particles in {} fields, extent {:.3g} around ({:.3g}, {:.3g}, {:.3g}), view {}, "
      "{}x{}, step {:.3g}, termination {}, {}, {} clip planes",
      seed, num_particles, num_fields, extent.size, extent.center.x, extent.center.y,
      extent.center.z, view, scene.render.width, scene.render.height, scene.step_size,
      scene.render.termination_opacity, scene.render.lighting.enabled ? "lit" : "unlit",
      scene.render.clip_planes.size());
  return result;
}

namespace {

/// A grid somewhere around `center`, about as large as `size`: noise, waves, or one value.
std::shared_ptr<const Grid> draw_grid(Draw& draw, const Point3d& center, double size,
                                      double value_scale) {
  Grid grid;
  grid.name = "grid";
  grid.periodic = draw.chance(0.3);
  const auto most = draw.chance(0.5) ? 8 : 30;
  for (std::size_t& n : grid.dims) {
    const int drawn = 2 + draw.below(most - 1);
    n = static_cast<std::size_t>(drawn);
  }
  if (grid.periodic && draw.chance(0.3)) grid.dims[1] = 1;
  const Vector3d sides[3] = {{2 * size, 0, 0}, {0, 2 * size, 0}, {0, 0, 2 * size}};
  const double skew = draw.chance(0.5) ? 0 : 0.5;
  for (std::size_t a = 0; a < 3; ++a) {
    const Vector3d edge = draw.uniform(0.4, 1.3) * sides[a] + skew * size * draw.in_cube();
    grid.steps[a] = edge / static_cast<double>(grid.dims[a]);
  }
  if (draw.chance(0.3)) std::swap(grid.steps[0], grid.steps[2]);  // left-handed, another order
  grid.origin = center - size * Vector3d{1, 1, 1} + 0.5 * size * draw.in_cube();
  grid.values.resize(grid.size());
  const int kind = draw.below(5);
  const Vector3d wave = draw.in_cube();
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const std::size_t row = i / grid.dims[0], plane = row / grid.dims[1];
    const auto x = static_cast<double>(i % grid.dims[0]);
    const auto y = static_cast<double>(row % grid.dims[1]);
    const auto z = static_cast<double>(plane);
    double value = 1;
    if (kind == 1) value = draw.uniform(0, 1);
    if (kind == 2) value = draw.uniform(-1, 1);
    if (kind > 2) value = 0.5 + 0.5 * std::sin(wave.x * x + wave.y * y + wave.z * z);
    if (kind == 4) value = std::max(0., value - 0.5);  // much of it is empty
    grid.values[i] = static_cast<float>(value_scale * value);
  }
  if (draw.chance(0.1)) grid.values[grid.size() / 2] = std::numeric_limits<float>::quiet_NaN();
  return std::make_shared<const Grid>(std::move(grid));
}

}  // namespace

RandomScene random_grid_scene(std::uint32_t seed) {
  RandomScene result = random_scene(seed);
  Draw draw(seed + 1000000);
  ResolvedScene& scene = result.scene;
  const Bounds3d box = result.particles.bounds();
  const Vector3d sides = box.diagonal();
  const double size = 0.5 * std::max({sides.x, sides.y, sides.z});
  // (a lone particle has no extent)
  const double extent = size > 0 ? size : 0.3 * length(scene.camera.target - scene.camera.eye);
  if (seed % 2 == 0) {
    scene.fields.clear();
    scene.transfer_functions.clear();
  }
  const int num_grids = 1 + draw.below(3);
  for (int g = 0; g < num_grids; ++g) {
    const double value_scale = draw.chance(0.7) ? 1 : draw.log_uniform(1e-20, 1e20);
    FieldSource source;
    source.name = fmt::format("grid{}", g);
    source.grid = g > 0 && draw.chance(0.2) && scene.fields.front().grid
                      ? scene.fields.front().grid
                      : draw_grid(draw, box.center(), extent, value_scale);
    source.interpolation = static_cast<Reconstruction>(draw.below(3));
    const auto at = draw.below(static_cast<int>(scene.fields.size()) + 1);
    scene.transfer_functions.insert(
        scene.transfer_functions.begin() + at,
        draw_transfer_function(draw, value_scale, extent * draw.uniform(0.5, 2)));
    scene.fields.insert(scene.fields.begin() + at, std::move(source));
  }
  scene.step_size = std::max(scene.step_size, extent / 40);
  result.description += fmt::format(", {} grids, {} fields in all", num_grids, scene.fields.size());
  return result;
}

}  // namespace motes
