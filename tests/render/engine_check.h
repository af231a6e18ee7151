// Small scenes, and holding every engine's picture of them against the reference's. The tolerances
// are those of docs/field.md, "Exactness".
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "image/compare.h"
#include "reference/render.h"
#include "render/engine_ways.h"
#include "render/renderer.h"
#include "support/particles_at.h"

namespace motes {

inline Framebuffer to_framebuffer(const reference::Image& image) {
  Framebuffer framebuffer(image.width, image.height);
  std::transform(image.rgba.begin(), image.rgba.end(), framebuffer.rgba.begin(),
                 [](double v) { return static_cast<float>(v); });
  return framebuffer;
}

/// Holds pictures against the reference's, and sums up what no single small picture can show.
class Comparison {
 public:
  /// Renders the scene in all ways.
  void check(const ParticleSet& particles, const ResolvedScene& scene,
             const std::string& description) {
    const reference::Image truth = reference::render(particles, scene);
    const Framebuffer expected = to_framebuffer(truth);
    const auto unstable = std::count(truth.unstable.begin(), truth.unstable.end(), 1);
    unstable_ += static_cast<std::size_t>(unstable);
    pixels_ += expected.num_pixels();
    const Renderer renderer(particles, scene.fields);
    for (const Way& way : all_ways()) {
      RenderStatistics statistics;
      const Framebuffer image = render_in(way, renderer, scene, 2, &statistics);
      ASSERT_EQ(image.width, expected.width);
      ASSERT_EQ(image.height, expected.height);
      const ImageDifference stable = compare_images(image, expected, truth.unstable);
      const std::string where = fmt::format("{}\n{}, worst at pixel ({}, {})", description,
                                            way.name(), stable.worst_x, stable.worst_y);
      EXPECT_LE(stable.max, 1e-3) << where;
      EXPECT_LE(stable.rms, 1e-4) << where;
      if (unstable == 0) {
        EXPECT_EQ(statistics.samples, truth.samples) << where;
        EXPECT_GE(statistics.kernel_evaluations, truth.kernel_evaluations) << where;
      }
      const double rms = compare_images(image, expected, truth.faint).rms;
      mean_squares_ += rms * rms * static_cast<double>(expected.num_pixels());
    }
  }

  /// Over all pixels, the unstable ones included, but not the faint ones.
  double rms() const {
    const auto pictures = static_cast<double>(all_ways().size());
    return std::sqrt(mean_squares_ / (pictures * static_cast<double>(pixels_)));
  }
  double unstable_share() const {
    return static_cast<double>(unstable_) / static_cast<double>(pixels_);
  }

 private:
  std::size_t unstable_ = 0, pixels_ = 0;
  double mean_squares_ = 0;
};

/// Scenes are compared in blocks, one a test, so that they run side by side.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int seeds_per_block = 8;  // what there is to be found is the same in all
#else
constexpr int seeds_per_block = 25;
#endif
constexpr int num_blocks = 8;

/// A scene of one field: radius 1, weight 1, sigma 2; seen along -z from a distance, unlit, 24 x 20
/// pixels.
struct PlainScene {
  ParticleSet particles;
  ResolvedScene scene;
};

inline TransferFunction ramp(double high, double extinction) {
  return {{{.value = 0, .color = {0.1F, 0.2F, 1}, .extinction = 0},
           {.value = high, .color = {1, 0.8F, 0.3F}, .extinction = extinction}},
          false};
}

inline PlainScene plain_scene(const std::vector<Point3d>& centers, double distance) {
  PlainScene s;
  s.particles = particles_at(centers);
  s.scene.fields = {field_of_all(s.particles, 1, 1, {})};
  s.scene.transfer_functions = {ramp(1, 1)};
  s.scene.camera.eye = {0, 0, distance};
  s.scene.camera.target = {0, 0, 0};
  s.scene.step_size = 0.5;
  s.scene.render.width = 24;
  s.scene.render.height = 20;
  s.scene.render.lighting.enabled = false;
  return s;
}

inline void check(const PlainScene& s, const std::string& description) {
  Comparison comparison;
  comparison.check(s.particles, s.scene, description);
  EXPECT_LT(comparison.unstable_share(), 0.5);
}

}  // namespace motes
