// motes resample: fields to grids.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/memory.h"
#include "grid/resample.h"
#include "grid/write_grid.h"
#include "motes/commands.h"
#include "motes/count_option.h"
#include "motes/input.h"
#include "motes/named_files.h"
#include "motes/scene_options.h"
#include "motes/thread_limit.h"
#include "render/render_tile.h"
#include "scene/fit.h"

namespace motes {
namespace {

constexpr const char* examples =
    R"(The grid covers the volume of the particles, to where the outermost kernels end. Each sample is the
field itself there, of all kernels that reach it. A scene's fields, if it has several, are the arrays
of one .vti; as .nrrd each gets a file of its own, OUT_NAME.nrrd.

Examples:
  motes resample silica.lammpstrj -o silica.vti
  motes resample silica.lammpstrj -o silica.nrrd --voxel-size 0.5
  motes resample snapshot_042.hdf5 -o box.nrrd --voxels 512
  motes resample scene.json -o fields.vti --voxels 100x100x200 --memory 8GB)";

struct Options {
  std::string path, output;
  std::optional<double> voxel_size;
  std::optional<std::array<std::size_t, 3>> voxels;  ///< one number: of the longest side, and two 0
  std::optional<std::uint64_t> memory;
  int threads = 0;
  SceneChanges changes;
};

bool is_vti(const std::filesystem::path& path) { return path.extension() == ".vti"; }

/// `name` as a part of a file's name.
std::string in_file_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return c < 128 && std::isalnum(c) == 0 && c != '-' && c != '.'; }, '_');
  return name;
}

/// Where each of the fields goes if the option was `output`, of NRRD.
std::vector<std::filesystem::path> nrrd_paths(const std::filesystem::path& output,
                                              const std::vector<FieldKernels>& fields) {
  if (fields.size() == 1) return {output};
  std::vector<std::filesystem::path> paths;
  std::set<std::string> names;
  for (const FieldKernels& field : fields) {
    const std::string name = in_file_name(field.name);
    if (!names.insert(name).second) {
      throw Error(output, fmt::format("two fields would be the file of '{}'; expected fields of "
                                      "different names, or a .vti",
                                      name));
    }
    std::filesystem::path path = output;
    path.replace_filename(output.stem().string() + "_" + name + output.extension().string());
    paths.push_back(path);
  }
  return paths;
}

/// The kernels of the scene's fields; what they were made of is gone.
struct Prepared {
  KernelSet kernels;
  std::string length_unit;
  double voxel_size;  ///< by default
};

Prepared prepare(const Scene& scene, const Options& options, Console& console) {
  for (const Field& field : scene.fields) {
    if (!field.grid) continue;
    throw Error(options.path, "has a field that is a grid already; expected fields of particles");
  }
  const Input input = read_particles(scene, console);
  return with_place(options.path, options.changes, [&]() -> Prepared {
    const auto fields = make_field_sources(input.particles, expand_fields(scene, input.particles),
                                           scene.kernel, console.warnings(), &console);
    console.print_warnings();
    if (fields.empty()) throw Error("has no field; expected one to resample");
    console.update("building the tree", 0);
    KernelSet kernels = build_kernel_set(input.particles, fields);
    console.finish();
    // (three digits: nobody wants to see a float's)
    const double size = std::stod(fmt::format("{:.3g}", default_step_size(fields, kernels.box())));
    return {std::move(kernels), input.particles.length_unit, size};
  });
}

Lattice choose_lattice(const Options& options, const Prepared& prepared) {
  const Bounds3d box = prepared.kernels.box();
  if (!options.voxels) {
    return lattice_of_size(box, options.voxel_size.value_or(prepared.voxel_size));
  }
  const auto& counts = *options.voxels;
  if (counts[1] != 0) return lattice_of_counts(box, counts);
  const Vector3d extent = box.diagonal();
  const double longest = std::max({extent.x, extent.y, extent.z});
  return lattice_of_size(box, longest / static_cast<double>(counts[0] - 1));
}

/// Where the samples are too far apart to show the fields.
void warn_of_large_voxels(const Options& options, const Lattice& lattice, const Prepared& prepared,
                          const std::vector<Grid>& grids, Warnings& warnings) {
  const auto& dims = lattice.dims;
  const bool chosen = options.voxels && (*options.voxels)[1] != 0;
  if (!chosen && dims == std::array<std::size_t, 3>{2, 2, 2}) {
    const Vector3d extent = prepared.kernels.box().diagonal();
    warnings.add(fmt::format(
        "the grid is a single voxel of {:.4g}, for the volume is {:.4g} x {:.4g} x {:.4g}; by "
        "default it would be {:.3g}",
        lattice.step.x, extent.x, extent.y, extent.z, prepared.voxel_size));
  }
  for (std::size_t f = 0; f < grids.size(); ++f) {
    const auto& values = grids[f].values;
    if (std::any_of(values.begin(), values.end(), [](float value) { return value != 0; })) continue;
    const FieldKernels& field = prepared.kernels.fields[f];
    warnings.add(fmt::format(
        "all {} x {} x {} samples of the field '{}' are 0: they are {:.4g} apart, its kernels "
        "{:.4g} wide or less; expected a smaller --voxel-size",
        dims[0], dims[1], dims[2], printable(field.name),
        std::min({lattice.step.x, lattice.step.y, lattice.step.z}),
        2 * field.kernel.support() * field.max_radius));
  }
}

