// motes bench table2: frames per second of all engines in every scene, far and close.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "motes/bench/chart.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

/// What is measured of one scene from one camera.
struct Row {
  const BenchScene* scene;
  bool close;
  Camera camera;
  FrameTimes sweep, coherent;
  std::optional<FrameTimes> direct;

  std::string_view view() const { return close ? "close" : "far"; }
  double ratio() const { return coherent.median_ms / sweep.median_ms; }
  std::optional<double> paper_fps(const std::optional<FarClose>& fps) const {
    if (!fps) return std::nullopt;
    return close ? fps->close : fps->far;
  }
};

Row measure_row(const BenchJob& job, const BenchScene& entry, const PreparedScene& prepared,
                bool close, Console& console) {
  ResolvedScene scene = prepared.resolved;
  if (close) scene.camera = moved_closer(scene.camera, entry.close);
  const std::vector<FrameTimes> times =
      measure_frames(engine_variants(prepared.renderer, scene), job.options, console);
  Row row{&entry, close, scene.camera, times[0], times[1], std::nullopt};
  // Direct takes about eight times as long as coherent.
  constexpr double patience_ms = 2000;
  if (row.coherent.median_ms <= patience_ms) {
    Variant direct{&prepared.renderer, scene, std::nullopt, patience_ms};
    direct.scene.render.engine = Engine::direct;
    row.direct = measure_frames({direct}, job.options, console)[0];
  }
  return row;
}

std::string or_dash(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

void print_header() {
  fmt::print("{:<16}{:<6}{:>10}{:>8}{:>8}  |{:>8}{:>10}{:>8}  |{:>7}{:>8}  |{:>7}{:>7}{:>7}\n", "",
             "", "", "mean", "samples", "frames", "a second", "", "sweep/", "coher./", "paper:", "",
             "sweep/");
  fmt::print("{:<16}{:<6}{:>10}{:>8}{:>8}  |{:>8}{:>10}{:>8}  |{:>7}{:>8}  |{:>7}{:>7}{:>7}\n",
             "scene", "view", "particles", "opacity", "a ray", "sweep", "coherent", "direct",
             "coher.", "direct", "MIC", "CPU", "CPU");
}

void print(const Row& row) {
  const auto cpu = row.paper_fps(row.scene->paper.cpu), mic = row.paper_fps(row.scene->paper.mic);
  std::optional<double> direct, over_direct, over_paper;
  if (row.direct) {
    direct = row.direct->fps();
    over_direct = row.direct->median_ms / row.coherent.median_ms;
  }
  if (cpu) over_paper = row.sweep.fps() / *cpu;
  fmt::print(
      "{:<16}{:<6}{:>10}{:>8.2f}{:>8.1f}  |{:>8.2f}{:>10.2f}{:>8}  |{:>7.2f}{:>8}  |{:>7}{:>7}{:>7}"
      "\n",
      row.scene->name, row.view(), row.scene->particles, row.sweep.opacity,
      row.sweep.samples_per_ray, row.sweep.fps(), row.coherent.fps(), or_dash(direct), row.ratio(),
      or_dash(over_direct), or_dash(mic), or_dash(cpu), or_dash(over_paper));
  std::fflush(stdout);
}

nlohmann::ordered_json to_json(const Row& row, const BenchJob& job, const PreparedScene& prepared) {
  const auto triple = [](const auto& v) { return nlohmann::json{v.x, v.y, v.z}; };
  nlohmann::ordered_json out{{"scene", row.scene->name},
                             {"view", row.view()},
                             {"scene_file", job.workplace.scene_file(*row.scene).string()},
                             {"data", job.workplace.particle_file(*row.scene).string()},
                             {"particles", prepared.renderer.kernels().size()},
                             {"fields", prepared.renderer.kernels().fields.size()},
                             {"eye", triple(row.camera.eye)},
                             {"target", triple(row.camera.target)},
                             {"step_size", prepared.resolved.step_size},
                             {"lighting", prepared.resolved.render.lighting.enabled},
                             {"mean_opacity", row.sweep.opacity},
                             {"samples_per_ray", row.sweep.samples_per_ray},
                             {"sweep", to_json(row.sweep)},
                             {"coherent", to_json(row.coherent)},
                             {"direct", nullptr},
                             {"coherent_over_sweep", row.ratio()},
                             {"paper_cpu_fps", nullptr},
                             {"paper_mic_fps", nullptr}};
  if (row.direct) out["direct"] = to_json(*row.direct);
  if (const auto fps = row.paper_fps(row.scene->paper.cpu)) out["paper_cpu_fps"] = *fps;
  if (const auto fps = row.paper_fps(row.scene->paper.mic)) out["paper_mic_fps"] = *fps;
  return out;
}

void add_to_chart(const Row& row, BarChart& chart) {
  chart.categories.push_back(fmt::format("{} {}", row.scene->name, row.view()));
  chart.series[0].values.emplace_back(row.sweep.fps());
  chart.series[1].values.emplace_back(row.coherent.fps());
  chart.series[2].values.push_back(row.direct ? std::optional<double>(row.direct->fps())
                                              : std::nullopt);
  chart.series[3].values.push_back(row.paper_fps(row.scene->paper.cpu));
}

}  // namespace

void run_table2(const BenchJob& job) {
  job.workplace.check_room(job.scenes);
  fmt::print("{}\n\n", describe_measurement(job.options));
  print_header();
  nlohmann::ordered_json rows = nlohmann::json::array();
  BarChart chart{"Frames per second",
                 "frames per second",
                 {},
                 {{"sweep", {}}, {"coherent", {}}, {"direct", {}}, {"paper, 16 cores", {}}}};
  std::vector<double> ratios;
  for (const BenchScene* entry : job.scenes) {
    Console console;
    const PreparedScene prepared = prepare_bench_scene(job, *entry, console);
    for (const bool close : {false, true}) {
      const Row row = measure_row(job, *entry, prepared, close, console);
      print(row);
      rows.push_back(to_json(row, job, prepared));
      add_to_chart(row, chart);
      ratios.push_back(row.ratio());
    }
  }
  fmt::print("\nsweep / coherent: {:.2f} in the geometric mean, {:.2f} at least\n",
             geometric_mean(ratios), *std::ranges::min_element(ratios));
  write_results(job, "table2", rows);
  write_result_file(job, "table2.svg", to_svg(chart));
}

}  // namespace motes
