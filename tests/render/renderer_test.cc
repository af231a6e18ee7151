#include "render/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "image/compare.h"
#include "render/engine_ways.h"
#include "support/particles_at.h"

namespace motes {
namespace {

/// Looks at the origin from z = 20; an odd size, so that the middle pixel's ray is the axis.
ResolvedScene scene_along_z(double step, const TransferFunction& function) {
  ResolvedScene scene;
  scene.camera.eye = {0, 0, 20};
  scene.camera.target = {0, 0, 0};
  scene.step_size = step;
  scene.render.width = scene.render.height = 33;
  scene.render.lighting.enabled = false;
  scene.render.termination_opacity = 1;
  scene.transfer_functions = {function};
  return scene;
}

double middle_alpha(const Framebuffer& image) {
  return image.pixel(image.width / 2, image.height / 2)[3];
}

ParticleSet random_particles(std::size_t n, double size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-size, size);
  std::vector<Point3d> points;
  for (std::size_t i = 0; i < n; ++i) {
    points.push_back({coordinate(random), coordinate(random), coordinate(random)});
  }
  return particles_at(points);
}

const TransferFunction ramp{{{0.1, {0, 0, 1}, 0}, {1.5, {1, 1, 0}, 1.5}}, false};

// The integral of a Gaussian truncated at sigma along a ray through its centre is
// sqrt(2 pi) r erf(sigma / sqrt 2); with extinction = value it is the ray's optical depth.
TEST(ClosedForm, IntegralOfALoneGaussianAlongARay) {
  const ParticleSet particles = particles_at({{0, 0, 0}});
  const TransferFunction identity{{{0, {1, 1, 1}, 0}, {10, {1, 1, 1}, 10}}, false};
  for (const double sigma : {2.0, 3.0, 6.0}) {
    for (const float radius : {0.5f, 1.5f}) {
      const Renderer renderer(particles, {field_of_all(particles, radius, 0.4f, {sigma, 1.5})});
      const Framebuffer image = renderer.render(scene_along_z(radius / 200, identity), {});
      const double depth = 1.5 * 0.4f * std::sqrt(2 * std::numbers::pi) * radius *
                           std::erf(sigma / std::numbers::sqrt2);
      // The truncation's jump is sampled to half a step at each end.
      const double jump = 0.6 * std::exp(-sigma * sigma / 2) * radius / 200;
      EXPECT_NEAR(middle_alpha(image), 1 - std::exp(-depth), jump + 2e-6) << sigma << " " << radius;
    }
  }
}

TEST(ClosedForm, OpacityOfAHomogeneousSlab) {
  // Two particles at the ends of the box; constant extinction whatever the value.
  const ParticleSet particles = particles_at({{-3, -3, -3}, {3, 3, 3}});
  for (const double extinction : {0.02, 0.3, 5.0}) {
    const TransferFunction constant{{{0, {0.5f, 0.25f, 1}, extinction}}, false};
    const Renderer renderer(particles, {field_of_all(particles, 0.5f, 1, {2, 1})});
    const Framebuffer image = renderer.render(scene_along_z(0.01, constant), {});
    const double alpha = 1 - std::exp(-extinction * 8);  // the box: 3 + 3 + 2 * sigma * radius
    EXPECT_NEAR(middle_alpha(image), alpha, 2e-6 + 0.01 * extinction * (1 - alpha));
    EXPECT_NEAR(image.pixel(16, 16)[0], 0.5 * middle_alpha(image), 1e-6);
  }
}

TEST(Renderer, ChangesSigmaAndKappaWithoutTouchingTheTree) {
  const ParticleSet particles = random_particles(500, 4);
  Renderer changed(particles, {field_of_all(particles, 0.5f, 1, {2, 1})});
  const Bvh::Node* const nodes = changed.kernels().bvh.nodes.data();
  changed.set_kernel(0, {3, 0.7});
  EXPECT_EQ(changed.kernels().bvh.nodes.data(), nodes);
  const Renderer fresh(particles, {field_of_all(particles, 0.5f, 1, {3, 0.7})});
  const ResolvedScene scene = scene_along_z(0.2, ramp);
  EXPECT_EQ(changed.render(scene, {}), fresh.render(scene, {}));
}

/// A frame of a trajectory: each particle `distance` or less from where it was along each axis.
ParticleSet moved(const ParticleSet& particles, double distance, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> step(-distance, distance);
  std::vector<Point3d> points;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    points.push_back(particles.position(i) + Vector3d{step(random), step(random), step(random)});
  }
  return particles_at(points);
}

