// motes info: what is in a file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/error.h"
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

void print_json(const FileInfo& info) {
  using json = nlohmann::ordered_json;
  const ParticleSet& particles = info.particles;
  json out{{"format", info.format},
           {"particles", particles.size()},
           {"frames", info.num_frames},
           {"species", json::array()},
           {"properties", json::array()},
           {"cell", nullptr},
           {"cell_origin", nullptr},
           {"periodic", {false, false, false}},
           {"bounds", nullptr},
           {"time", nullptr},
           {"length_unit", particles.length_unit}};
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

std::string range_of(const Property& property) {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  std::size_t not_finite = 0;
  for (const float v : property.values) {
    if (!std::isfinite(v)) {
      ++not_finite;
      continue;
    }
    low = std::min(low, v);
    high = std::max(high, v);
  }
  std::string range = low <= high ? fmt::format("{:g} to {:g}", low, high) : "no values";
  if (not_finite > 0) range += fmt::format(", {} not finite", not_finite);
  return range;
}

void print_table(const std::string& path, const FileInfo& info) {
  const ParticleSet& particles = info.particles;
  print_row("file", path);
  print_row("format", info.format);
  print_row("frames", fmt::format("{}", info.num_frames));
  if (info.num_frames > 1) print_row("frame", fmt::format("{}", info.frame));
  print_row("particles", fmt::format("{}", particles.size()));
  const auto counts = count_species(particles);
  std::vector<std::pair<std::string, std::string>> species, properties;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    species.emplace_back(printable(particles.species_names[s]), fmt::format("{}", counts[s]));
  }
  for (const Property& property : particles.properties) {
    properties.emplace_back(printable(property.name), range_of(property));
  }
  print_rows("species", species);
  print_rows("properties", properties);
  if (particles.size() > 0) print_row("radius", default_radii_source(particles));
  if (!particles.bonds.empty()) print_row("bonds", fmt::format("{}", particles.bonds.size()));
  print_row("length unit", particles.length_unit);
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
  const auto trajectory = open_trajectory(scene.data_path, read_options);
  FileInfo info;
  info.format = trajectory->format();
  info.frame = scene.frame;
  info.particles = trajectory->read_frame(scene.frame);
  info.num_frames = trajectory->num_frames();
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
  command->add_option("FILE", options->path, "particles, or a scene")->required()->type_name("");
  add_data_options(*command, options->changes);
  command->add_flag("--json", options->json, "print JSON instead of a table");
  command->footer(examples);
  command->callback([options] { run(*options); });
}

}  // namespace motes
