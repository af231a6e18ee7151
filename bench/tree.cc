// The tree: time and memory of its build (docs/performance.md, "The tree").
//
//   build/release/bench/bench_tree [millions of particles, default 5] [lattice|random|clusters]
//
// Particles of radius half their mean spacing: a jittered lattice in the order of its rows, uniform
// at random, or half of them in Gaussian clusters of very different sizes.
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>

#include "core/stopwatch.h"
#include "field/kernel_set.h"

namespace {

using namespace motes;

/// Of this process and both its threads.
double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// "VmRSS" or its peak "VmHWM", bytes.
double resident_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0;
    if (word == key + ":" && status >> kilobytes) return 1024 * kilobytes;
  }
  return 0;
}

void reset_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;
}

ParticleSet make_particles(std::size_t n, const std::string& kind) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1);
  std::normal_distribution<float> normal;
  const double side = std::ceil(std::cbrt(static_cast<double>(n)));
  const auto row = static_cast<std::size_t>(side);
  ParticleSet particles;
  for (auto* a : {&particles.x, &particles.y, &particles.z}) a->resize(n);
  float cluster[4] = {};
  for (std::size_t i = 0; i < n; ++i) {
    if (kind == "clusters" && i % 4096 == 0) {
      for (int k = 0; k < 3; ++k) cluster[k] = unit(random);
      cluster[3] = 0.03f * std::pow(10.0f, -3 * unit(random));
    }
    const std::size_t cell[3] = {i / row / row, i / row % row, i % row};
    float* const out[3] = {&particles.x[i], &particles.y[i], &particles.z[i]};
    for (int k = 0; k < 3; ++k) {
      if (kind == "lattice") {
        *out[k] = (static_cast<float>(cell[k]) + 0.5f * unit(random)) / static_cast<float>(side);
      } else if (kind == "clusters" && i % 2 == 0) {
        *out[k] = cluster[k] + cluster[3] * normal(random);
      } else {
        *out[k] = unit(random);
      }
    }
  }
  return particles;
}

FieldSource make_field(std::size_t n) {
  FieldSource field;
  field.name = "all";
  field.index.resize(n);
  for (std::size_t i = 0; i < n; ++i) field.index[i] = static_cast<std::uint32_t>(i);
  field.radius = {0.5f / std::cbrt(static_cast<float>(n))};
  field.weight = {1.0f};
  return field;
}

/// Sum of the leaves' half perimeters, in units of those of cubes that share out the data's box.
double leaf_extent(const KernelSet& kernels) {
  double sum = 0;
  for (std::size_t i = kernels.bvh.level_begin.back(); i < kernels.bvh.nodes.size(); ++i) {
    const Bvh::Node& node = kernels.bvh.nodes[i];
    for (std::size_t c = 0; c < Bvh::width; ++c) {
      if (node.min_x[c] > node.max_x[c]) continue;
      sum += node.max_x[c] - node.min_x[c] + node.max_y[c] - node.min_y[c] + node.max_z[c] -
             node.min_z[c];
    }
  }
  return sum / (3 * std::pow(static_cast<double>(kernels.bvh.num_leaves()), 2.0 / 3.0));
}

}  // namespace

int main(int argc, char** argv) {
  const double millions = argc > 1 ? std::atof(argv[1]) : 5;
  const std::string kind = argc > 2 ? argv[2] : "random";
  const auto n = static_cast<std::size_t>(1e6 * millions);
  const ParticleSet particles = make_particles(n, kind);
  const std::vector<FieldSource> fields = {make_field(n)};
  for (int repeat = 0; repeat < 3; ++repeat) {
    reset_peak();
    const double before = resident_bytes("VmRSS");
    const double cpu = cpu_seconds();
    const Stopwatch stopwatch;
    KernelOrder order;
    KernelSet kernels = build_kernel_set(particles, fields, &order);
    const double ms = stopwatch.milliseconds();
    const double size = static_cast<double>(kernels.particle_bytes() + kernels.bvh.bytes());
    const auto per_particle = [n](double bytes) { return bytes / static_cast<double>(n); };
    fmt::print(
        "{:.1f} million, {}: {:.0f} ms, {:.0f} ns of processor time a particle; {:.1f} bytes a "
        "particle, peak {:.1f}; leaf extent {:.3f}\n",
        millions, kind, ms, per_particle(1e9 * (cpu_seconds() - cpu)), per_particle(size),
        per_particle(resident_bytes("VmHWM") - before), leaf_extent(kernels));
    const double cpu_built = cpu_seconds();
    const Stopwatch refit;
    const bool kept = refit_kernel_set(particles, fields, order, kernels);
    fmt::print("{}: {:.0f} ms, {:.1f} ns of processor time a particle\n",
               kept ? "refit" : "not refit", refit.milliseconds(),
               per_particle(1e9 * (cpu_seconds() - cpu_built)));
  }
  return 0;
}
