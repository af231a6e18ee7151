// motes bench build: the build of the tree beside Embree's builds of a tree over the same.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/stopwatch.h"
#include "field/kernel_set.h"
#include "motes/bench/chart.h"
#include "motes/bench/embree.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"
#include "motes/frame_times.h"

namespace motes {
namespace {

/// Most that is in memory at once, for each particle: what is built from (up to 46), and what a
/// build takes: 44 of Motes', 66 of Embree's with its boxes. Measured: 104 with Embree.
constexpr std::size_t motes_bytes = 92, embree_bytes = 120;

/// What is built from.
struct Inputs {
  ParticleSet particles;
  std::vector<FieldSource> sources;
  /// All kernels' centres, relative to the particles' origin, and support radii.
  UninitializedVector<Sphere> supports;
};

UninitializedVector<Sphere> gather_supports(const ParticleSet& particles,
                                            const std::vector<FieldSource>& sources) {
  std::size_t count = 0;
  for (const FieldSource& source : sources) count += source.index.size();
  UninitializedVector<Sphere> supports;
  supports.reserve(count);
  for (const FieldSource& source : sources) {
    const auto sigma = static_cast<float>(source.kernel.support());
    for (std::size_t i = 0; i < source.index.size(); ++i) {
      const std::uint32_t p = source.index[i];
      supports.push_back(
          {particles.x[p], particles.y[p], particles.z[p], sigma * source.radius_of(i)});
    }
  }
  return supports;
}

Inputs read_inputs(const BenchJob& job, const BenchScene& entry, Console& console) {
  Inputs inputs;
  inputs.particles = read_bench_particles(job, entry, console).particles;
  with_place(job.workplace.scene_file(entry), {}, [&] {
    Scene scene = job.workplace.open(entry);
    color_by_species(scene, inputs.particles);
    inputs.sources = make_field_sources(inputs.particles, expand_fields(scene, inputs.particles),
                                        scene.kernel, console.warnings(), &console);
  });
  console.print_warnings();
  inputs.supports = gather_supports(inputs.particles, inputs.sources);
  return inputs;
}

/// Motes' tree alone, of spheres as Embree's is of boxes.
struct LoneTree {
  UninitializedVector<float> x, y, z, radius;
  Bvh bvh;
};

LoneTree build_lone_tree(std::span<const Sphere> spheres) {
  const std::size_t n = spheres.size();
  const UninitializedVector<std::uint32_t> order = spatial_order(spheres);
  LoneTree tree;
  for (auto* array : {&tree.x, &tree.y, &tree.z, &tree.radius}) array->resize(n);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 1 << 14), [&](const auto& range) {
    constexpr std::size_t ahead = 32;  // spheres are asked for so long before they are used
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      if (i + ahead < n) __builtin_prefetch(&spheres[order[i + ahead]]);
      const Sphere& sphere = spheres[order[i]];
      tree.x[i] = sphere.x;
      tree.y[i] = sphere.y;
      tree.z[i] = sphere.z;
      tree.radius[i] = sphere.radius;
    }
  });
  tree.bvh = build_bvh(tree.x, tree.y, tree.z, tree.radius);
  return tree;
}

/// One of the builds that are measured in turn. The time of `run` counts, and the memory that it
/// and `prepare` take.
struct Step {
  std::function<void()> prepare, run, finish;
  /// A first run that takes longer is the only one, and counts.
  double patience_s = std::numeric_limits<double>::infinity();
};

struct StepResult {
  std::vector<double> seconds;
  std::size_t peak_bytes = 0;  ///< most that was resident beyond what was there before
  bool only_once = false;

  double median_s() const { return median(seconds); }
};

void run_step(const Step& step, bool warm_up, StepResult& result) {
  reset_peak_memory();
  const std::size_t before = resident_memory();
  step.prepare();
  const Stopwatch stopwatch;
  step.run();
  const double seconds = stopwatch.milliseconds() / 1000;
  const std::size_t peak = peak_memory();
  step.finish();
  result.only_once = warm_up && seconds > step.patience_s;
  if (warm_up && !result.only_once) return;
  result.seconds.push_back(seconds);
  result.peak_bytes = std::max(result.peak_bytes, peak - std::min(peak, before));
}

/// Runs `steps` in turn, so that whatever else the machine does meets them alike, once to warm up
/// and then `repeat` times.
std::vector<StepResult> measure_steps(const std::vector<Step>& steps, int repeat,
                                      Console& console) {
  std::vector<StepResult> results(steps.size());
  for (int round = -1; round < repeat; ++round) {
    console.update("building trees", static_cast<double>(round + 1) / (repeat + 1));
    for (std::size_t s = 0; s < steps.size(); ++s) {
      if (!results[s].only_once) run_step(steps[s], round < 0, results[s]);
    }
  }
  console.finish();
  return results;
}

/// What one scene comes to.
struct Row {
  struct Embree {
    StepResult morton, morton_again, binned;
    EmbreeTree morton_tree, binned_tree;

