// motes bench lattice: frame times on jittered lattices of equal particles everywhere, from 91
// thousand to 82 million, unlit, with rays that end early and with rays that go deep.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "motes/bench/chart.h"
#include "motes/bench/measure.h"
#include "motes/bench/random.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

/// n x n x n particles at distances of `spacing`, moved by up to `jitter` along each axis; every
/// third has the first radius, the others the second.
struct Lattice {
  std::size_t n;
  double spacing, jitter;
  float radius[2];
  double support_factor, step;
  std::vector<double> extinctions;  ///< a picture each

  std::size_t particles() const { return n * n * n; }
  double side() const { return static_cast<double>(n) * spacing; }
};

std::vector<Lattice> lattices(const BenchOptions& options) {
  // Particles of smaller pictures cover as many pixels.
  const auto scaled = [&](double n) {
    return static_cast<std::size_t>(std::max(std::round(n * options.height / 1024), 2.0));
  };
  std::vector<Lattice> all;
  for (const double n : {45, 90, 169}) {
    all.push_back({scaled(n), 2.475, 0.6, {1.11F, 0.66F}, 2, 0.5, {2, 0.05}});
  }
  all.push_back({scaled(434), 1, 0.24, {0.7F, 0.7F}, 2.05, 1, {0.05}});
  return all;
}

void check_room(const BenchJob& job, const Lattice& lattice) {
  // Positions of the particles and of the kernels, and the tree with what building it takes.
  constexpr std::size_t bytes_per_particle = 64;
  const std::size_t needed = lattice.particles() * bytes_per_particle;
  if (needed <= job.workplace.memory()) return;
  throw Error(fmt::format("lattice: {} particles need {:.1f} GiB of memory, and there are {:.1f}",
                          lattice.particles(), static_cast<double>(needed) / 0x1p30,
                          static_cast<double>(job.workplace.memory()) / 0x1p30));
}

ParticleSet make_particles(const Lattice& lattice) {
  const Random random(41);
  ParticleSet particles;
  std::vector<float>* const axes[] = {&particles.x, &particles.y, &particles.z};
  for (auto* axis : axes) axis->resize(lattice.particles());
  tbb::parallel_for(std::size_t{0}, lattice.particles(), [&](std::size_t i) {
    const std::size_t place[] = {i / (lattice.n * lattice.n), i / lattice.n % lattice.n,
                                 i % lattice.n};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double jitter = random.uniform(3 * i + axis, -lattice.jitter, lattice.jitter);
      (*axes[axis])[i] =
          static_cast<float>((static_cast<double>(place[axis]) + 0.5) * lattice.spacing + jitter);
    }
  });
  return particles;
}

FieldSource make_field(const Lattice& lattice) {
  FieldSource field;
  field.name = "lattice";
  field.kernel.support_factor = lattice.support_factor;
  field.index.resize(lattice.particles());
  tbb::parallel_for(std::size_t{0}, lattice.particles(),
                    [&](std::size_t i) { field.index[i] = static_cast<std::uint32_t>(i); });
  if (lattice.radius[0] == lattice.radius[1]) {
    field.radius = {lattice.radius[0]};
  } else {
    field.radius.resize(lattice.particles());
    for (std::size_t i = 0; i < lattice.particles(); ++i) {
      field.radius[i] = lattice.radius[i % 3 == 0 ? 0 : 1];
    }
  }
  field.weight = {1};
  return field;
}

/// From 1.9 sides away, which shows all of it, or 0.75: just before its face.
ResolvedScene make_scene(const Lattice& lattice, double distance, double extinction,
                         const BenchOptions& options) {
  const double side = lattice.side();
  const Point3d center{side / 2, side / 2, side / 2};
  ResolvedScene scene;
  scene.camera.eye = center + distance * side * normalize(Vector3d{0.4, 0.3, -1});
  scene.camera.target = center;
  scene.step_size = lattice.step;
  scene.render.width = options.width;
  scene.render.height = options.height;
  scene.render.lighting.enabled = false;
  scene.transfer_functions.push_back(
      {{{.value = 0.2, .color = {0, 0, 0.2F}, .extinction = 0},
        {.value = 1.2, .color = {1, 0.6F, 0.1F}, .extinction = extinction}},
       false});
  return scene;
}

struct Result {
  nlohmann::ordered_json rows = nlohmann::json::array();
  BarChart chart{"Jittered lattices, unlit", "ms a frame", {}, {{"sweep", {}}, {"coherent", {}}}};
  std::vector<double> ratios;
};

void measure(const BenchJob& job, const Lattice& lattice, Result& result, Console& console) {
  const ParticleSet particles = make_particles(lattice);
  const Renderer renderer(particles, {make_field(lattice)});
  for (const double extinction : lattice.extinctions) {
    for (const auto& [view, distance] : {std::pair{"far", 1.9}, std::pair{"close", 0.75}}) {
      const ResolvedScene scene = make_scene(lattice, distance, extinction, job.options);
      const std::vector<FrameTimes> times =
          measure_frames(engine_variants(renderer, scene), job.options, console);
      const double ratio = times[1].median_ms / times[0].median_ms;
      fmt::print("{:>10}{:>7}  {:<7}{:>9.1f}{:>10.1f}{:>10.1f}{:>8.2f}{:>14.2f}\n",
                 lattice.particles(), extinction, view, times[0].samples_per_ray,
                 times[0].median_ms, times[1].median_ms, ratio,
                 1e-6 * static_cast<double>(times[1].kernel_evaluations) / times[1].median_ms);
      std::fflush(stdout);
      result.rows.push_back({{"particles", lattice.particles()},
                             {"support_factor", lattice.support_factor},
                             {"step_size", lattice.step},
                             {"extinction", extinction},
                             {"view", view},
                             {"sweep", to_json(times[0])},
                             {"coherent", to_json(times[1])},
                             {"sweep_over_coherent", ratio}});
      result.chart.categories.push_back(
          fmt::format("{}, T {}, {}", lattice.particles(), extinction, view));
      result.chart.series[0].values.emplace_back(times[0].median_ms);
      result.chart.series[1].values.emplace_back(times[1].median_ms);
      result.ratios.push_back(ratio);
    }
  }
}

}  // namespace

void run_lattice(const BenchJob& job) {
  const std::vector<Lattice> all = lattices(job.options);
  for (const Lattice& lattice : all) check_room(job, lattice);
  fmt::print("{}\n\n", describe_measurement(job.options));
  fmt::print("{:>10}{:>7}  {:<7}{:>9}{:>10}{:>10}{:>8}{:>14}\n", "", "", "", "samples", "sweep",
             "coherent", "", "coherent,");
  fmt::print("{:>10}{:>7}  {:<7}{:>9}{:>10}{:>10}{:>8}{:>14}\n", "particles", "T", "view", "a ray",
             "ms", "ms", "ratio", "10^9 eval./s");
  Result result;
  Console console;
  for (const Lattice& lattice : all) measure(job, lattice, result, console);
  const double mean = geometric_mean(result.ratios);
  fmt::print("\nsweep / coherent: {:.2f} in the geometric mean\n", mean);
  write_results(job, "lattice", result.rows, {{"mean_sweep_over_coherent", mean}});
  write_result_file(job, "lattice.svg", to_svg(result.chart));
}

}  // namespace motes
