// Frame times on a jittered lattice: the scene of docs/performance.md, "The paper's algorithm".
//
//   build/release/bench/bench_lattice [particles an axis, default 45] [engine:
//   coherent|one-pass|direct|sweep] [repeat]
//
// Cubic lattice, spacing 2.475, jittered uniformly by +-0.6; a third with radius 1.11, the rest
// 0.66; weight 1, sigma 2, step 0.5, 1024 x 1024, field of view 45; extinction 0 at values <= 0.2
// rising linearly to T at 1.2; no lighting.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace {

using namespace motes;

constexpr double spacing = 2.475;

ParticleSet make_lattice(int n) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.6, 0.6);
  std::vector<double> x, y, z;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        x.push_back((i + 0.5) * spacing + jitter(random));
        y.push_back((j + 0.5) * spacing + jitter(random));
        z.push_back((k + 0.5) * spacing + jitter(random));
      }
    }
  }
  ParticleSet particles;
  set_positions(particles, x, y, z);
  return particles;
}

FieldSource make_field(std::size_t n) {
  FieldSource field;
  field.name = "lattice";
  for (std::size_t i = 0; i < n; ++i) {
    field.index.push_back(static_cast<std::uint32_t>(i));
    field.radius.push_back(i % 3 == 0 ? 1.11f : 0.66f);
  }
  field.weight = {1.0f};
  return field;
}

ResolvedScene make_scene(int n, double distance, double extinction) {
  ResolvedScene scene;
  const double size = n * spacing;
  const Point3d center{size / 2, size / 2, size / 2};
  const Vector3d towards = normalize(Vector3d{0.4, 0.3, -1});
  scene.camera.eye = center + distance * size * towards;
  scene.camera.target = center;
  scene.step_size = 0.5;
  scene.render.lighting.enabled = false;
  scene.transfer_functions.push_back(
      {{{0.2, {0, 0, 0.2f}, 0}, {1.2, {1, 0.6f, 0.1f}, extinction}}, false});
  return scene;
}

}  // namespace

int main(int argc, char** argv) {
  const int n = argc > 1 ? std::atoi(argv[1]) : 45;
  const std::string engine = argc > 2 ? argv[2] : "coherent";
  const int repeat = argc > 3 ? std::atoi(argv[3]) : 5;
  const ParticleSet particles = make_lattice(n);
  const Renderer renderer(particles, {make_field(particles.size())});
  fmt::print("{} particles, build {:.0f} ms, {}, {}\n", particles.size(), renderer.build_ms(),
             engine, "1024x1024");
  fmt::print("{:>6} {:>6} {:>10} {:>10} {:>14} {:>14}\n", "T", "view", "median ms", "min ms",
             "samples", "evaluations");
  for (const double extinction : {2.0, 0.05}) {
    for (const double distance : {1.9, 0.75}) {
      ResolvedScene scene = make_scene(n, distance, extinction);
      scene.render.engine = engine == "direct"  ? Engine::direct
                            : engine == "sweep" ? Engine::sweep
                                                : Engine::coherent;
      RenderOptions options;
      if (engine == "one-pass") options.samples_per_pass = 0;
      std::vector<double> times;
      RenderStatistics statistics;
      Framebuffer image;
      for (int i = 0; i <= repeat; ++i) {
        renderer.render(scene, options, image, &statistics);
        if (i > 0) times.push_back(statistics.frame_ms);
      }
      std::sort(times.begin(), times.end());
      fmt::print("{:>6} {:>6} {:>10.1f} {:>10.1f} {:>14} {:>14}\n", extinction,
                 distance > 1 ? "far" : "close", times[times.size() / 2], times.front(),
                 statistics.samples, statistics.kernel_evaluations);
    }
  }
  return 0;
}
