// motes bench: the options, and which benchmark they are for.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "motes/bench/benchmarks.h"
#include "motes/commands.h"
#include "motes/count_option.h"
#include "motes/scene_options.h"
#include "motes/thread_limit.h"
#include "render/render_tile.h"

namespace motes {
namespace {

constexpr const char* examples =
    R"(WHAT is one of:
  scenes    make the particles of the scenes
  table1    their sizes, memory and build times, beside the paper's Table 1
  table2    frames per second of all engines, far and close, beside the paper's Table 2
  build     build times and memory of the tree, beside Embree's
  fields    what more fields cost: particles shared out among them, or all in two
  kernels   frame times of kernels of other shapes beside those of Gaussians
  limit     what part of the machine's peak the sweep reaches, and where the rest goes
  lattice   frame times of lattices from 91 thousand to 82 million particles, unlit
  quality   the field of a fracture beside grids of it: errors of their pictures, memory, times
  radii     time of a kernel evaluation where radii differ by orders of magnitude
  threads   frame times of several threads beside those of one
  spheres   balls by the one tree, beside Embree's sphere geometry
  fig6      frames per second from a thousand to all particles of the cosmological box
  fig7      frames per second with rays that end early or late, and with passes of many samples
  fig8      pictures for several kernel scales (kappa), and their frames per second
  fig9      pictures for several support factors (sigma), and their frames per second
  view      the viewer on this machine: from the mouse's move to the picture of it

Scenes: zeolite, tryptophan, nanobowl, nanosphere_90k, nanosphere_740k, sio2, anp3, cosmology;
for view also files of scenes or particles.
Results are printed, and written to out/bench as JSON and SVG. What is missing of the scenes is made
first. docs/bench.md tells what each benchmark measures.

Examples:
  motes bench scenes sio2
  motes bench table1
  motes bench table2 --scenes zeolite,nanobowl
  motes bench view sio2 scene.json --size 1920x1080
  MOTES_TARGET=AVX2 motes bench table2 --repeat 9 --output out/avx2)";

struct Benchmark {
  std::string_view name;
  void (*run)(const BenchJob&);
  /// The scenes that it takes where none is named; none: all.
  std::array<std::string_view, 3> default_scenes = {};
  std::size_t most_scenes = std::numeric_limits<std::size_t>::max();
  bool takes_files = false;  ///< as scenes too; where nothing is named it knows what to take
};
constexpr Benchmark benchmarks[] = {
    {"scenes", run_scenes},
    {"table1", run_table1},
    {"table2", run_table2},
    {"build", run_build},
    {"fields", run_fields, {"zeolite", "tryptophan", "anp3"}},
    {"kernels", run_kernels, {"nanobowl", "nanosphere_90k"}},
    {"limit", run_limit},
    {"lattice", run_lattice, {}, 0},
    {"quality", run_quality, {}, 0},
    {"radii", run_radii, {}, 0},
    {"threads", run_threads, {"nanosphere_90k"}},
    {"spheres", run_spheres, {"sio2"}},
    {"fig6", run_fig6, {"cosmology"}, 1},
    {"fig7", run_fig7, {"cosmology"}, 1},
    {"fig8", run_fig8, {"nanobowl"}},
    {"fig9", run_fig9, {"nanobowl"}},
    {"view", run_view, {}, std::numeric_limits<std::size_t>::max(), true}};

struct Options {
  std::string what, data = "data/bench", output = "out/bench";
  std::vector<std::string> scenes;
  std::optional<double> memory_gib;
  SceneChanges size;
  BenchOptions bench;
};

/// A mistake in the value of `option`, told while it is still a matter of the command line.
template <class Check>
CLI::Validator validator(const Check& check) {
  return {[check](std::string& text) -> std::string {
            try {
              check(text);
            } catch (const Error& error) {
              return error.what();
            }
            return "";
          },
          ""};
}

const Benchmark& find_benchmark(const std::string& name) {
  const auto* it = std::ranges::find(benchmarks, name, &Benchmark::name);
  if (it != std::end(benchmarks)) return *it;
  std::vector<std::string> known;
  for (const Benchmark& each : benchmarks) known.emplace_back(each.name);
  throw unknown_name("benchmark", name, known);
}

bool is_file(const std::string& name) {
  std::error_code none;
  return std::filesystem::is_regular_file(name, none);
}

/// Takes those out of `names` that are no scene's of the catalogue but a file's.
std::vector<std::filesystem::path> take_files(const Benchmark& benchmark,
                                              std::vector<std::string>& names) {
  std::vector<std::filesystem::path> files;
  std::erase_if(names, [&](const std::string& name) {
    const bool known =
        std::ranges::find(bench_scenes(), name, &BenchScene::name) != bench_scenes().end();
    if (known) return false;
    files.emplace_back(name);
    return true;
  });
  if (!files.empty() && !benchmark.takes_files) {
    throw Error(fmt::format("{} takes scenes by their names; '{}' is a file", benchmark.name,
                            files.front().string()));
  }
  return files;
}

/// The scenes that are named, or those that the benchmark takes by itself.
std::vector<const BenchScene*> scenes_of(const Benchmark& benchmark,
                                         std::vector<std::string> names) {
  if (names.size() > benchmark.most_scenes) {
    throw Error(fmt::format("{} takes {}; {} named", benchmark.name,
                            benchmark.most_scenes == 0 ? "no scene" : "one scene",
                            names.size() == 1 ? "one is" : fmt::format("{} are", names.size())));
  }
  if (names.empty()) {
    for (const std::string_view name : benchmark.default_scenes) {
      if (!name.empty()) names.emplace_back(name);
    }
  }
  if (benchmark.most_scenes == 0 || (names.empty() && benchmark.takes_files)) return {};
  return find_bench_scenes(names);
}

void run(const Options& options) {
  instruction_set();  // tells at once of a MOTES_TARGET that is not to be had
  const ThreadLimit limit(options.bench.threads);
  std::optional<std::size_t> memory;
  if (options.memory_gib) memory = static_cast<std::size_t>(*options.memory_gib * 0x1p30);
  const Workplace workplace(options.data, options.output, memory);
  Scene scene;
  options.size.apply(scene);
  const Benchmark& benchmark = find_benchmark(options.what);
  std::vector<std::string> names = options.scenes;
  const std::vector<std::filesystem::path> files = take_files(benchmark, names);
  BenchJob job{workplace, scenes_of(benchmark, names), files, options.bench};
  job.options.width = scene.render.width;
  job.options.height = scene.render.height;
  benchmark.run(job);
}

}  // namespace

