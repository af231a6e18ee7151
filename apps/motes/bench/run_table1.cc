// motes bench table1: sizes, memory and build times.
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/stopwatch.h"
#include "motes/bench/chart.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"
#include "motes/frame_times.h"

namespace motes {
namespace {

constexpr double megabyte = 1e6;

/// Builds as often as the job says, or as fits into a few seconds; the times.
std::vector<double> time_builds(const BenchJob& job, const BenchScene& entry,
                                const ParticleSet& particles, Console& console,
                                std::optional<PreparedScene>& prepared) {
  constexpr double enough_ms = 10'000;
  const Scene scene = job.workplace.open(entry);
  const Stopwatch stopwatch;
  std::vector<double> times;
  do {
    prepared.reset();
    prepared = prepare_scene(scene, particles, job.workplace.scene_file(entry), {}, console);
    times.push_back(prepared->renderer.build_ms());
  } while (static_cast<int>(times.size()) < job.options.repeat &&
           stopwatch.milliseconds() < enough_ms);
  return times;
}

}  // namespace

void run_table1(const BenchJob& job) {
  job.workplace.check_room(job.scenes);
  fmt::print("{}\n\n", machine_line(job.options));
  fmt::print("{:<16}{:>10}{:>7}{:>9}{:>11}{:>9}{:>7}{:>9}{:>9}{:>9}  |{:>10}{:>9}{:>9}{:>8}\n",
             "scene", "particles", "fields", "file MB", "kernel MB", "tree MB", "B/p", "peak MB",
             "read s", "build s", "paper: MB", "tree MB", "build s", "ratio");
  nlohmann::ordered_json rows = nlohmann::json::array();
  BarChart chart{"Build time of the tree", "seconds", {}, {{"Motes", {}}, {"paper, 1 thread", {}}}};
  for (const BenchScene* entry : job.scenes) {
    Console console;
    reset_peak_memory();
    const Input input = read_bench_particles(job, *entry, console);
    std::optional<PreparedScene> prepared;
    const std::vector<double> times = time_builds(job, *entry, input.particles, console, prepared);
    const KernelSet& kernels = prepared->renderer.kernels();
    const double build_s = median(times) / 1000;
    const auto particle_bytes = static_cast<double>(kernels.particle_bytes());
    const auto tree_bytes = static_cast<double>(kernels.bvh.bytes());
    const double per_particle = (particle_bytes + tree_bytes) / static_cast<double>(kernels.size());
    const auto file_bytes =
        static_cast<double>(std::filesystem::file_size(job.workplace.particle_file(*entry)));
    const PaperFigures& paper = entry->paper;
    fmt::print(
        "{:<16}{:>10}{:>7}{:>9.1f}{:>11.1f}{:>9.2f}{:>7.1f}{:>9.0f}{:>9.2f}{:>9.3f}  "
        "|{:>10.4g}{:>9.4g}"
        "{:>9.4g}{:>8.1f}\n",
        entry->name, kernels.size(), kernels.fields.size(), file_bytes / megabyte,
        particle_bytes / megabyte, tree_bytes / megabyte, per_particle,
        static_cast<double>(peak_memory()) / megabyte, input.read_ms / 1000, build_s,
        paper.memory_mb, paper.tree_mb, paper.build_s, paper.build_s / build_s);
    std::fflush(stdout);
    rows.push_back({{"scene", entry->name},
                    {"data", job.workplace.particle_file(*entry).string()},
                    {"particles", kernels.size()},
                    {"fields", kernels.fields.size()},
                    {"file_bytes", file_bytes},
                    {"particle_bytes", particle_bytes},
                    {"tree_bytes", tree_bytes},
                    {"bytes_per_particle", per_particle},
                    {"peak_rss_bytes", peak_memory()},
                    {"read_s", input.read_ms / 1000},
                    {"build_s", build_s},
                    {"builds", times.size()},
                    {"paper",
                     {{"particles", paper.particles},
                      {"geometry_mb", paper.memory_mb},
                      {"tree_mb", paper.tree_mb},
                      {"build_s", paper.build_s}}},
                    {"paper_build_over_build", paper.build_s / build_s}});
    chart.categories.emplace_back(entry->name);
    chart.series[0].values.emplace_back(build_s);
    chart.series[1].values.emplace_back(paper.build_s);
  }
  fmt::print("\n");
  write_results(job, "table1", rows);
  write_result_file(job, "table1.svg", to_svg(chart));
}

}  // namespace motes
