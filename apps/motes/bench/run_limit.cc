// motes bench limit: what part of the machine's own peak the sweep reaches in every scene, and
// where the rest of the time goes.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "motes/bench/chart.h"
#include "motes/bench/measure.h"
#include "motes/bench/peak.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

/// The sweep of one scene from one camera, against the peak.
struct Row {
  const BenchScene* scene;
  bool close, lit;
  FrameTimes frame;
  double data_bytes;  ///< of kernels and tree
  const MachinePeak* peak;

  std::string_view view() const { return close ? "close" : "far"; }
  double lanes() const { return static_cast<double>(frame.kernel_evaluations); }
  /// Evaluations inside of a support; nullopt where the engine does not count them.
  std::optional<double> inside() const {
    if (frame.evaluations_inside == 0) return std::nullopt;
    return static_cast<double>(frame.evaluations_inside);
  }
  /// What part of the frame's time so many evaluations take at the peak.
  double of_frame(double evaluations) const {
    return evaluations / peak->evaluations(lit) / (1e-3 * frame.median_ms);
  }
  /// Ticks that all threads spend on a frame in one stage.
  double ticks(Stage stage) const {
    return static_cast<double>(frame.stages.ticks[static_cast<std::size_t>(stage)]) / frame.frames;
  }
  /// What part of the time of the stage that adds kernels they take at the peak.
  double of_sums(double evaluations) const {
    return evaluations * peak->ticks_each(lit) / ticks(Stage::sums);
  }
  /// Ticks of a thread for one of so many evaluations, all stages together.
  double ticks_each(double evaluations) const {
    double all = 0;
    for (const std::uint64_t t : frame.stages.ticks) all += static_cast<double>(t);
    return all / frame.frames / evaluations;
  }
  /// What part of the frame's time it takes to read the data once from memory.
  double of_reading() const { return data_bytes / peak->read / (1e-3 * frame.median_ms); }
};

Row measure_row(const BenchJob& job, const BenchScene& entry, const PreparedScene& prepared,
                bool close, const MachinePeak& peak, Console& console) {
  Variant variant{&prepared.renderer, prepared.resolved};
  variant.scene.render.engine = Engine::sweep;
  variant.count_inside = true;
  if (close) variant.scene.camera = moved_closer(variant.scene.camera, entry.close);
  const KernelSet& kernels = prepared.renderer.kernels();
  return {&entry,
          close,
          variant.scene.render.lighting.enabled,
          measure_frames({variant}, job.options, console)[0],
          static_cast<double>(kernels.particle_bytes() + kernels.bvh.bytes()),
          &peak};
}

void print(const MachinePeak& peak) {
  constexpr double billion = 1e9;
  fmt::print(
      "peak of {} threads: {:.2f} 10^9 kernel evaluations a second unlit, {:.2f} 10^9 lit\n"
      "({:.4f} and {:.4f} ticks of a thread for one; ticks are the time stamp's, {:.3f} GHz);\n"
      "memory: {:.1f} GB/s read, {:.1f} GB/s read and written by copying, arrays of {} MiB\n\n",
      peak.threads, peak.unlit / billion, peak.lit / billion, peak.ticks_each(false),
      peak.ticks_each(true), peak.ticks / billion, peak.read / billion, peak.copied / billion,
      peak.array_bytes >> 20U);
}

/// Stages as the table's head has room for them.
constexpr const char* short_names[num_stages] = {"setup", "trav.", "cull", "sums", "integr."};

void print_header() {
  fmt::print("{:<22}{:>8}  |{:>41}  |{:>15}  |{:>29}  |{:>14}  |{:>6}\n", "", "frame",
             "% of the time of all threads", "evaluations, M", "% of the peak: frame     sums",
             "ticks for one", "data");
  fmt::print("{:<16}{:<6}{:>8}  | ", "scene", "view", "ms");
  for (const char* name : short_names) fmt::print("{:>8}", name);
  fmt::print("  |{:>7}{:>8}  |{:>8}{:>7}{:>7}{:>7}  |{:>7}{:>7}  |{:>6}\n", "lanes", "inside",
             "inside", "lanes", "inside", "lanes", "lane", "inside", "once%");
}

