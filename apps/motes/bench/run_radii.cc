// motes bench radii: what a kernel evaluation takes where radii differ by orders of magnitude,
// against the same positions with equal radii.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "motes/bench/adaptive_radii.h"
#include "motes/bench/chart.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

/// Two million for 1024 x 1024 pixels; for others so many that kernels cover as many pixels.
std::size_t num_particles(const BenchOptions& options) {
  const double pixels = static_cast<double>(options.width) * options.height / (1024 * 1024);
  return static_cast<std::size_t>(std::max(2e6 * std::pow(pixels, 1.5), 1000.0));
}

/// All particles with these radii, one each or one for all.
FieldSource field_with(const ParticleSet& particles, std::vector<float> radii) {
  FieldSource field;
  field.name = "particles";
  field.index.resize(particles.size());
  std::iota(field.index.begin(), field.index.end(), 0U);
  field.radius = std::move(radii);
  field.weight = {1};
  return field;
}

/// The whole cube from outside, nearly transparent: every sample of every ray is taken.
ResolvedScene make_scene(const BenchOptions& options) {
  const double side = std::cbrt(static_cast<double>(num_particles(options)));
  ResolvedScene scene;
  scene.camera.eye = {0.4 * side, 0.3 * side, -1.7 * side};
  scene.camera.target = {0, 0, 0};
  scene.step_size = 0.5;
  scene.render.width = options.width;
  scene.render.height = options.height;
  scene.render.lighting.enabled = false;
  scene.transfer_functions.push_back(
      {{{.value = 0.2, .color = {0, 0, 0.2F}, .extinction = 0},
        {.value = 10, .color = {1, 0.6F, 0.1F}, .extinction = 0.5 / side}},
       false});
  return scene;
}

/// Evaluations inside of supports; where these are not counted, those carried out.
double evaluations(const FrameTimes& frame) {
  return static_cast<double>(frame.evaluations_inside > 0 ? frame.evaluations_inside
                                                          : frame.kernel_evaluations);
}

/// A frame of the sweep, for its evaluations.
double count_evaluations(const Renderer& renderer, const ResolvedScene& scene,
                         const BenchOptions& options, Console& console) {
  RenderStatistics statistics;
  renderer.render(scene, {.threads = options.threads, .progress = &console, .count_inside = true},
                  &statistics);
  FrameTimes frame;
  frame.kernel_evaluations = statistics.kernel_evaluations;
  frame.evaluations_inside = statistics.evaluations_inside;
  return evaluations(frame);
}

/// The radius that gives about as many evaluations as `wanted` if all particles have it.
float matching_radius(const ParticleSet& particles, const std::vector<float>& radii, double wanted,
                      const ResolvedScene& scene, const BenchOptions& options, Console& console) {
  double cubes = 0;
  for (const float radius : radii) cubes += std::pow(static_cast<double>(radius), 3);
  double radius = std::cbrt(cubes / static_cast<double>(radii.size()));
  for (int i = 0; i < 8; ++i) {
    const Renderer renderer(particles, {field_with(particles, {static_cast<float>(radius)})});
    const double found = count_evaluations(renderer, scene, options, console);
    if (found > 0 && std::abs(found / wanted - 1) < 0.03) break;
    // Evaluations grow with the cube of radii that are large against pixels and steps, with less
    // of small ones.
    constexpr double power = 2.5;
    radius *= std::clamp(std::pow(wanted / std::max(found, 1.0), 1 / power), 0.25, 4.0);
  }
  return static_cast<float>(radius);
}

/// One engine with radii that differ, and with equal ones.
struct Pair {
  FrameTimes adaptive, equal;
  double adaptive_evaluations, equal_evaluations;

  double adaptive_ns() const { return 1e6 * adaptive.median_ms / adaptive_evaluations; }
  double equal_ns() const { return 1e6 * equal.median_ms / equal_evaluations; }
  double ratio() const { return adaptive_ns() / equal_ns(); }
};

struct Row {
  const AdaptiveRadii* radii;
  std::size_t particles;
  float least, most, equal;
  double adaptive_build_ms, equal_build_ms;
  Pair sweep, coherent;
};

