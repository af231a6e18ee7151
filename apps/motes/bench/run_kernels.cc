// motes bench kernels: what kernels of other shapes cost beside Gaussians of the same supports.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "motes/bench/chart.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

/// Bytes a particle, with the kernels and the tree of each shape. Measured: 265.
constexpr std::size_t bytes_per_particle = 320;

struct Shape {
  std::string_view name;
  KernelType type;
  int table_steps = 0;
  double noise = 0;  ///< standard deviation of a table's values, over these
};

/// The Gaussian first. Noise makes a table one of measured values, which no smooth curve stands
/// for.
constexpr Shape shapes[] = {{"gaussian", KernelType::gaussian},
                            {"cubic_spline", KernelType::cubic_spline},
                            {"quintic_spline", KernelType::quintic_spline},
                            {"wendland_c2", KernelType::wendland_c2},
                            {"wendland_c4", KernelType::wendland_c4},
                            {"wendland_c6", KernelType::wendland_c6},
                            {"table of 256", KernelType::tabulated, 256},
                            {"noisy of 32", KernelType::tabulated, 32, 0.01},
                            {"noisy of 256", KernelType::tabulated, 256, 0.01}};

/// `gaussian` in another shape; as a table, its own curve, or that with noise.
Kernel in_shape(const Kernel& gaussian, const Shape& shape) {
  Kernel kernel = gaussian;
  kernel.shape.type = shape.type;
  if (shape.type != KernelType::tabulated) return kernel;
  kernel.shape.profile.spacing = gaussian.support_factor / shape.table_steps;
  std::mt19937 random(1);
  for (int i = 0; i <= shape.table_steps; ++i) {
    // Twelve even numbers have the standard deviation 1, and are the same with every library.
    double deviation = -6;
    for (int k = 0; k < 12; ++k) deviation += random() * 0x1p-32;
    const double value = evaluate(gaussian, i * kernel.shape.profile.spacing).value;
    kernel.shape.profile.values.push_back(value * (1 + shape.noise * deviation));
  }
  return kernel;
}

/// `source`, of Gaussians, with kernels of another shape that end at the same distances and have
/// the same integrals.
FieldSource with_shape(FieldSource source, const Shape& shape) {
  const Kernel gaussian = source.kernel;
  source.kernel = in_shape(gaussian, shape);
  const double narrower = gaussian.support() / source.kernel.support();
  const double higher = gaussian.integral() / source.kernel.integral() / std::pow(narrower, 3);
  for (float& radius : source.radius) radius = static_cast<float>(radius * narrower);
  for (float& weight : source.weight) weight = static_cast<float>(weight * higher);
  return source;
}

struct Row {
  const BenchScene* scene;
  bool close;
  std::string_view kernel;
  FrameTimes lit, unlit;
  double lit_ratio, unlit_ratio;  ///< to the Gaussian's time

  std::string_view view() const { return close ? "close" : "far"; }
};

/// One scene in all shapes.
struct SceneInShapes {
  ResolvedScene scene;
  std::deque<Renderer> renderers;  ///< one a shape
};

SceneInShapes make_shapes(const BenchJob& job, const BenchScene& entry, Console& console) {
  const Input input = read_bench_particles(job, entry, console);
  const PreparedScene prepared = prepare_bench_scene(job, entry, input, console);
  const auto sources =
      make_field_sources(input.particles, expand_fields(prepared.filled_in, input.particles),
                         prepared.filled_in.kernel, console.warnings(), &console);
  SceneInShapes all{prepared.resolved, {}};
  // No ray ends before the volume does: all shapes are sampled at the same places.
  all.scene.render.termination_opacity = 1;
  all.scene.render.engine = Engine::sweep;
  for (const Shape& shape : shapes) {
    std::vector<FieldSource> fields;
    std::ranges::transform(sources, std::back_inserter(fields),
                           [&](const FieldSource& source) { return with_shape(source, shape); });
    all.renderers.emplace_back(input.particles, fields);
  }
  return all;
}

std::vector<Row> measure_rows(const BenchJob& job, const BenchScene& entry,
                              const SceneInShapes& all, bool close, Console& console) {
  std::vector<Variant> variants;
  for (const bool lit : {true, false}) {
    for (const Renderer& renderer : all.renderers) {
      variants.push_back({&renderer, all.scene});
      variants.back().scene.render.lighting.enabled = lit;
      if (close) variants.back().scene.camera = moved_closer(all.scene.camera, entry.close);
    }
  }
  const std::vector<FrameTimes> times = measure_frames(variants, job.options, console);
  constexpr std::size_t n = std::size(shapes);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < n; ++i) {
    rows.push_back({&entry, close, shapes[i].name, times[i], times[n + i],
                    times[i].median_ms / times[0].median_ms,
                    times[n + i].median_ms / times[n].median_ms});
  }
  return rows;
}

void print(const Row& row) {
  fmt::print("{:<16}{:<6}{:<16}{:>9.1f}  |{:>10.1f}{:>10.2f}  |{:>10.1f}{:>10.2f}\n",
             row.scene->name, row.view(), row.kernel, row.lit.samples_per_ray, row.lit.median_ms,
             row.lit_ratio, row.unlit.median_ms, row.unlit_ratio);
  std::fflush(stdout);
}

nlohmann::ordered_json to_json(const Row& row, const BenchJob& job) {
  nlohmann::ordered_json out = describe_view(job, *row.scene, row.view());
  out.update({{"kernel", row.kernel},
              {"lit", to_json(row.lit)},
              {"unlit", to_json(row.unlit)},
              {"lit_over_gaussian", row.lit_ratio},
              {"unlit_over_gaussian", row.unlit_ratio}});
  return out;
}

}  // namespace

void run_kernels(const BenchJob& job) {
  job.workplace.check_room(job.scenes, bytes_per_particle);
  fmt::print("{}\n\n{:<38}{:>9}  |{:>20}  |{:>20}\n", describe_measurement(job.options), "",
             "samples", "lit: ms   over the", "unlit: ms   over the");
  fmt::print("{:<16}{:<6}{:<16}{:>9}  |{:>10}{:>10}  |{:>10}{:>10}\n", "scene", "view", "kernel",
             "a ray", "a frame", "Gaussian", "a frame", "Gaussian");
  nlohmann::ordered_json results = nlohmann::json::array();
  BarChart chart{"Frames with kernels of other shapes",
                 "% of the time with Gaussians",
                 {},
                 {{"lit", {}}, {"unlit", {}}},
                 false};
  double most = 0;
  for (const BenchScene* entry : job.scenes) {
    Console console;
    const SceneInShapes all = make_shapes(job, *entry, console);
    for (const bool close : {false, true}) {
      for (const Row& row : measure_rows(job, *entry, all, close, console)) {
        print(row);
        results.push_back(to_json(row, job));
        chart.categories.push_back(fmt::format("{} {} {}", entry->name, row.view(), row.kernel));
        chart.series[0].values.emplace_back(100 * row.lit_ratio);
        chart.series[1].values.emplace_back(100 * row.unlit_ratio);
        most = std::max({most, row.lit_ratio, row.unlit_ratio});
      }
    }
  }
  fmt::print("\nat most {:.2f} times the Gaussian's time\n", most);
  write_results(job, "kernels", results, {{"most_over_gaussian", most}});
  write_result_file(job, "kernels.svg", to_svg(chart));
}

}  // namespace motes
