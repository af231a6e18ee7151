// motes render: particles to a picture.
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "image/write_image.h"
#include "motes/commands.h"
#include "motes/count_option.h"
#include "motes/frame_times.h"
#include "motes/input.h"
#include "motes/named_files.h"
#include "motes/picture_warnings.h"
#include "motes/prepare.h"
#include "motes/scene_options.h"
#include "motes/thread_limit.h"
#include "render/render_tile.h"
#include "render/renderer.h"

namespace motes {
namespace {

constexpr const char* examples =
    R"(Without options the camera holds all of the data, and colours and opacity are fitted to the
values in view. Options override what a scene says.

Examples:
  motes render silica.lammpstrj -o silica.png
  motes render silica.lammpstrj -o soft.png --types 1=Si,2=O --radius 1.2
  motes render box.hdf5 -o box.png --transfer-function magma --no-lighting --size 1920x1080
  motes render run.xyz.gz -o frame7.png --frame 7 --eye 0,0,-80 --target 0,0,0 --fov 30
  motes render scene.json -o picture.exr --stats stats.json --repeat 5
  motes render silica.lammpstrj -o silica.png --save-scene silica.json
  motes render density.cube -o density.png --interpolation tricubic

Reads LAMMPS dumps and data, XYZ, PDB, mmCIF, CIF, GRO, HDF5 of GADGET, AREPO, SWIFT, GIZMO and
Phantom, H5MD, CSV and NPY, and grids of NRRD, VTI, Gaussian cube and CHGCAR, also compressed with
gz, bz2, xz or zst.
MOTES_TARGET=SSE4, AVX2 or AVX-512 in the environment forces an instruction set.)";

struct Options {
  std::string path, output, stats, saved_scene;
  int threads = 0, repeat = 1;
  SceneChanges changes;
};

/// What --stats reports.
struct Statistics {
  double read_ms = 0, build_ms = 0;
  std::vector<double> frame_ms;
  std::size_t particles = 0, particle_bytes = 0, tree_bytes = 0;
  std::optional<std::size_t> grid_bytes;  ///< nullopt: there are no grids
  RenderStatistics frame;
};

std::string to_json(const Statistics& s) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  nlohmann::ordered_json stages;
  for (std::size_t i = 0; i < num_stages; ++i) {
    stages[stage_names[i]] = s.frame.stages.fraction(static_cast<Stage>(i));
  }
  nlohmann::ordered_json out{{"frame_ms", median(s.frame_ms)},
                             {"frame_ms_min", *std::ranges::min_element(s.frame_ms)},
                             {"build_ms", s.build_ms},
                             {"read_ms", s.read_ms},
                             {"particles", s.particles},
                             {"samples", s.frame.samples},
                             {"kernel_evaluations", s.frame.kernel_evaluations},
                             {"stages", stages},
                             {"particle_bytes", s.particle_bytes},
                             {"tree_bytes", s.tree_bytes},
                             {"peak_rss_bytes", usage.ru_maxrss * 1024},
                             {"threads", s.frame.threads},
                             {"engine", s.frame.engine},
                             {"instruction_set", s.frame.instruction_set}};
  if (s.grid_bytes) out["grid_bytes"] = *s.grid_bytes;
  return out.dump(2) + "\n";
}

/// Renders one frame, or more to time them: the first of several only warms up.
Framebuffer render_frames(const Renderer& renderer, const ResolvedScene& scene,
                          const Options& options, Console& console, Statistics& statistics) {
  const RenderOptions render_options{options.threads, std::nullopt, &console};
  Framebuffer image;
  for (int frame = options.repeat > 1 ? -1 : 0; frame < options.repeat; ++frame) {
    renderer.render(scene, render_options, image, &statistics.frame);
    if (frame >= 0) statistics.frame_ms.push_back(statistics.frame.frame_ms);
  }
  console.finish();
  return image;
}

void run(const Options& options) {
  Console console;
  const ThreadLimit limit(options.threads);
  // Told at once, not after long work: a MOTES_TARGET that is not to be had, an output that cannot
  // be written.
  instruction_set();
  const ImageFormat format = image_format(options.output);
  const NamedFiles outputs{{"--output", options.output},
                           {"--stats", options.stats},
                           {"--save-scene", options.saved_scene}};
  refuse_same_file(outputs, {"FILE", options.path});
  AtomicFile output(options.output);
  std::optional<AtomicFile> stats, saved_scene;
  if (!options.stats.empty()) stats.emplace(options.stats);
  if (!options.saved_scene.empty()) saved_scene.emplace(options.saved_scene);

  Scene scene = open_scene(options.path);
  refuse_same_file(outputs, {"data.path", scene.data_path});
  for (const Field& field : scene.fields) {
    if (field.grid && !field.grid->path.empty()) {
      refuse_same_file(outputs, {"fields.grid", field.grid->path});
    }
  }
  options.changes.apply(scene);
  Statistics statistics;
  const PreparedScene prepared =
      read_and_prepare_scene(scene, options.path, options.changes, console);
  const Renderer& renderer = prepared.renderer;
  if (saved_scene) {
    const std::filesystem::path directory =
        std::filesystem::path(options.saved_scene).parent_path();
    saved_scene->write(scene_to_json(prepared.filled_in, directory));
  }
  const bool between_samples =
      warn_of_large_steps(renderer, prepared.resolved.step_size, console.warnings());
  statistics.read_ms = prepared.read_ms;
  statistics.build_ms = renderer.build_ms();
  statistics.particles = renderer.kernels().size();
  statistics.particle_bytes = renderer.kernels().particle_bytes();
  statistics.tree_bytes = renderer.kernels().bvh.bytes();
  if (!renderer.grids().empty()) statistics.grid_bytes = num_bytes(renderer.grids());

  const Framebuffer image = with_place(options.path, options.changes, [&] {
    return render_frames(renderer, prepared.resolved, options, console, statistics);
  });
  warn_of_empty_picture(image, renderer, prepared.resolved, prepared.extent, between_samples,
                        console.warnings());
  write_image(output, format, image, scene.render.termination_opacity, scene.render.background);
  output.commit();
  if (saved_scene) saved_scene->commit();
  if (stats) {
    stats->write(to_json(statistics));
    stats->commit();
  }
}

/// Refuses a name whose format is not known while it is still a matter of the command line.
std::string check_suffix(const std::string& path) {
  try {
    image_format(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

void add_render_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("render", "Make a picture of particles.");
  const auto options = std::make_shared<Options>();
  command->add_option("FILE", options->path, "particles, grids, or a scene")
      ->required()
      ->type_name("");
  command->add_option("-o,--output", options->output, "picture: .png, .jpg, .exr or .npy")
      ->required()
      ->type_name("OUT")
      ->check(CLI::Validator(check_suffix, ""));
  add_picture_options(*command, options->changes);
  add_field_options(*command, options->changes);
  add_data_options(*command, options->changes);
  add_count(*command, "--threads", options->threads, 4096, "threads to use (default: all cores)");
  command
      ->add_option("--save-scene", options->saved_scene,
                   "write the scene with all that was fitted, to change and render again")
      ->type_name("SCENE.json");
  command->add_option("--stats", options->stats, "write times and counts as JSON")
      ->type_name("STATS.json");
  add_count(*command, "--repeat", options->repeat, 1000000,
            "time N frames after one to warm up (default: 1)");
  command->footer(examples);
  command->callback([options] { run(*options); });
}

}  // namespace motes
