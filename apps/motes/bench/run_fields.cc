// motes bench fields: what it costs to share the particles out among fields, and to have them in
// two.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "motes/bench/chart.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

/// Bytes a particle, three trees of which one holds all particles twice included. Measured: 168.
constexpr std::size_t bytes_per_particle = 192;

/// The fields of a scene; of one with a single field that takes everything, a field a species.
std::vector<Field> shared_fields(const Scene& scene, const ParticleSet& particles,
                                 std::string_view name) {
  if (scene.fields.size() > 1) return scene.fields;
  if (particles.species_names.size() < 2) {
    throw Error(fmt::format(
        "{} has one field and one species; expected a scene whose particles fields can share out",
        name));
  }
  std::vector<Field> fields;
  for (const std::string& species : particles.species_names) {
    fields.push_back(scene.fields.empty() ? Field{} : scene.fields.front());
    fields.back().name = species;
    fields.back().select.species = {species};
  }
  return fields;
}

/// One field of the particles of all `sources`, which share none, with the radii and weights that
/// they have there and the first one's kernel.
FieldSource joined(const std::vector<FieldSource>& sources) {
  struct Particle {
    std::uint32_t index;
    float radius, weight;
  };
  std::vector<Particle> all;
  for (const FieldSource& source : sources) {
    for (std::size_t i = 0; i < source.index.size(); ++i) {
      all.push_back({source.index[i], source.radius_of(i), source.weight_of(i)});
    }
  }
  std::ranges::sort(all, {}, &Particle::index);
  FieldSource field;
  field.name = "all";
  field.kernel = sources.front().kernel;
  field.normalise = sources.front().normalise;
  field.colors = sources.front().colors;
  std::ranges::transform(all, std::back_inserter(field.index), &Particle::index);
  std::ranges::transform(all, std::back_inserter(field.radius), &Particle::radius);
  std::ranges::transform(all, std::back_inserter(field.weight), &Particle::weight);
  return field;
}

TransferFunction scaled(TransferFunction f, double extinction) {
  for (auto& point : f.points) point.extinction *= extinction;
  return f;
}

double samples_per_ray(const Renderer& renderer, const ResolvedScene& scene,
                       const BenchOptions& options, Console& console) {
  RenderStatistics statistics;
  const Framebuffer image =
      renderer.render(scene, {options.threads, std::nullopt, &console}, &statistics);
  return static_cast<double>(statistics.samples) / static_cast<double>(image.num_pixels());
}

/// The factor on the extinction of the scene's one field with which rays take about so many samples
/// before they end. Frames can be compared only where rays go equally deep.
double extinction_for_depth(const Renderer& renderer, ResolvedScene scene, double samples,
                            const BenchOptions& options, Console& console) {
  const TransferFunction original = scene.transfer_functions[0];
  double low = -8, high = 8;  // powers of two; the more extinction, the fewer samples
  for (int i = 0; i < 12; ++i) {
    const double middle = (low + high) / 2;
    scene.transfer_functions[0] = scaled(original, std::exp2(middle));
    const double found = samples_per_ray(renderer, scene, options, console);
    if (std::abs(found / samples - 1) < 0.005) return std::exp2(middle);
    (found > samples ? low : high) = middle;
  }
  return std::exp2((low + high) / 2);
}

/// The same particles in fields that share them out, in one field, and twice: in each of two.
struct Arrangements {
  PreparedScene shared;
  Renderer one, doubled;
};

Arrangements arrange(const BenchJob& job, const BenchScene& entry, Console& console) {
  const Input input = read_bench_particles(job, entry, console);
  Scene scene = job.workplace.open(entry);
  scene.render.width = job.options.width;
  scene.render.height = job.options.height;
  scene.fields = shared_fields(scene, input.particles, entry.name);
  PreparedScene shared =
      prepare_scene(scene, input.particles, job.workplace.scene_file(entry), {}, console);
  std::vector<FieldSource> fields{
      joined(make_field_sources(input.particles, expand_fields(scene, input.particles),
                                scene.kernel, console.warnings(), &console))};
  Renderer one(input.particles, fields);
  fields.push_back(fields.front());
  return {std::move(shared), std::move(one), Renderer(input.particles, fields)};
}

struct Row {
  const BenchScene* scene;
  bool close;
  std::size_t num_fields;
  double extinction;  ///< factor on the first field's, for all particles in one field
  FrameTimes one, shared, doubled;

  std::string_view view() const { return close ? "close" : "far"; }
  /// How much longer a frame takes for each field beyond the first, of fields that share out.
  double each_more() const {
    return (shared.median_ms / one.median_ms - 1) / static_cast<double>(num_fields - 1);
  }
  /// How much longer it takes with all particles in a second field.
  double second() const { return doubled.median_ms / one.median_ms - 1; }
};

