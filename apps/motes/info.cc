// motes info: what is in a file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "core/error.h"
#include "io/grid_reader.h"
#include "io/reader.h"
#include "motes/commands.h"
#include "motes/input.h"
#include "motes/scene_options.h"
#include "particles/radii.h"

namespace motes {
namespace {

constexpr const char* examples = R"(Examples:
  motes info silica.lammpstrj
  motes info trajectory.xyz.gz --frame 10
  motes info snapshot.hdf5 --json | jq .particles)";

struct Options {
  std::string path;
  bool json = false;
  SceneChanges changes;
};

struct FileInfo {
  std::string format;
  std::size_t num_frames = 0;
  std::uint64_t frame = 0;  // of these particles
  ParticleSet particles;
  std::vector<Grid> grids;
};

/// Of the values that are finite.
struct ValueRange {
  float min = std::numeric_limits<float>::infinity(), max = -min;
  std::size_t not_finite = 0;

  explicit ValueRange(std::span<const float> values) {
    for (const float v : values) {
      if (!std::isfinite(v)) {
        ++not_finite;
        continue;
      }
      min = std::min(min, v);
      max = std::max(max, v);
    }
  }
  bool empty() const { return !(min <= max); }
};

std::vector<std::size_t> count_species(const ParticleSet& particles) {
  std::vector<std::size_t> counts(particles.species_names.size());
  for (const std::uint16_t s : particles.species) ++counts[s];
  return counts;
}

nlohmann::ordered_json to_json(const Vector3d& v) {
  return nlohmann::ordered_json::array({v.x, v.y, v.z});
}
nlohmann::ordered_json to_json(const Point3d& p) { return to_json(Vector3d(p)); }

const std::string& unit_of(const FileInfo& info) {
  const bool of_grids = info.particles.size() == 0 && !info.grids.empty();
  return of_grids ? info.grids.front().length_unit : info.particles.length_unit;
}

nlohmann::ordered_json to_json(const Grid& grid) {
  const ValueRange range(grid.values);
  nlohmann::ordered_json out{
      {"name", grid.name},
      {"size", grid.dims},
      {"spacing", {length(grid.steps[0]), length(grid.steps[1]), length(grid.steps[2])}},
      {"origin", to_json(grid.origin)},
      {"steps", {to_json(grid.steps[0]), to_json(grid.steps[1]), to_json(grid.steps[2])}},
      {"periodic", grid.periodic},
      {"range", nullptr},
      {"not_finite", range.not_finite},
      {"length_unit", grid.length_unit}};
  if (!range.empty()) out["range"] = {{"min", range.min}, {"max", range.max}};
  return out;
}

void print_json(const FileInfo& info) {
  using json = nlohmann::ordered_json;
  const ParticleSet& particles = info.particles;
  json out{
      {"format", info.format},    {"particles", particles.size()},     {"frames", info.num_frames},
      {"species", json::array()}, {"properties", json::array()},       {"cell", nullptr},
      {"cell_origin", nullptr},   {"periodic", {false, false, false}}, {"bounds", nullptr},
      {"time", nullptr},          {"length_unit", unit_of(info)},      {"grids", json::array()}};
  for (const Grid& grid : info.grids) out["grids"].push_back(to_json(grid));
  const auto counts = count_species(particles);
  for (std::size_t s = 0; s < counts.size(); ++s) {
    out["species"].push_back({{"name", particles.species_names[s]}, {"count", counts[s]}});
  }
  for (const Property& property : particles.properties) out["properties"].push_back(property.name);
  if (const auto& cell = particles.cell) {
    out["cell"] = {to_json(cell->vectors[0]), to_json(cell->vectors[1]), to_json(cell->vectors[2])};
    out["cell_origin"] = to_json(cell->origin);
    out["periodic"] = cell->periodic;
  }
  if (const Bounds3d bounds = particles.bounds(); !bounds.empty()) {
    out["bounds"] = {{"min", to_json(bounds.min)}, {"max", to_json(bounds.max)}};
  }
  if (particles.time) out["time"] = *particles.time;
  fmt::print("{}\n", out.dump(2, ' ', false, json::error_handler_t::replace));
}

void print_row(std::string_view name, std::string_view value) {
  fmt::print("{:<13} {}\n", name, printable(value, 1000));
}

/// Columns that are filled by name and value; the names' width is that of the longest.
void print_rows(std::string_view title,
                const std::vector<std::pair<std::string, std::string>>& rows) {
  std::size_t width = 16;
  for (const auto& row : rows) width = std::max(width, row.first.size());
  for (const auto& [name, value] : rows) {
    print_row(title, fmt::format("{:<{}} {}", name, width, value));
    title = "";
  }
}

std::string range_of(std::span<const float> values) {
  const ValueRange of(values);
  std::string range = of.empty() ? "no values" : fmt::format("{:g} to {:g}", of.min, of.max);
  if (of.not_finite > 0) range += fmt::format(", {} not finite", of.not_finite);
  return range;
}

void print_grid(const Grid& grid) {
  const auto& [nx, ny, nz] = grid.dims;
  print_rows("grid", {{printable(grid.name), range_of(grid.values)}});
  print_row("", fmt::format("{} x {} x {} samples, {:.6g} x {:.6g} x {:.6g} apart{}", nx, ny, nz,
                            length(grid.steps[0]), length(grid.steps[1]), length(grid.steps[2]),
                            grid.periodic ? "  periodic" : ""));
}

void print_table(const std::string& path, const FileInfo& info) {
  const ParticleSet& particles = info.particles;
  print_row("file", path);
  print_row("format", info.format);
  print_row("frames", fmt::format("{}", info.num_frames));
  if (info.num_frames > 1) print_row("frame", fmt::format("{}", info.frame));
  for (const Grid& grid : info.grids) print_grid(grid);
  print_row("particles", fmt::format("{}", particles.size()));
  const auto counts = count_species(particles);
  std::vector<std::pair<std::string, std::string>> species, properties;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    species.emplace_back(printable(particles.species_names[s]), fmt::format("{}", counts[s]));
  }
  for (const Property& property : particles.properties) {
    properties.emplace_back(printable(property.name), range_of(property.values));
  }
  print_rows("species", species);
  print_rows("properties", properties);
  if (particles.size() > 0) print_row("radius", default_radii_source(particles));
  if (!particles.bonds.empty()) print_row("bonds", fmt::format("{}", particles.bonds.size()));
  print_row("length unit", unit_of(info));
  if (particles.time) print_row("time", fmt::format("{:g}", *particles.time));
  if (const Bounds3d b = particles.bounds(); !b.empty()) {
    for (int axis = 0; axis < 3; ++axis) {
      print_row(axis == 0 ? "bounds" : "",
                fmt::format("{} {:.7g} to {:.7g}", "xyz"[axis], b.min[axis], b.max[axis]));
    }
  }
  if (const auto& cell = particles.cell) {
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const Vector3d& v = cell->vectors[i];
      print_row(k == 0 ? "cell" : "", fmt::format("{} {:.7g}, {:.7g}, {:.7g}{}", "abc"[k], v.x, v.y,
                                                  v.z, cell->periodic[i] ? "  periodic" : ""));
    }
  }
}