    double fastest_s() const { return std::min(morton.median_s(), morton_again.median_s()); }
  };
  const BenchScene* scene = nullptr;
  std::size_t kernels = 0, particle_bytes = 0, tree_bytes = 0;
  StepResult build, refit, tree;
  std::optional<Embree> embree;

  double per_kernel(std::size_t bytes) const {
    return static_cast<double>(bytes) / static_cast<double>(kernels);
  }
  /// How many times longer Embree takes.
  double morton_ratio() const { return embree->fastest_s() / build.median_s(); }
  double binned_ratio() const { return embree->binned.median_s() / build.median_s(); }
};

/// Three builds of Embree's, the second into the memory of the first.
void add_embree_steps(EmbreeBuilder& embree, const Inputs& inputs, Row::Embree& row,
                      std::vector<Step>& steps) {
  const auto nothing = [] {};
  const auto set_boxes = [&] { embree.set_boxes(inputs.supports); };
  const auto build = [&embree](EmbreeQuality quality) {
    return [&embree, quality] { embree.build(quality); };
  };
  const auto finish = [&embree, &inputs](EmbreeTree& tree) {
    return [&] {
      tree = embree.tree();
      embree.clear();
      if (tree.particles == inputs.supports.size()) return;
      throw Error(fmt::format("Embree's tree holds {} of {} particles", tree.particles,
                              inputs.supports.size()));
    };
  };
  constexpr double patience_s = 20;
  steps.push_back({set_boxes, build(EmbreeQuality::morton), nothing});
  steps.push_back({nothing, build(EmbreeQuality::morton), finish(row.morton_tree)});
  steps.push_back({set_boxes, build(EmbreeQuality::binned), finish(row.binned_tree), patience_s});
}

Row measure_row(const BenchJob& job, const BenchScene& entry, EmbreeBuilder* embree,
                Console& console) {
  const Inputs inputs = read_inputs(job, entry, console);
  Row row;
  row.scene = &entry;
  row.kernels = inputs.supports.size();
  KernelSet kernels;
  KernelOrder order;
  LoneTree tree;
  const auto nothing = [] {};
  std::vector<Step> steps{
      {nothing, [&] { kernels = build_kernel_set(inputs.particles, inputs.sources, &order); },
       [&] {
         row.particle_bytes = kernels.particle_bytes();
         row.tree_bytes = kernels.bvh.bytes();
       }},
      {nothing, [&] { refit_kernel_set(inputs.particles, inputs.sources, order, kernels); },
       [&] {
         kernels = {};
         order = {};
       }},
      {nothing, [&] { tree = build_lone_tree(inputs.supports); }, [&] { tree = {}; }}};
  if (embree != nullptr) {
    row.embree.emplace();
    add_embree_steps(*embree, inputs, *row.embree, steps);
  }
  const std::vector<StepResult> results = measure_steps(steps, job.options.repeat, console);
  row.build = results[0];
  row.refit = results[1];
  row.tree = results[2];
  if (row.embree) {
    row.embree->morton = results[3];
    row.embree->morton_again = results[4];
    row.embree->binned = results[5];
  }
  return row;
}

void print_header(bool with_embree) {
  fmt::print("{:<16}{:>10}  |{:<27}{:>7}{:>7}{:>7}", "", "", " Motes", "", "tree", "peak");
  if (with_embree) {
    fmt::print("  |{:<18}{:>7}{:>7}  |{:<16}{:>7}{:>7}  |{:>9}{:>9}", " Embree, Morton", "tree",
               "peak", " Embree, default", "tree", "peak", "Morton/", "default/");
  }
  fmt::print("\n{:<16}{:>10}  |{:>9}{:>9}{:>9}{:>7}{:>7}{:>7}", "scene", "particles", "build s",
             "alone s", "refit s", "B/p", "B/p", "B/p");
  if (with_embree) {
    fmt::print("  |{:>9}{:>9}{:>7}{:>7}  |{:>16}{:>7}{:>7}  |{:>9}{:>9}", "build s", "again s",
               "B/p", "B/p", "build s", "B/p", "B/p", "Motes", "Motes");
  }
  fmt::print("\n");
}

void print(const Row& row) {
  fmt::print("{:<16}{:>10}  |{:>9.4f}{:>9.4f}{:>9.4f}{:>7.1f}{:>7.1f}{:>7.1f}", row.scene->name,
             row.kernels, row.build.median_s(), row.tree.median_s(), row.refit.median_s(),
             row.per_kernel(row.particle_bytes + row.tree_bytes), row.per_kernel(row.tree_bytes),
             row.per_kernel(row.build.peak_bytes));
  if (row.embree) {
    const Row::Embree& embree = *row.embree;
    fmt::print("  |{:>9.4f}{:>9.4f}{:>7.1f}{:>7.1f}  |{:>16.4f}{:>7.1f}{:>7.1f}  |{:>9.2f}{:>9.2f}",
               embree.morton.median_s(), embree.morton_again.median_s(),
               row.per_kernel(embree.morton_tree.bytes), row.per_kernel(embree.morton.peak_bytes),
               embree.binned.median_s(), row.per_kernel(embree.binned_tree.bytes),
               row.per_kernel(embree.binned.peak_bytes), row.morton_ratio(), row.binned_ratio());
  }
  fmt::print("\n");
  std::fflush(stdout);
}

