// Every engine, on every instruction set and any number of threads, makes the reference's picture.
// The tolerances are those of docs/field.md, "Samples".
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "image/compare.h"
#include "reference/render.h"
#include "render/render_tile.h"
#include "render/renderer.h"
#include "support/random_scene.h"

namespace motes {
namespace {

/// One way to make a picture.
struct Way {
  std::string instruction_set;
  Engine engine = Engine::coherent;
  std::optional<int> samples_per_pass;

  std::string name() const {
    return fmt::format("{} on {}, {} samples a pass",
                       engine == Engine::coherent ? "coherent" : "direct", instruction_set,
                       samples_per_pass ? std::to_string(*samples_per_pass) : "default");
  }
};

std::vector<Way> all_ways() {
  std::vector<Way> ways;
  for (const std::string& set : instruction_sets()) {
    for (const std::optional<int> samples_per_pass : {std::optional<int>{}, {0}, {7}}) {
      ways.push_back({set, Engine::coherent, samples_per_pass});
    }
    ways.push_back({set, Engine::direct, {}});
  }
  return ways;
}

Framebuffer render_in(const Way& way, const Renderer& renderer, ResolvedScene scene,
                      int threads = 2) {
  force_instruction_set(way.instruction_set);
  scene.render.engine = way.engine;
  RenderOptions options;
  options.threads = threads;
  options.samples_per_pass = way.samples_per_pass;
  Framebuffer image = renderer.render(scene, options);
  force_instruction_set("");
  return image;
}

Framebuffer to_framebuffer(const reference::Image& image) {
  Framebuffer framebuffer(image.width, image.height);
  std::transform(image.rgba.begin(), image.rgba.end(), framebuffer.rgba.begin(),
                 [](double v) { return static_cast<float>(v); });
  return framebuffer;
}

/// Squares of differences over many pictures.
struct Total {
  double sum_of_squares = 0;
  std::size_t pixels = 0;

  void add(const ImageDifference& difference) {
    sum_of_squares +=
        difference.rms * difference.rms * 4 * static_cast<double>(difference.compared);
    pixels += difference.compared;
  }
  double rms() const { return std::sqrt(sum_of_squares / (4 * static_cast<double>(pixels))); }
};

/// Scenes are compared in blocks, one a test, so that they run side by side.
constexpr int num_blocks = 8, seeds_per_block = 20;

class EngineSweep : public testing::TestWithParam<int> {
 protected:
  std::uint32_t first_seed() const {
    return static_cast<std::uint32_t>(GetParam() * seeds_per_block);
  }
};

TEST_P(EngineSweep, MakesThePictureOfTheReference) {
  Total all;
  std::size_t num_unstable = 0;
  for (std::uint32_t seed = first_seed(); seed < first_seed() + seeds_per_block; ++seed) {
    const RandomScene random = random_scene(seed);
    const reference::Image truth = reference::render(random.particles, random.scene);
    const Framebuffer expected = to_framebuffer(truth);
    const Renderer renderer(random.particles, random.scene.fields);
    num_unstable +=
        static_cast<std::size_t>(std::count(truth.unstable.begin(), truth.unstable.end(), 1));
    for (const Way& way : all_ways()) {
      const Framebuffer image = render_in(way, renderer, random.scene);
      ASSERT_EQ(image.width, expected.width);
      ASSERT_EQ(image.height, expected.height);
      const ImageDifference stable = compare_images(image, expected, truth.unstable);
      const std::string where = fmt::format("{}\n{}, worst at pixel ({}, {})", random.description,
                                            way.name(), stable.worst_x, stable.worst_y);
      EXPECT_LE(stable.max, 1e-3) << where;
      EXPECT_LE(stable.rms, 1e-4) << where;
      all.add(compare_images(image, expected));
    }
  }
  // In one small picture a single pixel that falls to the other side weighs much: over many it must
  // not.
  EXPECT_LT(all.rms(), 5e-4);
  const std::size_t pixels = all.pixels / all_ways().size();
  EXPECT_LT(static_cast<double>(num_unstable), 0.1 * static_cast<double>(pixels));
}

INSTANTIATE_TEST_SUITE_P(Blocks, EngineSweep, testing::Range(0, num_blocks));

}  // namespace
}  // namespace motes
