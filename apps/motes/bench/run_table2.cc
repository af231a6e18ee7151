// motes bench table2: frames per second of all engines in every scene, far and close.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "motes/bench/chart.h"
#include "motes/bench/grids.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

/// Sweep and coherent, with or without lighting.
struct Pair {
  FrameTimes sweep, coherent;
  double ratio() const { return coherent.median_ms / sweep.median_ms; }
  /// What the ratio would be if the sweep found and summed its kernels in no time: what is left,
  /// setting up rays and integrating samples, is the same code for both.
  double bound() const {
    const StageTicks& stages = sweep.stages;
    return ratio() / (stages.fraction(Stage::setup) + stages.fraction(Stage::integrate));
  }
};

/// What is measured of one scene from one camera.
struct Row {
  const BenchScene* scene;
  bool close;
  Camera camera;
  Pair lit, unlit;
  std::optional<FrameTimes> direct, cells;  ///< lit
  std::optional<FrameTimes> structured;     ///< lit, from grids
  std::size_t structured_bytes = 0;

  std::string_view view() const { return close ? "close" : "far"; }
  /// How many times longer the sweep takes with lighting.
  double lit_over_unlit() const { return lit.sweep.median_ms / unlit.sweep.median_ms; }
  /// How many times faster the sweep is than grids are drawn. Precondition: these were.
  double over_structured() const { return structured->median_ms / lit.sweep.median_ms; }
  std::optional<double> paper_fps(const std::optional<FarClose>& fps) const {
    if (!fps) return std::nullopt;
    return close ? fps->close : fps->far;
  }
};

/// Of frames of the slow ways that take longer, one is enough.
constexpr double patience_ms = 2000;

/// A renderer of grids of the scene's fields, of voxels of 1, as the paper has them; nothing where
/// there is not memory enough for them and the copies that are sampled.
std::optional<Renderer> make_structured(const BenchJob& job, const PreparedScene& prepared) {
  const KernelSet& kernels = prepared.renderer.kernels();
  const Lattice lattice = lattice_of_size(kernels.box(), 1);
  const double bytes = 2 * sample_bytes(lattice, kernels.fields.size());
  if (bytes > static_cast<double>(job.workplace.memory())) return std::nullopt;
  return make_grid_renderer(resample_all(kernels, lattice), Reconstruction::trilinear);
}

/// Measures the engines that are slower by far: a single frame where it takes long.
void measure_slow_engines(const BenchJob& job, const Variant& lit, PreparedScene& prepared,
                          Row& row, Console& console) {
  for (const auto& [engine, times] :
       {std::pair{Engine::direct, &row.direct}, {Engine::cells, &row.cells}}) {
    Variant variant = lit;
    variant.patience_ms = patience_ms;
    variant.scene.render.engine = engine;
    prepared.renderer.prepare(engine);
    *times = measure_frames({variant}, job.options, console)[0];
  }
}

Row measure_row(const BenchJob& job, const BenchScene& entry, PreparedScene& prepared,
                const std::optional<Renderer>& structured, bool close, Console& console) {
  ResolvedScene scene = prepared.resolved;
  if (close) scene.camera = moved_closer(scene.camera, entry.close);
  std::vector<Variant> variants;
  for (const bool lit : {true, false}) {
    scene.render.lighting.enabled = lit;
    for (Variant& variant : engine_variants(prepared.renderer, scene)) {
      variants.push_back(std::move(variant));
    }
  }
  const std::vector<FrameTimes> times = measure_frames(variants, job.options, console);
  Row row{&entry, close, scene.camera, {times[0], times[1]}, {times[2], times[3]}, std::nullopt, {},
          {},     0};
  if (structured) {
    row.structured_bytes = grid_bytes(*structured);
    Variant variant{&*structured, variants[0].scene};
    variant.patience_ms = patience_ms;
    row.structured = measure_frames({variant}, job.options, console)[0];
  }
  measure_slow_engines(job, variants[0], prepared, row, console);
  return row;
}