Row measure_row(const BenchJob& job, const AdaptiveRadii& radii, Console& console) {
  const ParticleSet particles = radii.make(num_particles(job.options));
  const std::vector<float>& values = particles.properties[0].values;
  const ResolvedScene scene = make_scene(job.options);
  const Renderer adaptive(particles, {field_with(particles, values)});
  const float radius =
      matching_radius(particles, values, count_evaluations(adaptive, scene, job.options, console),
                      scene, job.options, console);
  const Renderer equal(particles, {field_with(particles, {radius})});
  std::vector<Variant> variants;
  for (const Renderer* renderer : {&adaptive, &equal}) {
    for (const Variant& variant : engine_variants(*renderer, scene)) variants.push_back(variant);
    variants[variants.size() - 2].count_inside = true;
  }
  const std::vector<FrameTimes> times = measure_frames(variants, job.options, console);
  // Both engines evaluate the same inside of supports; not so what they carry out besides.
  const auto pair = [&](std::size_t engine) -> Pair {
    const auto of = [&](std::size_t v) {
      return evaluations(times[v].evaluations_inside > 0 ? times[v] : times[v + engine]);
    };
    return {times[engine], times[2 + engine], of(0), of(2)};
  };
  const auto [least, most] = std::ranges::minmax(values);
  return {&radii,           particles.size(), least,  most, radius, adaptive.build_ms(),
          equal.build_ms(), pair(0),          pair(1)};
}

void print_header() {
  fmt::print("{:<28}{:>24}  |{:>12}  |{:>16}  |{:>23}  |{:>23}\n", "", "radius", "build, ms",
             "evaluations, M", "sweep, ns for one", "coherent, ns for one");
  fmt::print("{:<28}{:>8}{:>8}{:>8}  |{:>6}{:>6}  |{:>8}{:>8}  |", "radii", "least", "most",
             "equal", "these", "equal", "these", "equal");
  fmt::print("{:>8}{:>8}{:>7}  |{:>8}{:>8}{:>7}\n", "these", "equal", "ratio", "these", "equal",
             "ratio");
}

void print(const Row& row) {
  fmt::print("{:<28}{:>8.2g}{:>8.2g}{:>8.2g}  |{:>6.0f}{:>6.0f}  |{:>8.0f}{:>8.0f}  |",
             row.radii->description, row.least, row.most, row.equal, row.adaptive_build_ms,
             row.equal_build_ms, 1e-6 * row.sweep.adaptive_evaluations,
             1e-6 * row.sweep.equal_evaluations);
  fmt::print("{:>8.3f}{:>8.3f}{:>7.2f}  |{:>8.3f}{:>8.3f}{:>7.2f}\n", row.sweep.adaptive_ns(),
             row.sweep.equal_ns(), row.sweep.ratio(), row.coherent.adaptive_ns(),
             row.coherent.equal_ns(), row.coherent.ratio());
  std::fflush(stdout);
}

nlohmann::ordered_json to_json(const Pair& pair) {
  return {{"adaptive", to_json(pair.adaptive)},
          {"equal", to_json(pair.equal)},
          {"adaptive_evaluations", pair.adaptive_evaluations},
          {"equal_evaluations", pair.equal_evaluations},
          {"adaptive_ns_per_evaluation", pair.adaptive_ns()},
          {"equal_ns_per_evaluation", pair.equal_ns()},
          {"adaptive_over_equal", pair.ratio()}};
}

nlohmann::ordered_json to_json(const Row& row) {
  return {{"radii", row.radii->name},
          {"description", row.radii->description},
          {"particles", row.particles},
          {"least_radius", row.least},
          {"most_radius", row.most},
          {"equal_radius", row.equal},
          {"adaptive_build_ms", row.adaptive_build_ms},
          {"equal_build_ms", row.equal_build_ms},
          {"sweep", to_json(row.sweep)},
          {"coherent", to_json(row.coherent)}};
}

}  // namespace

void run_radii(const BenchJob& job) {
  fmt::print("{}, {} particles\n\n", describe_measurement(job.options), num_particles(job.options));
  print_header();
  nlohmann::ordered_json results = nlohmann::json::array();
  BarChart chart{
      "Time of a kernel evaluation where radii differ",
      "ns",
      {},
      {{"sweep", {}}, {"sweep, equal radii", {}}, {"coherent", {}}, {"coherent, equal radii", {}}}};
  double most_sweep = 0, most_coherent = 0;
  for (const AdaptiveRadii& radii : adaptive_radii()) {
    Console console;
    const Row row = measure_row(job, radii, console);
    print(row);
    results.push_back(to_json(row));
    chart.categories.emplace_back(radii.name);
    chart.series[0].values.emplace_back(row.sweep.adaptive_ns());
    chart.series[1].values.emplace_back(row.sweep.equal_ns());
    chart.series[2].values.emplace_back(row.coherent.adaptive_ns());
    chart.series[3].values.emplace_back(row.coherent.equal_ns());
    most_sweep = std::max(most_sweep, row.sweep.ratio());
    most_coherent = std::max(most_coherent, row.coherent.ratio());
  }
  fmt::print(
      "\nan evaluation takes at most {:.2f} times as long with the sweep, {:.2f} with coherent\n",
      most_sweep, most_coherent);
  write_results(job, "radii", results,
                {{"most_sweep", most_sweep}, {"most_coherent", most_coherent}});
  write_result_file(job, "radii.svg", to_svg(chart));
}

}  // namespace motes