/// `value` with `digits` behind the point, or a dash.
std::string or_dash(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

/// `value` of the evaluations inside, if they are counted.
std::optional<double> of_inside(const Row& row, double (Row::*value)(double) const,
                                double factor = 1) {
  const std::optional<double> inside = row.inside();
  if (!inside) return std::nullopt;
  return factor * (row.*value)(*inside);
}

void print(const Row& row) {
  fmt::print("{:<16}{:<6}{:>8.1f}  | ", row.scene->name, row.view(), row.frame.median_ms);
  for (std::size_t s = 0; s < num_stages; ++s) {
    fmt::print("{:>8.1f}", 100 * row.frame.stages.fraction(static_cast<Stage>(s)));
  }
  const double lanes = row.lanes();
  std::optional<double> millions;
  if (row.inside()) millions = 1e-6 * *row.inside();
  fmt::print("  |{:>7.0f}{:>8}  |{:>8}{:>7.1f}{:>7}{:>7.1f}  |{:>7.3f}{:>7}  |{:>6.1f}\n",
             1e-6 * lanes, or_dash(millions, 0), or_dash(of_inside(row, &Row::of_frame, 100), 1),
             100 * row.of_frame(lanes), or_dash(of_inside(row, &Row::of_sums, 100), 1),
             100 * row.of_sums(lanes), row.ticks_each(lanes),
             or_dash(of_inside(row, &Row::ticks_each), 3), 100 * row.of_reading());
  std::fflush(stdout);
}

nlohmann::ordered_json or_null(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json to_json(const MachinePeak& peak) {
  return {{"threads", peak.threads},
          {"lanes", peak.lanes},
          {"unlit_evaluations_per_second", peak.unlit},
          {"lit_evaluations_per_second", peak.lit},
          {"time_stamp_ticks_per_second", peak.ticks},
          {"unlit_ticks_per_evaluation", peak.ticks_each(false)},
          {"lit_ticks_per_evaluation", peak.ticks_each(true)},
          {"read_bytes_per_second", peak.read},
          {"copied_bytes_per_second", peak.copied},
          {"array_bytes", peak.array_bytes}};
}

nlohmann::ordered_json to_json(const Row& row, const BenchJob& job) {
  nlohmann::ordered_json stages;
  for (std::size_t s = 0; s < num_stages; ++s) {
    stages[stage_names[s]] = row.frame.stages.fraction(static_cast<Stage>(s));
  }
  const double lanes = row.lanes();
  nlohmann::ordered_json out = describe_view(job, *row.scene, row.view());
  out.update({{"lighting", row.lit},
              {"sweep", to_json(row.frame)},
              {"stages", stages},
              {"evaluations_inside", or_null(row.inside())},
              {"peak_fraction_inside", or_null(of_inside(row, &Row::of_frame))},
              {"peak_fraction_lanes", row.of_frame(lanes)},
              {"peak_fraction_inside_in_sums", or_null(of_inside(row, &Row::of_sums))},
              {"peak_fraction_lanes_in_sums", row.of_sums(lanes)},
              {"ticks_per_lane", row.ticks_each(lanes)},
              {"ticks_per_evaluation_inside", or_null(of_inside(row, &Row::ticks_each))},
              {"data_bytes", row.data_bytes},
              {"time_fraction_of_reading_data_once", row.of_reading()}});
  return out;
}

/// The bars that the logarithmic axis can show.
std::optional<double> bar(double value) {
  return value > 0 ? std::optional<double>(value) : std::nullopt;
}

/// The results as two charts: what part of the peak is reached, and where the time goes.
struct Charts {
  BarChart peak{"What part of the machine's peak the sweep reaches",
                "% of the peak",
                {},
                {{"inside supports, in the frame", {}},
                 {"all lanes, in the frame", {}},
                 {"inside supports, in the sums", {}},
                 {"all lanes, in the sums", {}}},
                false};
  BarChart stages{"Where the time of the sweep goes", "% of the time", {}, {}, false};

  Charts() {
    for (const char* stage : stage_names) stages.series.push_back({stage, {}});
  }
  void add(const Row& row) {
    const std::string category = fmt::format("{} {}", row.scene->name, row.view());
    peak.categories.push_back(category);
    peak.series[0].values.push_back(of_inside(row, &Row::of_frame, 100));
    peak.series[1].values.push_back(bar(100 * row.of_frame(row.lanes())));
    peak.series[2].values.push_back(of_inside(row, &Row::of_sums, 100));
    peak.series[3].values.push_back(bar(100 * row.of_sums(row.lanes())));
    stages.categories.push_back(category);
    for (std::size_t s = 0; s < num_stages; ++s) {
      stages.series[s].values.push_back(
          bar(100 * row.frame.stages.fraction(static_cast<Stage>(s))));
    }
  }
};

}  // namespace

void run_limit(const BenchJob& job) {
  job.workplace.check_room(job.scenes);
  fmt::print("{}\n", describe_measurement(job.options));
  const MachinePeak peak = measure_peak(job.options.threads, job.workplace.memory());
  print(peak);
  print_header();
  nlohmann::ordered_json rows = nlohmann::json::array();
  Charts charts;
  for (const BenchScene* entry : job.scenes) {
    Console console;
    const PreparedScene prepared = prepare_bench_scene(job, *entry, console);
    for (const bool close : {false, true}) {
      const Row row = measure_row(job, *entry, prepared, close, peak, console);
      print(row);
      rows.push_back(to_json(row, job));
      charts.add(row);
    }
  }
  fmt::print("\n");
  write_results(job, "limit", rows, {{"peak", to_json(peak)}});
  write_result_file(job, "limit.svg", to_svg(charts.peak));
  write_result_file(job, "limit_stages.svg", to_svg(charts.stages));
}

}  // namespace motes