void run(const Options& options) {
  Console console;
  Scene scene = open_scene(options.path);
  options.changes.apply(scene);
  const ReadOptions read_options{scene.types, &console, &console.warnings()};
  if (scene.data_path.empty()) {
    throw Error(options.path, "has no data.path; expected one, or the file of a grid");
  }
  FileInfo info;
  info.frame = scene.frame;
  const bool has_grids = is_grid_file(scene.data_path);
  if (has_grids) info.grids = read_grids(scene.data_path, read_options);
  if (has_grids && !has_particles(scene.data_path)) {
    info.format = grid_format(scene.data_path);
    info.num_frames = 1;
  } else {
    const auto trajectory = open_trajectory(scene.data_path, read_options);
    info.format = trajectory->format();
    info.particles = trajectory->read_frame(scene.frame);
    info.num_frames = trajectory->num_frames();
  }
  console.print_warnings();
  if (options.json) {
    print_json(info);
  } else {
    print_table(scene.data_path.string(), info);
  }
}

}  // namespace

void add_info_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "info", "Say what is in a file: format, particles, species, properties, cell, bounds.");
  const auto options = std::make_shared<Options>();
  command->add_option("FILE", options->path, "particles, grids, or a scene")
      ->required()
      ->type_name("");
  add_data_options(*command, options->changes);
  command->add_flag("--json", options->json, "print JSON instead of a table");
  command->footer(examples);
  command->callback([options] { run(*options); });
}

}  // namespace motes