std::string or_dash(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

void print_header() {
  constexpr const char* format =
      "{:<16}{:<6}{:>10}{:>8}{:>8}  |{:>8}{:>10}{:>8}{:>8}{:>8}{:>7}{:>8}{:>8}  |{:>8}{:>10}{:>8}"
      "{:>7}{:>7}  |{:>7}{:>7}{:>8}{:>7}\n";
  fmt::print(format, "", "", "", "mean", "samples", "lit,", "frames a", "second", "", "sweep/",
             "at", "coher./", "coher./", "unlit,", "the same", "sweep/", "at", "lit/", "paper:", "",
             "", "sweep/");
  fmt::print(format, "scene", "view", "particles", "opacity", "a ray", "sweep", "coherent",
             "direct", "cells", "coher.", "most", "direct", "cells", "sweep", "coherent", "coher.",
             "most", "unlit", "MIC", "CPU", "Nanovol", "CPU");
}

void print(const Row& row) {
  const auto cpu = row.paper_fps(row.scene->paper.cpu), mic = row.paper_fps(row.scene->paper.mic);
  std::optional<double> direct, over_direct, cells, over_cells, over_paper;
  if (row.direct) {
    direct = row.direct->fps();
    over_direct = row.direct->median_ms / row.lit.coherent.median_ms;
  }
  if (row.cells) {
    cells = row.cells->fps();
    over_cells = row.cells->median_ms / row.lit.coherent.median_ms;
  }
  if (cpu) over_paper = row.lit.sweep.fps() / *cpu;
  fmt::print(
      "{:<16}{:<6}{:>10}{:>8.2f}{:>8.1f}  |{:>8.2f}{:>10.2f}{:>8}{:>8}{:>8.2f}{:>7.1f}{:>8}{:>8}  "
      "|",
      row.scene->name, row.view(), row.scene->particles, row.lit.sweep.opacity,
      row.lit.sweep.samples_per_ray, row.lit.sweep.fps(), row.lit.coherent.fps(), or_dash(direct),
      or_dash(cells), row.lit.ratio(), row.lit.bound(), or_dash(over_direct), or_dash(over_cells));
  fmt::print("{:>8.2f}{:>10.2f}{:>8.2f}{:>7.1f}{:>7.2f}  |{:>7}{:>7}{:>8}{:>7}\n",
             row.unlit.sweep.fps(), row.unlit.coherent.fps(), row.unlit.ratio(), row.unlit.bound(),
             row.lit_over_unlit(), or_dash(mic), or_dash(cpu),
             or_dash(row.paper_fps(row.scene->paper.nanovol)), or_dash(over_paper));
  std::fflush(stdout);
}

/// The second table, of grids.
void print_structured(const std::vector<Row>& rows) {
  constexpr const char* format = "{:<16}{:<6}{:>10}{:>10}{:>10}  |{:>9}{:>9}{:>9}{:>9}{:>9}\n";
  fmt::print("\nStructured: grids of the same fields, trilinear, voxels of 1, lit\n");
  fmt::print(format, "", "", "memory,", "frames", "sweep/", "paper:", "", "", "", "RBF/");
  fmt::print(format, "scene", "view", "MB", "a second", "struct.", "MIC", "CPU", "Nanovol",
             "CPU, RBF", "struct.");
  for (const Row& row : rows) {
    const auto cpu = row.paper_fps(row.scene->paper.structured_cpu);
    const auto mic = row.paper_fps(row.scene->paper.structured_mic);
    const auto rbf = row.paper_fps(row.scene->paper.cpu);
    std::optional<double> fps, megabytes, over, paper_over;
    if (row.structured) {
      fps = row.structured->fps();
      megabytes = static_cast<double>(row.structured_bytes) / 1e6;
      over = row.over_structured();
    }
    if (cpu && rbf) paper_over = *rbf / *cpu;
    fmt::print(format, row.scene->name, row.view(), or_dash(megabytes), or_dash(fps), or_dash(over),
               or_dash(mic), or_dash(cpu),
               or_dash(row.paper_fps(row.scene->paper.structured_nanovol)), or_dash(rbf),
               or_dash(paper_over));
  }
}

nlohmann::ordered_json to_json(const Pair& pair) {
  return {{"sweep", to_json(pair.sweep)},
          {"coherent", to_json(pair.coherent)},
          {"coherent_over_sweep", pair.ratio()},
          {"coherent_over_sweep_at_most", pair.bound()}};
}

nlohmann::ordered_json to_json(const Row& row, const BenchJob& job, const PreparedScene& prepared) {
  const auto triple = [](const auto& v) { return nlohmann::json{v.x, v.y, v.z}; };
  nlohmann::ordered_json out = describe_view(job, *row.scene, row.view());
  out.update({{"particles", prepared.renderer.kernels().size()},
              {"fields", prepared.renderer.kernels().fields.size()},
              {"eye", triple(row.camera.eye)},
              {"target", triple(row.camera.target)},
              {"step_size", prepared.resolved.step_size},
              {"mean_opacity", row.lit.sweep.opacity},
              {"samples_per_ray", row.lit.sweep.samples_per_ray},
              {"lit", to_json(row.lit)},
              {"direct", nullptr},
              {"cells", nullptr},
              {"structured", nullptr},
              {"structured_bytes", row.structured_bytes},
              {"unlit", to_json(row.unlit)},
              {"lit_over_unlit", row.lit_over_unlit()},
              {"paper_cpu_fps", nullptr},
              {"paper_mic_fps", nullptr},
              {"paper_nanovol_fps", nullptr},
              {"paper_structured_cpu_fps", nullptr},
              {"paper_structured_mic_fps", nullptr},
              {"paper_structured_nanovol_fps", nullptr}});
  if (row.direct) out["direct"] = to_json(*row.direct);
  if (row.cells) out["cells"] = to_json(*row.cells);
  if (row.structured) out["structured"] = to_json(*row.structured);
  const PaperFigures& paper = row.scene->paper;
  for (const auto& [key, figures] : {std::pair{"paper_cpu_fps", paper.cpu},
                                     {"paper_mic_fps", paper.mic},
                                     {"paper_nanovol_fps", paper.nanovol},
                                     {"paper_structured_cpu_fps", paper.structured_cpu},
                                     {"paper_structured_mic_fps", paper.structured_mic},
                                     {"paper_structured_nanovol_fps", paper.structured_nanovol}}) {
    if (const auto fps = row.paper_fps(figures)) out[key] = *fps;
  }
  return out;
}

void add_to_chart(const Row& row, BarChart& chart) {
  chart.categories.push_back(fmt::format("{} {}", row.scene->name, row.view()));
  const std::optional<double> values[] = {
      row.lit.sweep.fps(),
      row.lit.coherent.fps(),
      row.unlit.sweep.fps(),
      row.unlit.coherent.fps(),
      row.direct ? std::optional<double>(row.direct->fps()) : std::nullopt,
      row.cells ? std::optional<double>(row.cells->fps()) : std::nullopt,
      row.structured ? std::optional<double>(row.structured->fps()) : std::nullopt,
      row.paper_fps(row.scene->paper.cpu)};
  for (std::size_t s = 0; s < std::size(values); ++s) chart.series[s].values.push_back(values[s]);
}

/// Prints a ratio of all rows, which is what the results say of it too.
template <class Ratio>
nlohmann::ordered_json summarise(std::string_view name, const std::vector<Row>& rows,
                                 const Ratio& ratio_of) {
  std::vector<double> ratios;
  std::ranges::transform(rows, std::back_inserter(ratios), ratio_of);
  const double mean = geometric_mean(ratios);
  const auto [least, most] = std::ranges::minmax(ratios);
  fmt::print("{}: {:.2f} in the geometric mean, {:.2f} to {:.2f}\n", name, mean, least, most);
  return {{"geometric_mean", mean}, {"least", least}, {"most", most}};
}

}  // namespace

