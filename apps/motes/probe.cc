// motes probe: the fields' values and gradients at points.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>

#include "core/atomic_file.h"
#include "core/error.h"
#include "motes/commands.h"
#include "motes/input.h"
#include "motes/points.h"
#include "motes/scene_options.h"
#include "render/grid_fields.h"

namespace motes {
namespace {

constexpr const char* examples =
    R"(The points are lines of x,y,z, with a first line of names or without. Out comes, for each
point and each field NAME of the scene (without a scene: one field, all):
  x,y,z,NAME,NAME_dx,NAME_dy,NAME_dz,...

Examples:
  motes probe silica.lammpstrj --points points.csv -o values.csv
  echo 0,0,0 | motes probe silica.lammpstrj --points -
  motes probe scene.json --points line.csv --support-factor 4)";

struct Options {
  std::string path, points, output;
  SceneChanges changes;
};

/// A name as a CSV value: in quotes where it has to be.
std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"\n\r") == std::string::npos) return name;
  std::string out = "\"";
  for (const char c : name) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string to_csv(const std::vector<Point3d>& points, const std::vector<FieldSource>& fields,
                   const std::vector<FieldSample>& samples) {
  fmt::memory_buffer out;
  const auto end = std::back_inserter(out);
  fmt::format_to(end, "x,y,z");
  for (const FieldSource& field : fields) {
    fmt::format_to(end, ",{},{},{},{}", quoted(field.name), quoted(field.name + "_dx"),
                   quoted(field.name + "_dy"), quoted(field.name + "_dz"));
  }
  fmt::format_to(end, "\n");
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Points are given back as they came, digit for digit.
    fmt::format_to(end, "{},{},{}", points[i].x, points[i].y, points[i].z);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      const FieldSample& sample = samples[i * fields.size() + f];
      const Vector3d& g = sample.gradient;
      fmt::format_to(end, ",{:.9g},{:.9g},{:.9g},{:.9g}", sample.value, g.x, g.y, g.z);
    }
    fmt::format_to(end, "\n");
  }
  return fmt::to_string(out);
}

void run(const Options& options) {
  Console console;
  // Told at once, not after long work: an output that cannot be written, points that are none.
  std::optional<AtomicFile> output;
  if (!options.output.empty()) output.emplace(options.output);
  const std::vector<Point3d> points = read_points(options.points);

  Scene scene = open_scene(options.path);
  options.changes.apply(scene);
  const Input input = read_input(scene, console);
  const auto fields = with_place(options.path, options.changes, [&] {
    return make_field_sources(input.particles, expand_fields(scene, input.particles, input.grids),
                              scene.kernel, console.warnings(), &console, input.grids);
  });
  console.print_warnings();
  const KernelSet kernels = build_kernel_set(input.particles, fields);
  const GridFields grids =
      with_place(options.path, options.changes, [&] { return make_grid_fields(fields); });
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
  const std::string csv = to_csv(points, fields, probe(kernels, grids, points, nowhere));
  if (output) {
    output->write(csv);
    output->commit();
  } else if (std::fwrite(csv.data(), 1, csv.size(), stdout) != csv.size()) {
    throw Error("cannot write the standard output");
  }
}

}  // namespace

void add_probe_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("probe", "Print the fields' values and gradients at given points.");
  const auto options = std::make_shared<Options>();
  command->add_option("FILE", options->path, "particles, grids, or a scene")
      ->required()
      ->type_name("");
  command->add_option("--points", options->points, "CSV file of points, or - for standard input")
      ->required()
      ->type_name("P.csv");
  command
      ->add_option("-o,--output", options->output, "CSV file to write (default: standard output)")
      ->type_name("OUT.csv");
  add_data_options(*command, options->changes);
  add_field_options(*command, options->changes);
  command->footer(examples);
  command->callback([options] { run(*options); });
}

}  // namespace motes