/// Two fields that share out the particles, with radii and weights that differ from `seed` to seed.
std::vector<FieldSource> two_fields(const ParticleSet& particles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> factor(0.7f, 1.3f);
  std::vector<FieldSource> fields(2);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    FieldSource& field = fields[i % 3 == 0 ? 1 : 0];
    field.index.push_back(static_cast<std::uint32_t>(i));
    field.radius.push_back(0.4f * factor(random));
    field.weight.push_back(factor(random));
  }
  fields[1].normalise = true;
  return fields;
}

/// The pictures of `renderer` are those of one that is built from this frame.
void expect_fresh_pictures(const Renderer& renderer, const ParticleSet& particles,
                           const std::vector<FieldSource>& fields) {
  const Renderer fresh(particles, fields);
  EXPECT_EQ(renderer.kernels().centers, fresh.kernels().centers);
  ResolvedScene scene = scene_along_z(0.2, ramp);
  scene.transfer_functions.resize(fields.size(), ramp);
  for (const Engine engine : {Engine::sweep, Engine::coherent, Engine::direct}) {
    scene.render.engine = engine;
    const Framebuffer expected = fresh.render(scene, {});
    EXPECT_GT(middle_alpha(expected), 0.2);
    EXPECT_LT(compare_images(renderer.render(scene, {}), expected).max, 2e-5) << name_of(engine);
  }
}

TEST(Renderer, RefitsItsTreeToTheNextFrame) {
  ParticleSet particles = random_particles(3000, 4);
  std::vector<FieldSource> fields = two_fields(particles, 1);
  Renderer renderer(particles, fields);
  EXPECT_EQ(renderer.set_particles(particles, fields), TreeUpdate::rebuilt);  // the first time
  for (unsigned frame = 2; frame < 5; ++frame) {
    particles = moved(particles, 0.1, frame);
    fields = two_fields(particles, frame);
    EXPECT_EQ(renderer.set_particles(particles, fields), TreeUpdate::refitted);
    expect_fresh_pictures(renderer, particles, fields);
  }
  particles.origin.x += 1.25;
  EXPECT_EQ(renderer.set_particles(particles, fields), TreeUpdate::refitted);
  expect_fresh_pictures(renderer, particles, fields);
}

TEST(Renderer, RebuildsItsTreeWhereARefitIsNotWorthIt) {
  const ParticleSet particles = random_particles(3000, 4);
  std::vector<FieldSource> fields = two_fields(particles, 1);
  Renderer renderer(particles, fields);
  renderer.set_particles(particles, fields);
  const auto expect_rebuilt = [&](const ParticleSet& next) {
    EXPECT_EQ(renderer.set_particles(next, fields), TreeUpdate::rebuilt);
    expect_fresh_pictures(renderer, next, fields);
    EXPECT_EQ(renderer.set_particles(next, fields), TreeUpdate::refitted);
    expect_fresh_pictures(renderer, next, fields);
  };
  expect_rebuilt(moved(particles, 3, 5));     // neighbours are neighbours no more
  expect_rebuilt(moved(particles, 1e-9, 6));  // back again
  fields[0].index.pop_back();                 // another number of kernels
  fields[0].radius.pop_back();
  fields[0].weight.pop_back();
  expect_rebuilt(particles);
  std::swap(fields[0], fields[1]);  // the same number, of other fields
  expect_rebuilt(particles);
  expect_rebuilt(particles_at(std::vector<Point3d>(particles.size())));  // all in one place
  expect_rebuilt(particles);
}