void add_bench_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("bench", "Measure Motes on the data sets of the paper.");
  const auto options = std::make_shared<Options>();
  command->add_option("WHAT", options->what, "which benchmark")
      ->required()
      ->type_name("")
      ->check(validator(find_benchmark));
  const CLI::Validator scene_name = validator([](const std::string& name) {
    if (!is_file(name)) find_bench_scenes({name});
  });
  CLI::Option* names = command
                           ->add_option("SCENE", options->scenes,
                                        "which scenes (default: all, or\nwhat docs/bench.md says)")
                           ->type_name("")
                           ->delimiter(',')
                           ->check(scene_name);
  command->add_option("--scenes", options->scenes, "the same, as A,B,...")
      ->type_name("A,B")
      ->delimiter(',')
      ->check(scene_name)
      ->excludes(names);
  add_size_option(*command, options->size);
  add_count(*command, "--repeat", options->bench.repeat, 1000,
            "frames, or builds, of which the median is\ntaken (default: 5)");
  add_count(*command, "--threads", options->bench.threads, 4096,
            "threads to use (default: all cores)");
  const CLI::Validator positive(
      [](const std::string& given) {
        double gib = 0;
        return CLI::detail::lexical_cast(given, gib) && gib > 0
                   ? std::string()
                   : fmt::format("expected a number greater than 0, found '{}'", given);
      },
      "");
  command->add_option("--memory", options->memory_gib, "most memory to use (default: what is free)")
      ->type_name("GIB")
      ->check(positive);
  command->add_option("--data", options->data, "Motes' data/bench (default: data/bench)")
      ->type_name("DIR");
  command->add_option("--output", options->output, "where results go (default: out/bench)")
      ->type_name("DIR");
  command->footer(examples);
  command->callback([options] { run(*options); });
}

}  // namespace motes
