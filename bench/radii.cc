// Radii that differ: what they cost (docs/performance.md, "The tree").
//
//   build/release/bench/bench_radii [engine: sweep|coherent] [repeat]
//
// A million particles uniform at random in a cube of side 1; sigma 2, step of half the mean
// spacing, 512 x 512, nearly transparent. Milliseconds are the processor's time of one thread.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace {

using namespace motes;

constexpr std::size_t num_particles = 1000000;
constexpr float spacing = 0.01f;

ParticleSet make_particles() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-0.5f, 0.5f);
  ParticleSet particles;
  for (auto* a : {&particles.x, &particles.y, &particles.z}) {
    for (std::size_t i = 0; i < num_particles; ++i) a->push_back(unit(random));
  }
  return particles;
}

/// Radii of kind "equal"; "log-uniform" over four orders of magnitude; or a number: so many large
/// ones, ten or three spacings, among small equal ones.
FieldSource make_field(const std::string& kind) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0, 1);
  FieldSource field;
  field.name = kind;
  for (std::size_t i = 0; i < num_particles; ++i) {
    field.index.push_back(static_cast<std::uint32_t>(i));
    field.radius.push_back(kind == "equal"         ? 0.5f * spacing
                           : kind == "log-uniform" ? 2 * spacing * std::pow(1e-4f, unit(random))
                                                   : 0.25f * spacing);
  }
  if (kind != "equal" && kind != "log-uniform") {
    const std::size_t huge = std::stoul(kind);
    for (std::size_t i = 0; i < huge; ++i) {
      field.radius[random() % num_particles] = huge > 1000 ? 3 * spacing : 10 * spacing;
    }
  }
  field.weight = {1.0f};
  return field;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string engine = argc > 1 ? argv[1] : "sweep";
  const int repeat = argc > 2 ? std::atoi(argv[2]) : 5;
  const ParticleSet particles = make_particles();
  fmt::print("{:>12} {:>10} {:>10} {:>10} {:>14} {:>10}\n", "radii", "build ms", "median ms",
             "min ms", "evaluations", "ns each");
  for (const std::string kind : {"equal", "log-uniform", "0", "10", "1000", "10000"}) {
    const Renderer renderer(particles, {make_field(kind)});
    ResolvedScene scene;
    scene.camera.eye = {0.4, 0.3, -1.7};
    scene.camera.target = {0, 0, 0};
    scene.step_size = 0.5 * spacing;
    scene.render.width = scene.render.height = 512;
    scene.render.lighting.enabled = false;
    scene.render.engine = engine == "sweep" ? Engine::sweep : Engine::coherent;
    scene.transfer_functions.push_back(
        {{{0.2, {0, 0, 0.2f}, 0}, {10, {1, 0.6f, 0.1f}, 0.5}}, false});
    std::vector<double> times;
    RenderStatistics statistics;
    Framebuffer image;
    RenderOptions options;
    options.threads = 1;
    for (int i = 0; i <= repeat; ++i) {
      const std::clock_t begin = std::clock();
      renderer.render(scene, options, image, &statistics);
      const auto ticks = static_cast<double>(std::clock() - begin);
      if (i > 0) times.push_back(1000 * ticks / CLOCKS_PER_SEC);
    }
    std::sort(times.begin(), times.end());
    fmt::print("{:>12} {:>10.0f} {:>10.1f} {:>10.1f} {:>14} {:>10.3f}\n", kind, renderer.build_ms(),
               times[times.size() / 2], times.front(), statistics.kernel_evaluations,
               1e6 * times.front() / static_cast<double>(statistics.kernel_evaluations));
  }
  return 0;
}
