// Surfaces in the way of rays: every engine cuts its samples where the reference does.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "render/engine_check.h"
#include "render/renderer.h"
#include "support/random_scene.h"

namespace motes {
namespace {

using PixelLayers = std::vector<std::vector<reference::Layer>>;

/// Whether a pixel's ray is behind some clip plane at that depth.
bool cut_away(const ResolvedScene& scene, int pixel, double depth) {
  const int width = scene.render.width;
  const reference::CameraRay ray =
      reference::camera_ray(scene.camera, width, scene.render.height, pixel % width, pixel / width);
  const Vector3d x = ray.origin + depth * ray.direction - Point3d{};
  return std::any_of(scene.render.clip_planes.begin(), scene.render.clip_planes.end(),
                     [&](const ClipPlane& plane) {
                       return dot(plane.normal, x) > plane.distance * length(plane.normal);
                     });
}

/// Up to four layers a pixel, anywhere along the rays through the data, some in one place.
PixelLayers random_layers(const ResolvedScene& scene, const Bounds3d& box, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return (random() + 0.5) / 4294967296.0; };
  const double middle = length(box.center() - scene.camera.eye);
  const double size = length(box.diagonal());
  const int num_pixels = scene.render.width * scene.render.height;
  PixelLayers layers(static_cast<std::size_t>(num_pixels));
  for (auto& of_pixel : layers) {
    if (uniform() < 0.3) continue;
    const auto count = 1 + random() % 4;
    for (std::size_t i = 0; i < count; ++i) {
      of_pixel.push_back({.depth = std::max(0., middle + (uniform() - 0.5) * size),
                          .opacity = uniform() < 0.3 ? 1 : static_cast<float>(uniform()),
                          .red = static_cast<float>(uniform()),
                          .green = static_cast<float>(uniform()),
                          .blue = static_cast<float>(uniform())});
    }
    if (count > 1 && uniform() < 0.2) of_pixel[1].depth = of_pixel[0].depth;
    // Nothing is where clip planes cut it away.
    std::erase_if(of_pixel, [&](const reference::Layer& layer) {
      return cut_away(scene, static_cast<int>(&of_pixel - layers.data()), layer.depth);
    });
    std::stable_sort(of_pixel.begin(), of_pixel.end(),
                     [](const auto& a, const auto& b) { return a.depth < b.depth; });
  }
  return layers;
}

LayerSource source_of(const PixelLayers& layers, int width, double length_scale) {
  return [&layers, width, length_scale](const Tile& tile, TileLayers& out) {
    out.width = tile.width;
    out.begin = {0};
    out.layers.clear();
    for (int i = 0; i < tile.width * tile.height; ++i) {
      const int x = tile.x + i % tile.width, y = tile.y + i / tile.width;
      const int pixel = y * width + x;
      for (const reference::Layer& layer : layers[static_cast<std::size_t>(pixel)]) {
        out.layers.push_back({layer.depth * length_scale,
                              static_cast<float>(layer.opacity),
                              {static_cast<float>(layer.red), static_cast<float>(layer.green),
                               static_cast<float>(layer.blue)}});
      }
      out.begin.push_back(static_cast<std::uint32_t>(out.layers.size()));
    }
  };
}

class Layers : public testing::TestWithParam<int> {};

/// Scenes of 12 seeds.
void check_layers(int block, RandomScene (*draw_scene)(std::uint32_t)) {
  for (int i = 0; i < 12; ++i) {
    const auto seed = static_cast<std::uint32_t>(12 * block + i);
    const RandomScene random = draw_scene(seed);
    const Renderer renderer(random.particles, random.scene.fields);
    const Bounds3d box = volume_box(renderer.kernels(), renderer.grids());
    const PixelLayers layers = random_layers(random.scene, box, seed);
    const reference::Image truth = reference::render(random.particles, random.scene, layers);
    const Framebuffer expected = to_framebuffer(truth);
    const LayerSource source =
        source_of(layers, random.scene.render.width, renderer.kernels().length_scale);
    for (const Way& way : all_ways()) {
      const Framebuffer image = render_in(way, renderer, random.scene, 2, nullptr, source);
      const ImageDifference stable = compare_images(image, expected, truth.unstable);
      const std::string where = fmt::format("{}\n{}, worst at pixel ({}, {})", random.description,
                                            way.name(), stable.worst_x, stable.worst_y);
      EXPECT_LE(stable.max, 1e-3) << where;
      EXPECT_LE(stable.rms, 1e-4) << where;
    }
  }
}

TEST_P(Layers, CutTheSamplesOfEveryEngine) { check_layers(GetParam(), random_scene); }

TEST_P(Layers, CutTheSamplesOfGrids) { check_layers(GetParam(), random_grid_scene); }

INSTANTIATE_TEST_SUITE_P(Blocks, Layers, testing::Range(0, 6));

}  // namespace
}  // namespace motes
