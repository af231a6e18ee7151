// Reads, prepares and times scenes.
#include "motes/bench/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.h"
#include "motes/frame_times.h"

namespace motes {
namespace {

/// Mean opacity of the pixels in which there is anything.
double mean_opacity(const Framebuffer& image) {
  double sum = 0, count = 0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] <= 0) continue;
    sum += static_cast<double>(image.rgba[i]);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// What a frame tells besides its time.
void describe(const RenderStatistics& statistics, const Framebuffer& image, FrameTimes& out) {
  out.samples = statistics.samples;
  out.kernel_evaluations = statistics.kernel_evaluations;
  out.opacity = mean_opacity(image);
  out.samples_per_ray =
      static_cast<double>(statistics.samples) / static_cast<double>(image.num_pixels());
  out.threads = statistics.threads;
}

}  // namespace

Input read_bench_particles(const BenchJob& job, const BenchScene& scene, Console& console) {
  job.workplace.make_if_missing(scene);
  Input input = read_particles(job.workplace.open(scene), console);
  if (input.particles.size() != scene.particles) {
    throw Error(job.workplace.particle_file(scene),
                fmt::format("has {} particles; expected {} (motes bench scenes {} makes them)",
                            input.particles.size(), scene.particles, scene.name));
  }
  return input;
}

PreparedScene prepare_bench_scene(const BenchJob& job, const BenchScene& entry, const Input& input,
                                  Console& console) {
  Scene scene = job.workplace.open(entry);
  scene.render.width = job.options.width;
  scene.render.height = job.options.height;
  PreparedScene prepared =
      prepare_scene(scene, input.particles, job.workplace.scene_file(entry), {}, console);
  prepared.read_ms = input.read_ms;
  return prepared;
}

PreparedScene prepare_bench_scene(const BenchJob& job, const BenchScene& entry, Console& console) {
  return prepare_bench_scene(job, entry, read_bench_particles(job, entry, console), console);
}

nlohmann::ordered_json describe_view(const BenchJob& job, const BenchScene& scene,
                                     std::string_view view) {
  return {{"scene", scene.name},
          {"view", view},
          {"scene_file", job.workplace.scene_file(scene).string()},
          {"data", job.workplace.particle_file(scene).string()}};
}

Camera moved_closer(const Camera& camera, double fraction) {
  Camera closer = camera;
  closer.eye = camera.target + fraction * (camera.eye - camera.target);
  return closer;
}

std::vector<Variant> engine_variants(const Renderer& renderer, const ResolvedScene& scene) {
  std::vector<Variant> variants;
  for (const Engine engine : {Engine::sweep, Engine::coherent}) {
    variants.push_back({&renderer, scene});
    variants.back().scene.render.engine = engine;
  }
  return variants;
}

nlohmann::ordered_json to_json(const FrameTimes& times) {
  return {{"frame_ms", times.median_ms}, {"frame_ms_min", times.min_ms},
          {"frames", times.frames},      {"fps", times.fps()},
          {"samples", times.samples},    {"kernel_evaluations", times.kernel_evaluations}};
}

std::vector<FrameTimes> measure_frames(const std::vector<Variant>& variants,
                                       const BenchOptions& options, Console& console) {
  std::vector<FrameTimes> results(variants.size());
  std::vector<std::vector<double>> times(variants.size());
  Framebuffer image;
  for (int round = -1; round < options.repeat; ++round) {
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const Variant& variant = variants[v];
      const bool warm_up = round < 0;
      if (!warm_up && results[v].frames == 1) continue;  // it ran out of patience
      const int threads = variant.threads > 0 ? variant.threads : options.threads;
      RenderOptions render{threads, variant.samples_per_pass, &console};
      RenderStatistics statistics;
      variant.renderer->render(variant.scene, render, image, &statistics);
      const bool too_long = statistics.frame_ms > variant.patience_ms;
      if (!warm_up || too_long) {
        times[v].push_back(statistics.frame_ms);
        results[v].stages.add(statistics.stages);
      }
      if (!warm_up) continue;
      describe(statistics, image, results[v]);
      results[v].frames = too_long ? 1 : 0;
      if (!variant.count_inside) continue;
      render.count_inside = true;
      variant.renderer->render(variant.scene, render, image, &statistics);
      results[v].evaluations_inside = statistics.evaluations_inside;
    }
  }
  console.finish();
  for (std::size_t v = 0; v < variants.size(); ++v) {
    results[v].median_ms = median(times[v]);
    results[v].min_ms = *std::ranges::min_element(times[v]);
    results[v].frames = static_cast<int>(times[v].size());
  }
  return results;
}

double geometric_mean(const std::vector<double>& values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0,
                                     [](double s, double v) { return s + std::log(v); });
  return std::exp(sum / static_cast<double>(values.size()));
}

}  // namespace motes