TEST(Renderer, PicturesAreTheSameWhetherKernelsShareAValueOrStoreIt) {
  // A kernel that nobody sees may have another, lesser radius and weight: then all are stored.
  std::vector<Point3d> points;
  const ParticleSet cloud = random_particles(2000, 4);
  for (std::size_t i = 0; i < cloud.size(); ++i) points.push_back(cloud.position(i));
  points.push_back({0, 0, 40});  // behind the camera
  const ParticleSet particles = particles_at(points);
  const auto field = [&](float radius, float weight) {
    FieldSource source = field_of_all(particles, 0.5f, 0.75f, {2, 1});
    source.radius.assign(particles.size(), 0.5f);
    source.weight.assign(particles.size(), 0.75f);
    source.radius.back() = radius;
    source.weight.back() = weight;
    return source;
  };
  const Renderer shared(particles, {field(0.5f, 0.75f)}), stored(particles, {field(0.49f, 0.7f)});
  ASSERT_LT(shared.kernels().particle_bytes() + 7 * particles.size(),
            stored.kernels().particle_bytes());
  ResolvedScene scene = scene_along_z(0.1, ramp);
  for (const bool lit : {false, true}) {
    scene.render.lighting.enabled = lit;
    for (const Way& way : all_ways()) {
      const Framebuffer image = render_in(way, shared, scene);
      EXPECT_GT(middle_alpha(image), 0.2);
      EXPECT_EQ(image, render_in(way, stored, scene)) << way.name() << (lit ? ", lit" : "");
    }
  }
}

TEST(Renderer, RefitsItsTreeToKernelsThatShareAValueOrDoNot) {
  ParticleSet particles = random_particles(3000, 4);
  const auto shared = [&] {
    return std::vector<FieldSource>{field_of_all(particles, 0.4f, 1, {2, 1})};
  };
  const auto stored = [&](unsigned seed) {
    std::vector<FieldSource> fields = shared();
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> factor(0.7f, 1.3f);
    fields[0].radius.clear();
    fields[0].weight.clear();
    for (std::size_t i = 0; i < particles.size(); ++i) {
      fields[0].radius.push_back(0.4f * factor(random));
      fields[0].weight.push_back(factor(random));
    }
    return fields;
  };
  Renderer renderer(particles, shared());
  renderer.set_particles(particles, shared());
  const std::size_t least = renderer.kernels().particle_bytes();
  for (unsigned frame = 1; frame < 5; ++frame) {
    particles = moved(particles, 0.05, frame);
    const std::vector<FieldSource> fields = frame % 2 == 1 ? stored(frame) : shared();
    EXPECT_EQ(renderer.set_particles(particles, fields), TreeUpdate::refitted);
    EXPECT_EQ(renderer.kernels().particle_bytes() == least, frame % 2 == 0);
    expect_fresh_pictures(renderer, particles, fields);
  }
}

TEST(Renderer, OnePassGivesThePictureOfManyPasses) {
  const ParticleSet particles = random_particles(500, 4);
  const Renderer renderer(particles, {field_of_all(particles, 0.5f, 1, {2, 1})});
  ResolvedScene scene = scene_along_z(0.05, ramp);
  scene.render.lighting.enabled = true;
  const Framebuffer many = renderer.render(scene, {});
  RenderOptions options;
  options.samples_per_pass = 0;
  const Framebuffer one = renderer.render(scene, options);
  double visible = 0;
  for (std::size_t i = 0; i < many.rgba.size(); ++i) {
    ASSERT_NEAR(one.rgba[i], many.rgba[i], 1e-5);
    visible = std::max(visible, static_cast<double>(many.rgba[i]));
  }
  EXPECT_GT(visible, 0.5);
}

/// Cancels in the midst of a frame.
class CancelsHalfway : public Progress {
 public:
  void update(std::string_view, double fraction) override { cancel = fraction >= 0.5; }
  std::atomic<bool> cancel = false;
};