void run(const Options& options) {
  Console console;
  const ThreadLimit limit(options.threads);
  // Told at once, not after long work: a MOTES_TARGET that is not to be had, an output that cannot
  // be written.
  instruction_set();
  const NamedFiles outputs{{"--output", options.output}};
  refuse_same_file(outputs, {"FILE", options.path});
  std::optional<AtomicFile> first(std::in_place, options.output);

  Scene scene = open_scene(options.path);
  refuse_same_file(outputs, {"data.path", scene.data_path});
  options.changes.apply(scene);
  const Prepared prepared = prepare(scene, options, console);
  const auto paths = is_vti(options.output) ? std::vector<std::filesystem::path>{options.output}
                                            : nrrd_paths(options.output, prepared.kernels.fields);
  std::vector<std::unique_ptr<AtomicFile>> files;
  first.reset();
  for (const auto& path : paths) {
    refuse_same_file({{"--output", path}}, {"data.path", scene.data_path});
    files.push_back(std::make_unique<AtomicFile>(path));
  }

  std::vector<Grid> grids = with_place(options.path, options.changes, [&] {
    const Lattice lattice = choose_lattice(options, prepared);
    expect_to_fit(lattice, prepared.kernels.fields.size(),
                  options.memory.value_or(available_memory()));
    std::vector<Grid> sampled = resample(prepared.kernels, lattice, &console);
    warn_of_large_voxels(options, lattice, prepared, sampled, console.warnings());
    return sampled;
  });
  console.update("writing", 0);
  for (Grid& grid : grids) grid.length_unit = prepared.length_unit;
  if (is_vti(options.output)) {
    write_vti(*files[0], grids);
  } else {
    for (std::size_t f = 0; f < files.size(); ++f) write_nrrd(*files[f], grids[f]);
  }
  for (const auto& file : files) file->commit();
}

std::string check_suffix(const std::string& path) {
  const auto suffix = std::filesystem::path(path).extension();
  if (suffix == ".vti" || suffix == ".nrrd") return "";
  return fmt::format("{}: expected a name that ends in .nrrd or .vti", printable(path, 400));
}

/// "500MB", "8G", "1e9".
std::uint64_t read_bytes(const std::string& text) {
  double number = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, number);
  std::string unit(end, last);
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  if (!unit.ends_with('B')) unit += 'B';
  const std::vector<std::string> units{"B", "KB", "MB", "GB", "TB"};
  const auto it = std::find(units.begin(), units.end(), unit);
  const double bytes = number * std::pow(1000, it - units.begin());
  if (error != std::errc{} || it == units.end() || !(bytes >= 0 && bytes < 1e18)) {
    throw CLI::ValidationError(
        fmt::format("--memory: expected a size as in 500MB or 8GB, found '{}'", printable(text)),
        CLI::ExitCodes::ValidationError);
  }
  return static_cast<std::uint64_t>(bytes);
}

void add_voxel_options(CLI::App& command, Options& options) {
  CLI::Option* const size =
      command
          .add_option_function<double>(
              "--voxel-size", [&](double v) { options.voxel_size = v; },
              "distance of samples (default: half of a small radius)")
          ->type_name("L")
          ->check(CLI::Validator(
              [](const std::string& text) -> std::string {
                double value = 0;
                const char* const last = text.data() + text.size();
                const auto [end, error] = std::from_chars(text.data(), last, value);
                if (error == std::errc{} && end == last && value > 0 && std::isfinite(value)) {
                  return "";
                }
                return fmt::format("expected a number greater than 0, found '{}'", printable(text));
              },
              ""));
  command
      .add_option_function<std::string>(
          "--voxels",
          [&](const std::string& text) {
            std::array<std::size_t, 3> counts{};
            std::size_t n = 0;
            const char* at = text.data();
            const char* const last = at + text.size();
            for (bool good = true; good && n < 3;) {
              const auto [end, error] = std::from_chars(at, last, counts[n++]);
              good = error == std::errc{} && counts[n - 1] >= 2 && counts[n - 1] <= 1 << 24;
              if (good && end == last && n != 2) {
                options.voxels = counts;
                return;
              }
              if (!good || end == last || *end != 'x') break;
              at = end + 1;
            }
            throw CLI::ValidationError(
                fmt::format("--voxels: expected N or NxNxN, whole numbers from 2 to {}, found '{}'",
                            1 << 24, printable(text)),
                CLI::ExitCodes::ValidationError);
          },
          "samples along the longest side, or along x, y and z")
      ->type_name("N|NxNxN")
      ->excludes(size);
}

}  // namespace

void add_resample_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("resample", "Make grids of the fields, for other programs.");
  const auto options = std::make_shared<Options>();
  command->add_option("FILE", options->path, "particles, or a scene")->required()->type_name("");
  command->add_option("-o,--output", options->output, "grid: .nrrd or .vti")
      ->required()
      ->type_name("OUT")
      ->check(CLI::Validator(check_suffix, ""));
  add_voxel_options(*command, *options);
  add_field_options(*command, options->changes);
  command->remove_option(command->get_option("--interpolation"));  // grids are not resampled
  add_data_options(*command, options->changes);
  command
      ->add_option_function<std::string>(
          "--memory", [options](const std::string& text) { options->memory = read_bytes(text); },
          "most memory that the grids may take, as in 500MB (default: what is free)")
      ->type_name("SIZE");
  add_count(*command, "--threads", options->threads, 4096, "threads to use (default: all cores)");
  command->footer(examples);
  command->callback([options] { run(*options); });
}

}  // namespace motes
