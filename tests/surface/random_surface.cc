#include "surface/random_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/particles_at.h"

namespace motes {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(generator_); }
  double log_between(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  }
  Vector3d in_cube(double half) {
    return {between(-half, half), between(-half, half), between(-half, half)};
  }

 private:
  std::mt19937 generator_;
};

void draw_radii(Random& random, RandomSurface& scene) {
  PerKernel& radius = scene.surface.radius;
  const std::size_t n = scene.kernels->size();
  const int kind = random.below(5);
  scene.description += fmt::format(", radii of kind {}", kind);
  if (kind == 0) {
    radius.share(static_cast<float>(scene.spacing * random.between(0.2, 0.8)));
    return;
  }
  if (kind == 1) {
    radius.share(0);
    return;
  }
  radius.allocate(n);
  for (std::size_t i = 0; i < n; ++i) {
    double r = scene.spacing * random.between(0.1, 0.7);
    if (kind == 3) r *= std::pow(10, -random.below(5));
    // Most are tiny, lest the large ones hide all.
    if (kind == 4) r = scene.spacing * 1e-4 * std::pow(random.between(0, 1), -2);
    if (kind == 2 && random.below(4) == 0) r = random.below(2) == 0 ? 0 : -r;
    if (kind == 2 && random.below(9) == 0) r = std::numeric_limits<double>::quiet_NaN();
    radius.at(i) = static_cast<float>(std::min(r, 1e4 * scene.spacing));
  }
}

void draw_sticks(Random& random, RandomSurface& scene) {
  const KernelSet& kernels = *scene.kernels;
  Sticks& sticks = scene.surface.sticks;
  sticks.begin.resize(kernels.x.size() + 1);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i <= kernels.x.size(); ++i) {
    sticks.begin[i] = count;
    if (i < kernels.size() && random.below(3) > 0)
      count += static_cast<std::uint32_t>(random.below(5));
  }
  sticks.resize(count);
  const bool shared = random.below(2) == 0;
  sticks.radius.assign(shared ? 1 : sticks.x.size(), 0);
  for (float& r : sticks.radius) r = static_cast<float>(scene.spacing * random.between(0.05, 0.2));
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    for (std::size_t s = sticks.begin[i]; s < sticks.begin[i + 1]; ++s) {
      Vector3d half = random.in_cube(0.6 * scene.spacing);
      // Along an axis too, and hardly any.
      if (random.below(4) == 0) half[random.below(3)] = half[random.below(3)] = 0;
      if (random.below(8) == 0) half = 1e-4 * half;
      if (length(half) == 0) half.z = scene.spacing;
      sticks.x[s] = static_cast<float>(half.x);
      sticks.y[s] = static_cast<float>(half.y);
      sticks.z[s] = static_cast<float>(half.z);
      sticks.owner[s] = static_cast<std::uint8_t>(i % Bvh::leaf_size);
    }
  }
}

}  // namespace

RandomSurface random_surface(unsigned seed) {
  Random random(seed);
  constexpr int sizes[] = {1, 2, 15, 16, 17, 100, 129, 300};
  const int n = sizes[random.below(8)];
  const double edge = random.log_between(1e-6, 1e6);
  const Point3d middle = Point3d{} + random.in_cube(random.below(2) == 0 ? 0 : 100 * edge);
  std::vector<Point3d> points;
  for (int i = 0; i < n; ++i) {
    const bool again = i > 0 && random.below(20) == 0;
    points.push_back(again ? points.back() : middle + random.in_cube(edge / 2));
  }
  const ParticleSet particles = particles_at(points);
  const double spacing = edge / std::cbrt(n);

  RandomSurface scene;
  scene.description = fmt::format("seed {}: {} particles", seed, n);
  scene.kernels = std::make_unique<KernelSet>(build_kernel_set(
      particles, {field_of_all(particles, static_cast<float>(spacing / 3), 1, {})}));
  scene.surface.kernels = scene.kernels.get();
  scene.spacing = spacing * scene.kernels->length_scale;
  draw_radii(random, scene);
  if (random.below(2) == 0) {
    draw_sticks(random, scene);
    scene.description += fmt::format(", {} sticks", scene.surface.sticks.size());
  }
  fit_reach(scene.surface);
  return scene;
}

RandomView random_view(const RandomSurface& scene, unsigned seed) {
  Random random(seed);
  const Bounds3f box = bounds_of(scene.kernels->bvh);
  const Point3d middle(box.center());
  const double size = 2 * scene.spacing + length(Vector3d(box.diagonal()));
  Vector3d towards = random.in_cube(1);
  if (random.below(4) == 0) towards = {0, 0, -1};  // along an axis
  towards = normalize(towards);
  const Vector3d up = std::abs(towards.y) < 0.9 ? Vector3d{0, 1, 0} : Vector3d{1, 0, 0};

  RandomView out;
  const int kind = random.below(5);
  double distance = size * random.between(0.7, 2);
  if (kind == 1) distance = size * random.between(0, 0.3);  // within
  if (kind == 2) distance = 1e4 * scene.spacing;
  double half = std::min(0.6 * size / distance, 1.5);
  if (kind == 3 || kind == 4) {
    out.view.orthographic = true;
    half = 0.6 * size;
    if (kind == 4) distance = size * random.between(-0.3, 0.3);
  }
  // Close-ups too.
  half *= random.log_between(0.05, 1);
  out.description = fmt::format("view {}: kind {}, {:.3g} wide from {:.3g}", seed, kind, half,
                                distance / scene.spacing);
  Camera camera;
  camera.eye = Point3d{} - towards;
  camera.target = {};
  camera.up = up;
  out.view.axes = camera_axes(camera);
  out.view.eye = middle - distance * towards + random.in_cube(0.2 * scene.spacing);
  // On a particle now and then.
  if (kind == 1 && random.below(3) == 0) {
    out.view.eye = {scene.kernels->x[0], scene.kernels->y[0], scene.kernels->z[0]};
  }
  RayGrid& grid = out.grid;
  grid.width = 1 + random.below(40);
  grid.height = 1 + random.below(30);
  grid.column = random.below(50) - 30;
  grid.row = random.below(50) - 30;
  grid.du = 2 * half / grid.width * (random.below(3) == 0 ? -1 : 1);
  grid.dv = 2 * half / grid.height * (random.below(3) == 0 ? 1 : -1);
  grid.u = -grid.du * (grid.column + 0.5 * grid.width + random.between(0, 1));
  grid.v = -grid.dv * (grid.row + 0.5 * grid.height + random.between(0, 1));
  return out;
}

}  // namespace motes
