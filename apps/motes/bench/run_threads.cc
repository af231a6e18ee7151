// motes bench threads: how much faster several threads are than one.
#include <fmt/format.h>
#include <tbb/info.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "motes/bench/chart.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

/// 1, 2, 4, ... and all that there are.
std::vector<int> thread_counts(const BenchOptions& options) {
  const int most = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  std::vector<int> counts;
  for (int n = 1; n < most; n *= 2) counts.push_back(n);
  counts.push_back(most);
  return counts;
}

}  // namespace

void run_threads(const BenchJob& job) {
  job.workplace.check_room(job.scenes);
  const std::vector<int> counts = thread_counts(job.options);
  fmt::print("{}\n\n{:<16}{:<6}{:>9}{:>10}{:>13}\n", describe_measurement(job.options), "scene",
             "view", "threads", "ms", "over one");
  nlohmann::ordered_json rows = nlohmann::json::array();
  BarChart chart{"Frame rates of several threads", "times one thread", {}, {}, false};
  for (const int count : counts) {
    chart.series.push_back({fmt::format("{} thread{}", count, count > 1 ? "s" : ""), {}});
  }
  std::vector<double> speedups;
  for (const BenchScene* entry : job.scenes) {
    Console console;
    const PreparedScene prepared = prepare_bench_scene(job, *entry, console);
    for (const bool close : {false, true}) {
      const std::string_view view = close ? "close" : "far";
      Variant variant{&prepared.renderer, prepared.resolved};
      if (close) variant.scene.camera = moved_closer(variant.scene.camera, entry->close);
      std::vector<Variant> variants(counts.size(), variant);
      for (std::size_t i = 0; i < counts.size(); ++i) variants[i].threads = counts[i];
      const std::vector<FrameTimes> times = measure_frames(variants, job.options, console);
      chart.categories.push_back(fmt::format("{} {}", entry->name, view));
      for (std::size_t i = 0; i < counts.size(); ++i) {
        const double speedup = times[0].median_ms / times[i].median_ms;
        fmt::print("{:<16}{:<6}{:>9}{:>10.1f}{:>13.2f}\n", entry->name, view, counts[i],
                   times[i].median_ms, speedup);
        rows.push_back({{"scene", entry->name},
                        {"view", view},
                        {"threads", counts[i]},
                        {"frame", to_json(times[i])},
                        {"over_one_thread", speedup}});
        chart.series[i].values.emplace_back(speedup);
      }
      std::fflush(stdout);
      speedups.push_back(times[0].median_ms / times.back().median_ms);
    }
  }
  const double mean = geometric_mean(speedups);
  fmt::print("\n{} threads over one: {:.2f} in the geometric mean\n", counts.back(), mean);
  write_results(job, "threads", rows, {{"geometric_mean", mean}});
  write_result_file(job, "threads.svg", to_svg(chart));
}

}  // namespace motes
