// motes bench fig8 and fig9: pictures with other kernels of the same tree, and what each costs.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/write_image.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

/// A property of the kernel that takes several values.
struct Sweep {
  std::string_view figure, name;
  double Kernel::*member;
  std::vector<double> values;
};

void run(const BenchJob& job, const Sweep& sweep) {
  job.workplace.check_room(job.scenes);
  nlohmann::ordered_json rows = nlohmann::json::array();
  fmt::print("{}\n\n{:<16}{:>8}{:>9}{:>9}{:>10}{:>8}  {}\n", describe_measurement(job.options),
             "scene", sweep.name, "opacity", "sweep", "coherent", "ratio", "picture");
  for (const BenchScene* entry : job.scenes) {
    Console console;
    PreparedScene prepared = prepare_bench_scene(job, *entry, console);
    Renderer& renderer = prepared.renderer;
    for (const double value : sweep.values) {
      for (std::size_t field = 0; field < renderer.kernels().fields.size(); ++field) {
        Kernel kernel = renderer.kernels().fields[field].kernel;
        kernel.*sweep.member = value;
        renderer.set_kernel(field, kernel);
      }
      const std::vector<FrameTimes> times =
          measure_frames(engine_variants(renderer, prepared.resolved), job.options, console);
      const std::filesystem::path picture = job.workplace.result(
          fmt::format("{}_{}_{}_{:g}.png", sweep.figure, entry->name, sweep.name, value));
      const RenderSettings& settings = prepared.resolved.render;
      write_image(picture, renderer.render(prepared.resolved, {job.options.threads, {}, &console}),
                  settings.termination_opacity, settings.background);
      console.finish();
      fmt::print("{:<16}{:>8g}{:>9.2f}{:>9.2f}{:>10.2f}{:>8.2f}  {}\n", entry->name, value,
                 times[0].opacity, times[0].fps(), times[1].fps(),
                 times[1].median_ms / times[0].median_ms, picture.string());
      std::fflush(stdout);
      rows.push_back({{"scene", entry->name},
                      {sweep.name, value},
                      {"mean_opacity", times[0].opacity},
                      {"sweep", to_json(times[0])},
                      {"coherent", to_json(times[1])},
                      {"picture", picture.string()}});
    }
  }
  fmt::print("\n");
  write_results(job, sweep.figure, rows);
}

}  // namespace

void run_fig8(const BenchJob& job) {
  run(job, {"fig8", "kappa", &Kernel::kernel_scale, {0.8, 1.25, 2.44}});
}

void run_fig9(const BenchJob& job) {
  run(job, {"fig9", "sigma", &Kernel::support_factor, {1, 1.5, 2, 3, 4}});
}

}  // namespace motes