nlohmann::ordered_json to_json(const Row& row, const BenchJob& job) {
  const auto of_embree = [&](const StepResult& step, const EmbreeTree& tree) {
    return nlohmann::ordered_json{{"build_s", step.median_s()},
                                  {"builds", step.seconds.size()},
                                  {"nodes", tree.nodes},
                                  {"leaves", tree.leaves},
                                  {"tree_bytes", tree.bytes},
                                  {"tree_bytes_per_particle", row.per_kernel(tree.bytes)},
                                  {"peak_bytes_per_particle", row.per_kernel(step.peak_bytes)}};
  };
  nlohmann::ordered_json out{
      {"scene", row.scene->name},
      {"data", job.workplace.particle_file(*row.scene).string()},
      {"particles", row.kernels},
      {"motes",
       {{"build_s", row.build.median_s()},
        {"tree_alone_s", row.tree.median_s()},
        {"refit_s", row.refit.median_s()},
        {"builds", row.build.seconds.size()},
        {"bytes_per_particle", row.per_kernel(row.particle_bytes + row.tree_bytes)},
        {"tree_bytes", row.tree_bytes},
        {"tree_bytes_per_particle", row.per_kernel(row.tree_bytes)},
        {"peak_bytes_per_particle", row.per_kernel(row.build.peak_bytes)}}},
      {"embree_morton", nullptr},
      {"embree_default", nullptr}};
  if (!row.embree) return out;
  out["embree_morton"] = of_embree(row.embree->morton, row.embree->morton_tree);
  out["embree_morton"]["again_s"] = row.embree->morton_again.median_s();
  out["embree_default"] = of_embree(row.embree->binned, row.embree->binned_tree);
  out["embree_morton_over_motes"] = row.morton_ratio();
  out["embree_default_over_motes"] = row.binned_ratio();
  return out;
}

/// Times, and peaks of memory where the system tells them.
void write_charts(const BenchJob& job, const std::vector<Row>& rows) {
  BarChart times{"Build of the tree", "seconds", {}, {}};
  BarChart peaks{"Memory that the build takes at its peak", "bytes a particle", {}, {}, false};
  for (const Row& row : rows) {
    times.categories.emplace_back(row.scene->name);
    peaks.categories.emplace_back(row.scene->name);
  }
  const auto add = [&rows](BarChart& chart, const char* name, auto&& value) {
    chart.series.push_back({name, {}});
    for (const Row& row : rows) {
      const double v = value(row);
      chart.series.back().values.push_back(v > 0 ? std::optional(v) : std::nullopt);
    }
  };
  add(times, "Motes", [](const Row& row) { return row.build.median_s(); });
  add(peaks, "Motes", [](const Row& row) { return row.per_kernel(row.build.peak_bytes); });
  if (rows.front().embree) {
    add(times, "Embree, Morton", [](const Row& row) { return row.embree->fastest_s(); });
    add(times, "Embree, default", [](const Row& row) { return row.embree->binned.median_s(); });
    add(peaks, "Embree, Morton",
        [](const Row& row) { return row.per_kernel(row.embree->morton.peak_bytes); });
    add(peaks, "Embree, default",
        [](const Row& row) { return row.per_kernel(row.embree->binned.peak_bytes); });
  }
  add(times, "Motes, refit", [](const Row& row) { return row.refit.median_s(); });
  write_result_file(job, "build.svg", to_svg(times));
  write_result_file(job, "build_memory.svg", to_svg(peaks));
}

}  // namespace

void run_build(const BenchJob& job) {
  const std::unique_ptr<EmbreeBuilder> embree = make_embree_builder(job.options.threads);
  job.workplace.check_room(job.scenes, embree != nullptr ? embree_bytes : motes_bytes);
  fmt::print("{}, {}\n\n", machine_line(job.options),
             embree != nullptr
                 ? fmt::format("Embree {}", embree->version())
                 : "without Embree (script/bootstrap bench installs it; then build Motes again)");
  print_header(embree != nullptr);
  nlohmann::ordered_json json = nlohmann::json::array();
  std::vector<Row> rows;
  std::vector<double> ratios;
  for (const BenchScene* entry : job.scenes) {
    Console console;
    rows.push_back(measure_row(job, *entry, embree.get(), console));
    print(rows.back());
    json.push_back(to_json(rows.back(), job));
    if (embree != nullptr) ratios.push_back(rows.back().morton_ratio());
  }
  if (embree != nullptr) {
    fmt::print("\nEmbree's fastest / Motes: {:.2f} in the geometric mean, {:.2f} at least\n",
               geometric_mean(ratios), *std::ranges::min_element(ratios));
  }
  write_results(job, "build", json);
  write_charts(job, rows);
}

}  // namespace motes