void run_table2(const BenchJob& job) {
  job.workplace.check_room(job.scenes);
  fmt::print("{}\n\n", describe_measurement(job.options));
  print_header();
  std::vector<Row> rows;
  nlohmann::ordered_json results = nlohmann::json::array();
  BarChart chart{"Frames per second",
                 "frames per second",
                 {},
                 {{"sweep, lit", {}},
                  {"coherent, lit", {}},
                  {"sweep, unlit", {}},
                  {"coherent, unlit", {}},
                  {"direct, lit", {}},
                  {"cells, lit", {}},
                  {"structured, lit", {}},
                  {"paper, 16 cores", {}}}};
  for (const BenchScene* entry : job.scenes) {
    Console console;
    PreparedScene prepared = prepare_bench_scene(job, *entry, console);
    const std::optional<Renderer> structured = make_structured(job, prepared);
    for (const bool close : {false, true}) {
      rows.push_back(measure_row(job, *entry, prepared, structured, close, console));
      print(rows.back());
      results.push_back(to_json(rows.back(), job, prepared));
      add_to_chart(rows.back(), chart);
    }
  }
  print_structured(rows);
  fmt::print("\n");
  nlohmann::ordered_json summary;
  summary["coherent_over_sweep_lit"] =
      summarise("sweep / coherent, lit", rows, [](const Row& row) { return row.lit.ratio(); });
  summary["coherent_over_sweep_unlit"] =
      summarise("sweep / coherent, unlit", rows, [](const Row& row) { return row.unlit.ratio(); });
  summary["at_most_lit"] =
      summarise("the same at most, lit", rows, [](const Row& row) { return row.lit.bound(); });
  summary["at_most_unlit"] =
      summarise("the same at most, unlit", rows, [](const Row& row) { return row.unlit.bound(); });
  summary["lit_over_unlit"] = summarise("lit / unlit, time of the sweep", rows,
                                        [](const Row& row) { return row.lit_over_unlit(); });
  write_results(job, "table2", results, summary);
  write_result_file(job, "table2.svg", to_svg(chart));
}

}  // namespace motes
