// motes bench fig6: the same data, more and more of it.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "motes/bench/chart.h"
#include "motes/bench/cut_out.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

/// A column of the paper's Figure 6: the sigma with which its image had converged, and frames per
/// second with sigma 2.05 and with that.
struct PaperSize {
  std::size_t particles;
  double sigma, fps_fixed, fps_converged;
};
constexpr PaperSize paper_sizes[] = {
    {1'000, 6.61, 10.1, 2.62},     {10'000, 5.44, 4.00, 2.10},     {100'000, 3.67, 2.48, 2.40},
    {1'000'000, 3.39, 3.82, 2.25}, {10'000'000, 2.74, 3.81, 2.22}, {82'000'000, 2.05, 2.12, 2.12}};
constexpr double fixed_sigma = 2.05;

/// One size with one sigma.
struct Row {
  std::size_t particles;
  double sigma, paper_fps;
  FrameTimes sweep, coherent;
};

Row measure_row(PreparedScene& prepared, double sigma, double paper_fps, const BenchJob& job,
                Console& console) {
  Renderer& renderer = prepared.renderer;
  for (std::size_t field = 0; field < renderer.kernels().fields.size(); ++field) {
    Kernel kernel = renderer.kernels().fields[field].kernel;
    kernel.support_factor = sigma;
    renderer.set_kernel(field, kernel);
  }
  std::vector<Variant> variants = engine_variants(renderer, prepared.resolved);
  for (Variant& variant : variants) variant.patience_ms = 5000;
  const std::vector<FrameTimes> times = measure_frames(variants, job.options, console);
  return {renderer.kernels().size(), sigma, paper_fps, times[0], times[1]};
}

void print(const Row& row) {
  fmt::print("{:>10}{:>7.2f}{:>9.2f}{:>9.1f}  |{:>9.2f}{:>10.2f}{:>8.2f}  |{:>10.2f}\n",
             row.particles, row.sigma, row.sweep.opacity, row.sweep.samples_per_ray,
             row.sweep.fps(), row.coherent.fps(), row.coherent.median_ms / row.sweep.median_ms,
             row.paper_fps);
  std::fflush(stdout);
}

nlohmann::ordered_json to_json(const Row& row) {
  return {{"particles", row.particles},
          {"support_factor", row.sigma},
          {"mean_opacity", row.sweep.opacity},
          {"samples_per_ray", row.sweep.samples_per_ray},
          {"sweep", to_json(row.sweep)},
          {"coherent", to_json(row.coherent)},
          {"coherent_over_sweep", row.coherent.median_ms / row.sweep.median_ms},
          {"paper_mic_fps", row.paper_fps}};
}

/// The numbers of particles to measure: the paper's, of which the last one is all that there are.
std::vector<std::size_t> sizes_of(std::size_t num_particles) {
  std::vector<std::size_t> sizes;
  for (const PaperSize& size : paper_sizes) {
    const bool last = size.particles >= num_particles || &size == std::end(paper_sizes) - 1;
    sizes.push_back(last ? num_particles : size.particles);
    if (last) break;
  }
  return sizes;
}

PreparedScene prepare_cut_out(const BenchJob& job, const BenchScene& entry,
                              const ParticleSet& particles, Console& console) {
  Scene scene = job.workplace.open(entry);
  scene.render.width = job.options.width;
  scene.render.height = job.options.height;
  scene.eye.reset();
  scene.target.reset();
  scene.up.reset();
  return prepare_scene(scene, particles, job.workplace.scene_file(entry), {}, console);
}

void run_scene(const BenchJob& job, const BenchScene& entry) {
  Console console;
  const ParticleSet particles = read_bench_particles(job, entry, console).particles;
  const std::vector<std::size_t> sizes = sizes_of(particles.size());
  const Point3d center = typical_center(particles, sizes);
  fmt::print("{}, {}\n\n", entry.name, describe_measurement(job.options));
  fmt::print("{:>10}{:>7}{:>9}{:>9}  |{:>9}{:>10}{:>8}  |{:>10}\n", "particles", "sigma", "opacity",
             "samples", "sweep", "coherent", "ratio", "paper, MIC");
  std::vector<Row> fixed, converged;
  nlohmann::ordered_json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const PaperSize& paper = paper_sizes[i];
    PreparedScene prepared =
        sizes[i] == particles.size()
            ? prepare_cut_out(job, entry, particles, console)
            : prepare_cut_out(job, entry, cut_out(particles, center, sizes[i]), console);
    fixed.push_back(measure_row(prepared, fixed_sigma, paper.fps_fixed, job, console));
    print(fixed.back());
    rows.push_back(to_json(fixed.back()));
    converged.push_back(fixed.back());
    if (paper.sigma == fixed_sigma) continue;
    converged.back() = measure_row(prepared, paper.sigma, paper.fps_converged, job, console);
    print(converged.back());
    rows.push_back(to_json(converged.back()));
  }
  const double slowest = std::ranges::max(converged, {}, [](const Row& row) {
                           return row.sweep.median_ms;
                         }).sweep.median_ms;
  fmt::print(
      "\nwith the paper's sigma the slowest size takes {:.2f} times as long as all particles\n",
      slowest / converged.back().sweep.median_ms);

  LineChart chart{
      "Frame rate and size of the data", "particles", "frames per second", true, true, {}};
  const auto add = [&chart](const std::string& name, const std::vector<Row>& of,
                            const auto& value) {
    chart.series.push_back({name, {}});
    for (const Row& row : of) {
      chart.series.back().points.emplace_back(static_cast<double>(row.particles), value(row));
    }
  };
  const auto sweep = [](const Row& row) { return row.sweep.fps(); };
  const auto coherent = [](const Row& row) { return row.coherent.fps(); };
  add("sweep, sigma 2.05", fixed, sweep);
  add("coherent, sigma 2.05", fixed, coherent);
  add("sweep, paper's sigma", converged, sweep);
  add("coherent, paper's sigma", converged, coherent);
  write_results(job, "fig6", rows);
  write_result_file(job, "fig6.svg", to_svg(chart));
}

}  // namespace

void run_fig6(const BenchJob& job) {
  job.workplace.check_room(job.scenes);
  run_scene(job, *job.scenes.back());
}

}  // namespace motes