TEST(Renderer, GoesOnWithAFrameThatWasCancelled) {
  const ParticleSet particles = random_particles(500, 4);
  ResolvedScene scene = scene_along_z(0.05, ramp);
  scene.render.width = scene.render.height = 133;
  const Renderer renderer(particles, {field_of_all(particles, 0.5f, 1, {2, 1})});
  const Framebuffer whole = renderer.render(scene, {});
  CancelsHalfway progress;
  std::vector<std::uint8_t> done;
  RenderOptions options;
  options.progress = &progress;
  options.cancel = &progress.cancel;
  options.tiles_done = &done;
  Framebuffer image;
  EXPECT_THROW(renderer.render(scene, options, image), Cancelled);
  const auto missing = std::find(done.begin(), done.end(), 0);
  ASSERT_NE(missing, done.end());
  ASSERT_EQ(done.front(), 1);
  // What is done is not touched again.
  const float before = std::exchange(image.pixel(0, 0)[0], 42.0f);
  progress.cancel = false;
  options.progress = nullptr;
  renderer.render(scene, options, image);
  EXPECT_EQ(image.pixel(0, 0)[0], 42.0f);
  image.pixel(0, 0)[0] = before;
  EXPECT_EQ(image, whole);
}

TEST(Renderer, CountsTheSamplesInTheBox) {
  const ParticleSet particles = particles_at({{0, 0, 0}});
  const Renderer renderer(particles, {field_of_all(particles, 1, 1, {2, 1})});
  ResolvedScene scene = scene_along_z(1, ramp);
  scene.camera.orthographic_height = 1;  // all rays go through the box, 4 deep
  RenderStatistics statistics;
  renderer.render(scene, {}, &statistics);
  EXPECT_EQ(statistics.samples, 4u * 33 * 33);
  EXPECT_GT(statistics.kernel_evaluations, 0u);
}

TEST(Renderer, RendersNothingWhereThereIsNothing) {
  const ParticleSet particles = particles_at({{0, 0, 0}});
  const Renderer renderer(particles, {field_of_all(particles, 1, 1, {2, 1})});
  ResolvedScene scene = scene_along_z(0.1, ramp);
  scene.camera.target = {0, 0, 40};  // looks away
  EXPECT_EQ(renderer.render(scene, {}), Framebuffer(33, 33));
}

TEST(Renderer, RefusesStepsThatNeverEnd) {
  const ParticleSet particles = particles_at({{0, 0, 0}});
  const Renderer renderer(particles, {field_of_all(particles, 1, 1, {2, 1})});
  EXPECT_THROW(renderer.render(scene_along_z(1e-9, ramp), {}), Error);
  ResolvedScene far = scene_along_z(0.1, ramp);
  far.camera.eye = {0, 0, 1e17};
  EXPECT_THROW(renderer.render(far, {}), Error);
}

TEST(Renderer, SurvivesExtremeScales) {
  // Centimetres of a galaxy cluster with masses in grammes; and the same tiny.
  for (const double scale : {1e24, 1e-24}) {
    std::vector<Point3d> points;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(-4, 4);
    points.reserve(200);
    for (int i = 0; i < 200; ++i) {
      points.push_back(
          {scale * coordinate(random), scale * coordinate(random), scale * coordinate(random)});
    }
    const ParticleSet particles = particles_at(points);
    FieldSource field = field_of_all(particles, static_cast<float>(scale), 1e33f, {2, 1});
    field.normalise = scale > 1;
    const Renderer renderer(particles, {field});
    const double unit = field.normalise ? 1e33 / (scale * scale * scale) : 1e33;
    TransferFunction function = ramp;
    for (TransferFunction::Point& p : function.points) {
      p.value *= unit;
      p.extinction /= scale;
    }
    ResolvedScene scene = scene_along_z(0.1 * scale, function);
    scene.camera.eye = {0, 0, 20 * scale};
    const double alpha = middle_alpha(renderer.render(scene, {}));
    EXPECT_GT(alpha, 0.01) << scale;
    EXPECT_LE(alpha, 1) << scale;
  }
}

}  // namespace
}  // namespace motes
