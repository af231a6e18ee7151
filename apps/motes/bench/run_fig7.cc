// motes bench fig7: what the end of rays is worth, and how many samples a pass should take.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "motes/bench/chart.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

constexpr double opacities[] = {0.5, 0.7, 0.8, 0.9, 0.95, 0.97, 0.99, 1};
constexpr int coherent_passes[] = {8, 16, 32, 64, 128};
constexpr int sweep_passes[] = {8, 16, 32};
/// A frame that takes longer is measured once.
constexpr double patience_ms = 5000;

struct View {
  std::string_view name;
  ResolvedScene scene;
};

/// Frame rates of both engines over the opacity at which rays stop.
void measure_termination(const BenchJob& job, const Renderer& renderer, const View& view,
                         nlohmann::ordered_json& rows, LineChart& chart, Console& console) {
  const std::size_t first = chart.series.size();
  chart.series.push_back({fmt::format("sweep, {}", view.name), {}});
  chart.series.push_back({fmt::format("coherent, {}", view.name), {}});
  for (const double opacity : opacities) {
    ResolvedScene scene = view.scene;
    scene.render.termination_opacity = opacity;
    std::vector<Variant> variants = engine_variants(renderer, scene);
    for (Variant& variant : variants) variant.patience_ms = patience_ms;
    const std::vector<FrameTimes> times = measure_frames(variants, job.options, console);
    fmt::print("{:<7}{:>8}{:>9.1f}{:>9.2f}{:>10.2f}{:>8.2f}\n", view.name,
               opacity < 1 ? fmt::format("{:.2f}", opacity) : "never", times[0].samples_per_ray,
               times[0].fps(), times[1].fps(), times[1].median_ms / times[0].median_ms);
    std::fflush(stdout);
    for (std::size_t engine = 0; engine < 2; ++engine) {
      chart.series[first + engine].points.emplace_back(opacity, times[engine].fps());
    }
    rows.push_back({{"view", view.name},
                    {"termination_opacity", opacity},
                    {"samples_per_ray", times[0].samples_per_ray},
                    {"sweep", to_json(times[0])},
                    {"coherent", to_json(times[1])}});
  }
}

/// Frame rates over the planes of samples of a pass.
void measure_passes(const BenchJob& job, const Renderer& renderer, const View& view,
                    nlohmann::ordered_json& rows, LineChart& chart, Console& console) {
  const auto measure = [&](Engine engine, const auto& passes) {
    chart.series.push_back({fmt::format("{}, {}", name_of(engine), view.name), {}});
    for (const int planes : passes) {
      Variant variant{&renderer, view.scene, planes, patience_ms};
      variant.scene.render.engine = engine;
      const FrameTimes times = measure_frames({variant}, job.options, console)[0];
      fmt::print("{:<7}{:<10}{:>8}{:>9.2f}\n", view.name, name_of(engine), planes, times.fps());
      std::fflush(stdout);
      chart.series.back().points.emplace_back(planes, times.fps());
      rows.push_back({{"view", view.name},
                      {"engine", name_of(engine)},
                      {"samples_per_pass", planes},
                      {"frame", to_json(times)}});
    }
  };
  measure(Engine::sweep, sweep_passes);
  measure(Engine::coherent, coherent_passes);
}

}  // namespace

void run_fig7(const BenchJob& job) {
  job.workplace.check_room(job.scenes);
  const BenchScene& entry = *job.scenes.back();
  Console console;
  const PreparedScene prepared = prepare_bench_scene(job, entry, console);
  View far{"far", prepared.resolved}, close{"close", prepared.resolved};
  close.scene.camera = moved_closer(close.scene.camera, entry.close);

  fmt::print("{}, {}\n\n", entry.name, describe_measurement(job.options));
  fmt::print("{:<7}{:>8}{:>9}{:>9}{:>10}{:>8}\n", "view", "ends at", "samples", "sweep", "coherent",
             "ratio");
  LineChart ends{
      "Early termination", "opacity at which rays end", "frames per second", false, false, {}};
  LineChart passes{"Samples of a pass", "planes of samples", "frames per second", true, false, {}};
  nlohmann::ordered_json rows = nlohmann::json::array();
  for (const View* view : {&far, &close}) {
    measure_termination(job, prepared.renderer, *view, rows, ends, console);
  }
  fmt::print("\n{:<7}{:<10}{:>8}{:>9}\n", "view", "engine", "planes", "fps");
  for (const View* view : {&far, &close}) {
    measure_passes(job, prepared.renderer, *view, rows, passes, console);
  }
  fmt::print("\n");
  write_results(job, "fig7", rows);
  write_result_file(job, "fig7.svg", to_svg(ends));
  write_result_file(job, "fig7_passes.svg", to_svg(passes));
}

}  // namespace motes
