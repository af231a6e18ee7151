// The engines' single samples, values and gradients, against the reference: pictures of one plane
// of samples whose transfer function shows the value, or whose light shows one component of the
// normal.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "reference/field.h"
#include "reference/render.h"
#include "render/engine_ways.h"
#include "render/renderer.h"
#include "support/random_scene.h"

namespace motes {
namespace {

constexpr int width = 45, height = 31;

/// The reference at the only sample of a pixel.
struct Sample {
  reference::FieldValue field;
  double absolute_slope = 0;  ///< sum of |grad phi_i|
  // Sums of peaks, and of peaks over radii, of kernels that end smoothly: close to their ends they
  // are small differences of such numbers, good to some units of their last place.
  double peaks = 0, steepest = 0;
};

/// One field of a random scene with a step so large that the first plane passes through the data
/// and the second behind them; an opaque sample ends the ray.
class OnePlane {
 public:
  OnePlane(const RandomScene& random, std::size_t field)
      : particles_(random.particles), scene_(random.scene) {
    scene_.fields = {random.scene.fields[field]};
    kernels_ = reference::particle_kernels(particles_, scene_.fields[0]);
    box_ = reference::volume_box({kernels_});
    const Vector3d forward = normalize(scene_.camera.target - scene_.camera.eye);
    const Vector3d diagonal = box_.diagonal();
    // Off the centre by a tenth, since planes through centres are special.
    const double depth = dot(box_.center() + 0.1 * diagonal - scene_.camera.eye, forward);
    depth_ = depth > 0 ? depth : 0.1 * length(diagonal);
    scene_.step_size = 2 * depth_;
    scene_.render.width = width;
    scene_.render.height = height;
    scene_.render.termination_opacity = 0.5;
  }

  const ParticleSet& particles() const { return particles_; }
  ResolvedScene& scene() { return scene_; }

  /// The sample of pixel (px, py), unless it is outside the box or too near to a jump.
  std::optional<Sample> sample(int px, int py) const {
    const reference::CameraRay ray =
        reference::camera_ray(scene_.camera, scene_.render.width, scene_.render.height, px, py);
    const Point3d x = ray.origin + depth_ * ray.direction;
    const double tolerance = 1e-5 * length(x - scene_.camera.eye);
    if (!box_.extended(-tolerance).contains(x)) return std::nullopt;
    Sample s{reference::evaluate_field(kernels_, x)};
    if (s.field.boundary_distance <= tolerance) return std::nullopt;
    for (const reference::ParticleKernel& kernel : kernels_) {
      const reference::FieldValue one = reference::evaluate_field({kernel}, x);
      s.absolute_slope += length(one.gradient);
      if (one.num_kernels == 0 || kernel.shape->type == KernelType::gaussian) continue;
      s.peaks += std::abs(kernel.amplitude);
      s.steepest += std::abs(kernel.amplitude) / kernel.radius;
    }
    return s;
  }

  /// Those of all pixels, rows from the top.
  std::vector<std::optional<Sample>> samples() const {
    std::vector<std::optional<Sample>> all;
    all.reserve(width * height);
    for (int i = 0; i < width * height; ++i) all.push_back(sample(i % width, i / width));
    return all;
  }

  /// Shows nothing but white, or with `range` the value from -range (black) to range (white);
  /// opaque.
  void show(double range) {
    const double extinction = 100 / scene_.step_size;
    const Color white{1, 1, 1}, black = range > 0 ? Color{} : white;
    const double end = range > 0 ? range : 1;
    scene_.transfer_functions = {{{{.value = -end, .color = black, .extinction = extinction},
                                   {.value = end, .color = white, .extinction = extinction}},
                                  false}};
  }

 private:
  ParticleSet particles_;
  ResolvedScene scene_;
  std::vector<reference::ParticleKernel> kernels_;
  Bounds3d box_;
  double depth_ = 0;
};

constexpr std::uint32_t num_seeds = 50;

TEST(EngineSamples, ValuesAreThoseOfTheReference) {
  int checked = 0;
  for (std::uint32_t seed = 0; seed < num_seeds; ++seed) {
    RandomScene random = random_scene(seed);
    random.scene.render.clip_planes.clear();
    OnePlane plane(random, 0);
    plane.scene().render.lighting.enabled = false;
    const auto expected = plane.samples();
    double range = 0;
    for (const auto& sample : expected) {
      if (sample) range = std::max(range, sample->field.absolute);
    }
    if (range == 0) continue;
    plane.show(range);
    const Renderer renderer(plane.particles(), plane.scene().fields);
    for (const Way& way : all_ways()) {
      const Framebuffer image = render_in(way, renderer, plane.scene());
      for (int i = 0; i < width * height; ++i) {
        const auto& sample = expected[static_cast<std::size_t>(i)];
        if (!sample) continue;
        const double value = range * (2. * image.pixel(i % width, i / width)[0] - 1);
        // A few roundings of the picture itself, besides those of the field.
        ASSERT_NEAR(value, sample->field.value,
                    1e-5 * sample->field.absolute + 3e-6 * sample->peaks + 5e-7 * range)
            << random.description << "\n"
            << way.name() << ", pixel " << i % width << ", " << i / width;
        checked += sample->field.num_kernels > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(checked, 10000);
}

TEST(EngineSamples, NormalsAreThoseOfTheReference) {
  int checked = 0;
  for (std::uint32_t seed = 0; seed < num_seeds; ++seed) {
    RandomScene random = random_scene(seed);
    random.scene.render.clip_planes.clear();
    OnePlane plane(random, 0);
    plane.show(0);
    const auto expected = plane.samples();
    const Renderer renderer(plane.particles(), plane.scene().fields);
    for (int axis = 0; axis < 3; ++axis) {
      Vector3d light;
      light[axis] = 1;
      plane.scene().render.lighting = {.enabled = true,
                                       .ambient = 0,
                                       .diffuse = 1,
                                       .specular = 0,
                                       .shininess = 1,
                                       .lights = {{light}}};
      for (const Way& way : all_ways()) {
        const Framebuffer image = render_in(way, renderer, plane.scene());
        for (int i = 0; i < width * height; ++i) {
          const auto& sample = expected[static_cast<std::size_t>(i)];
          if (!sample || sample->field.num_kernels == 0) continue;
          const double steepness = length(sample->field.gradient);
          const double error =
              (1e-5 * sample->absolute_slope + 2e-6 * sample->steepest) / steepness;
          if (error > 1e-2) continue;  // kernels cancel, and little is left that could be compared
          ASSERT_NEAR(image.pixel(i % width, i / width)[0],
                      std::abs(sample->field.gradient[axis]) / steepness, 2 * error + 1e-6)
              << random.description << "\n"
              << way.name() << ", axis " << axis << ", pixel " << i % width << ", " << i / width;
          ++checked;
        }
      }
    }
  }
  EXPECT_GT(checked, 10000);
}

}  // namespace
}  // namespace motes