Row measure_row(const BenchJob& job, const BenchScene& entry, const Arrangements& arrangements,
                bool close, Console& console) {
  ResolvedScene shared = arrangements.shared.resolved;
  shared.render.engine = Engine::sweep;
  if (close) shared.camera = moved_closer(shared.camera, entry.close);
  const double depth = samples_per_ray(arrangements.shared.renderer, shared, job.options, console);
  ResolvedScene one = shared;
  const TransferFunction first = shared.transfer_functions.front();
  one.transfer_functions = {first};
  const double extinction =
      extinction_for_depth(arrangements.one, one, depth, job.options, console);
  one.transfer_functions = {scaled(first, extinction)};
  // Half of the extinction each: the same opacity.
  ResolvedScene doubled = one;
  doubled.transfer_functions.assign(2, scaled(first, extinction / 2));
  const std::vector<FrameTimes> times = measure_frames({{&arrangements.one, one},
                                                        {&arrangements.shared.renderer, shared},
                                                        {&arrangements.doubled, doubled}},
                                                       job.options, console);
  return {&entry,   close,   shared.transfer_functions.size(), extinction, times[0],
          times[1], times[2]};
}

void print_header() {
  fmt::print("{:<22}{:>10}{:>8}  |{:>30}  |{:>24}  |{:>22}\n", "", "", "", "frame, ms",
             "samples a ray", "% more time for");
  fmt::print("{:<16}{:<6}{:>10}{:>8}  |{:>10}{:>10}{:>10}  |{:>8}{:>8}{:>8}  |{:>11}{:>11}\n",
             "scene", "view", "particles", "fields", "one field", "shared", "doubled", "one",
             "shared", "doubled", "each field", "the second");
}

void print(const Row& row) {
  fmt::print(
      "{:<16}{:<6}{:>10}{:>8}  |{:>10.1f}{:>10.1f}{:>10.1f}  |{:>8.1f}{:>8.1f}{:>8.1f}  |"
      "{:>11.1f}{:>11.1f}\n",
      row.scene->name, row.view(), row.scene->particles, row.num_fields, row.one.median_ms,
      row.shared.median_ms, row.doubled.median_ms, row.one.samples_per_ray,
      row.shared.samples_per_ray, row.doubled.samples_per_ray, 100 * row.each_more(),
      100 * row.second());
  std::fflush(stdout);
}

nlohmann::ordered_json to_json(const Row& row, const BenchJob& job) {
  nlohmann::ordered_json out = describe_view(job, *row.scene, row.view());
  out.update({{"fields", row.num_fields},
              {"one_field", to_json(row.one)},
              {"one_field_extinction_factor", row.extinction},
              {"shared", to_json(row.shared)},
              {"doubled", to_json(row.doubled)},
              {"each_additional_field", row.each_more()},
              {"second_field", row.second()}});
  return out;
}

}  // namespace

void run_fields(const BenchJob& job) {
  job.workplace.check_room(job.scenes, bytes_per_particle);
  fmt::print("{}\n\n", describe_measurement(job.options));
  print_header();
  nlohmann::ordered_json rows = nlohmann::json::array();
  BarChart chart{"Frames with several fields",
                 "% of the time with one field",
                 {},
                 {{"all fields of the scene", {}}, {"all particles in two fields", {}}},
                 false};
  std::vector<double> each, second;
  for (const BenchScene* entry : job.scenes) {
    Console console;
    const Arrangements arrangements = arrange(job, *entry, console);
    for (const bool close : {false, true}) {
      const Row row = measure_row(job, *entry, arrangements, close, console);
      print(row);
      rows.push_back(to_json(row, job));
      chart.categories.push_back(fmt::format("{} {}", row.scene->name, row.view()));
      chart.series[0].values.emplace_back(100 * row.shared.median_ms / row.one.median_ms);
      chart.series[1].values.emplace_back(100 * row.doubled.median_ms / row.one.median_ms);
      each.push_back(100 * row.each_more());
      second.push_back(100 * row.second());
    }
  }
  const double most_each = std::ranges::max(each), most_second = std::ranges::max(second);
  fmt::print("\nat most {:.0f} % for each field more, {:.0f} % for the same particles once more\n",
             most_each, most_second);
  write_results(
      job, "fields", rows,
      {{"most_each_additional_field", most_each / 100}, {"most_second_field", most_second / 100}});
  write_result_file(job, "fields.svg", to_svg(chart));
}

}  // namespace motes
