// Finds the parts, types and units of a GADGET-style snapshot.
#include "io/gadget_hdf5.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include "core/error.h"
#include "io/companion.h"
#include "io/hdf5_columns.h"
#include "io/length_unit.h"
#include "particles/smoothing.h"

namespace motes {

namespace {

constexpr std::size_t num_types = 7;

const std::vector<ColumnName>& column_names() {
  static const std::vector<ColumnName> names{
      {"Masses", {"mass"}},
      {"Density", {"density"}},
      {"Densities", {"density"}},
      {"SmoothingLength", {"h"}},
      {"SmoothingLengths", {"h"}},
      {"SubfindHsml", {"h"}},
      {"Velocities", {"vx", "vy", "vz"}},
      {"Volume", {"volume"}},
      {"Volumes", {"volume"}},
  };
  return names;
}

std::string type_group(std::size_t type) { return fmt::format("PartType{}", type); }

bool is_swift(const Hdf5File& file) {
  return file.text("Header", "Code") == "SWIFT" || file.text("Code", "Code") == "SWIFT";
}

std::string_view species_name(std::size_t type, bool swift) {
  constexpr std::array<std::string_view, num_types> gadget{
      "gas", "dark matter", "disk", "bulge", "stars", "black holes", "neutrinos"};
  constexpr std::array<std::string_view, num_types> swifts{
      "gas", "dark matter", "background dark matter", "sinks", "stars", "black holes", "neutrinos"};
  return swift ? swifts[type] : gadget[type];
}

/// Opens the other files of the snapshot that `file` is one of.
/// What stands before and after the number in the name of one of a snapshot's files.
struct PartName {
  std::string before, after;
};

/// Of a name such as snapshot.0.hdf5 or snapshot.0.hdf5.gz.
std::optional<PartName> split_part_name(const std::string& name) {
  const std::size_t end = name.size() - (name.ends_with(".gz") ? 3 : 0);
  const std::size_t suffix = name.rfind('.', end - 1);
  if (suffix == 0 || suffix == std::string::npos || suffix + 1 >= end) return std::nullopt;
  const std::size_t dot = name.rfind('.', suffix - 1);
  if (dot == std::string::npos || dot + 1 == suffix) return std::nullopt;
  const std::size_t other = name.find_first_not_of("0123456789", dot + 1);
  if (other != suffix) return std::nullopt;
  return PartName{name.substr(0, dot + 1), name.substr(suffix)};
}

std::vector<Hdf5File> open_parts(Hdf5File file, const ReadOptions& options) {
  const double num_files = file.number("Header", "NumFilesPerSnapshot").value_or(1);
  std::vector<Hdf5File> parts;
  if (!(num_files > 1)) {
    parts.push_back(std::move(file));
    return parts;
  }
  constexpr double most_files = 65536;
  const std::filesystem::path path = file.path();
  const std::optional<PartName> name = split_part_name(path.filename().string());
  if (num_files > most_files || !name) {
    throw Error(path, fmt::format("says that it is one of {} files; expected a name such as "
                                  "snapshot.0.hdf5",
                                  num_files));
  }
  for (int part = 0; part < static_cast<int>(num_files); ++part) {
    const std::filesystem::path part_path =
        companion_of(path, name->before + std::to_string(part) + name->after);
    if (!std::filesystem::exists(part_path)) {
      throw Error(part_path,
                  fmt::format("is missing; expected all {} files of the snapshot", num_files));
    }
    parts.emplace_back(part_path, options);
  }
  return parts;
}

/// Throws Error unless the file has as many particles of the type as its header says.
void check_count(const Hdf5File& file, std::size_t type, std::uint64_t count) {
  const auto counts = file.numbers("Header", "NumPart_ThisFile");
  if (!counts || type >= counts->size()) return;
  const double expected = (*counts)[type];
  if (expected != static_cast<double>(count)) {
    file.fail(type_group(type),
              fmt::format("has {} particles; expected {}, as the header says", count, expected));
  }
}

/// The blocks of one type: a block for each file that has such particles.
std::vector<Hdf5Block> find_blocks(const std::vector<Hdf5File>& parts, const std::string& group,
                                   std::optional<std::size_t> type, std::uint64_t first) {
  std::vector<Hdf5Block> blocks;
  for (const Hdf5File& part : parts) {
    Hdf5Block block{&part, group, first, 0};
    if (block.has("Coordinates")) block.count = count_positions(part, block.dataset("Coordinates"));
    if (type) check_count(part, *type, block.count);
    if (block.count == 0) continue;
    if (!blocks.empty() && part.members(group) != blocks.front().file->members(group)) {
      part.fail(group, fmt::format("has other datasets than in {}",
                                   printable(blocks.front().file->path().string(), 200)));
    }
    first += block.count;
    blocks.push_back(std::move(block));
  }
  return blocks;
}

/// The particles of one type, a range of the ParticleSet.
struct TypeRange {
  std::size_t type, first, count;
  template <class T>
  std::span<T> of(std::vector<T>& values) const {
    return {values.data() + first, count};
  }
};

class GadgetSnapshot : public Trajectory {
 public:
  GadgetSnapshot(std::vector<Hdf5File> parts, const ReadOptions& options)
      : parts_(std::move(parts)), options_(options), swift_(is_swift(parts_.front())) {}

  std::string_view format() const override { return swift_ ? "SWIFT HDF5" : "GADGET HDF5"; }
  std::size_t num_frames() override { return 1; }
  ParticleSet read_frame(std::size_t frame) override;

 private:
  const Hdf5File& header() const { return parts_.front(); }
  void read_cell_and_time(ParticleSet& particles) const;
  std::string length_unit() const;
  void add_table_masses(const std::vector<TypeRange>& types, ParticleSet& particles) const;
  void add_radii(const std::vector<TypeRange>& types, ParticleSet& particles) const;
  bool set_radii(const TypeRange& type, ParticleSet& particles, std::vector<float>& radius) const;

  std::vector<Hdf5File> parts_;
  ReadOptions options_;
  bool swift_;
};

ParticleSet GadgetSnapshot::read_frame(std::size_t frame) {
  if (frame > 0) throw_no_such_frame(header().path(), frame, 1);
  ParticleSet particles;
  std::vector<Hdf5Block> blocks;
  std::vector<TypeRange> types;
  std::uint64_t num_particles = 0;
  const auto add_blocks = [&](const std::string& group, std::optional<std::size_t> type) {
    std::uint64_t count = 0;
    for (Hdf5Block& block : find_blocks(parts_, group, type, num_particles)) {
      count += block.count;
      blocks.push_back(std::move(block));
    }
    if (count == 0) return;
    types.push_back({type.value_or(0), num_particles, count});
    num_particles += count;
    if (type) {
      particles.species.resize(num_particles, particles.species_index(species_name(*type, swift_)));
    }
  };
  if (header().has_dataset("Coordinates")) {
    add_blocks("/", std::nullopt);
  } else {
    for (std::size_t type = 0; type < num_types; ++type) add_blocks(type_group(type), type);
  }
  read_columns(blocks, "Coordinates", "ParticleIDs", column_names(), options_, particles);
  particles.length_unit = length_unit();
  read_cell_and_time(particles);
  add_table_masses(types, particles);
  add_radii(types, particles);
  return particles;
}

void GadgetSnapshot::read_cell_and_time(ParticleSet& particles) const {
  particles.time = header().number("Header", "Time");
  auto edges = header().numbers("Header", "BoxSize").value_or(std::vector<double>{});
  if (edges.size() == 1) edges.resize(3, edges[0]);
  if (edges.size() < 3 || !std::all_of(edges.begin(), edges.end(),
                                       [](double e) { return e > 0 && std::isfinite(e); })) {
    return;
  }
  particles.cell =
      Cell{{}, {Vector3d{edges[0], 0, 0}, Vector3d{0, edges[1], 0}, Vector3d{0, 0, edges[2]}}, {}};
  // Runs in open space have a BoxSize too, which means nothing: their particles lie around 0.
  const Bounds3d box = particles.bounds();
  const auto inside = [&](std::size_t axis) {
    const int a = static_cast<int>(axis);
    const double tolerance = 1e-3 * edges[axis];
    return box.min[a] >= -tolerance && box.max[a] <= edges[axis] + tolerance;
  };
  const bool periodic = !box.empty() && inside(0) && inside(1) && inside(2);
  particles.cell->periodic.fill(periodic);
}

std::string GadgetSnapshot::length_unit() const {
  if (const auto cm = header().number("Units", "Unit length in cgs (U_L)"); cm && swift_) {
    return length_unit_name(*cm);
  }
  std::optional<double> cm;
  double hubble = 1;
  for (const char* group : {"Header", "Parameters"}) {
    for (const char* name : {"UnitLength_in_cm", "UnitLength_In_CGS"}) {
      if (!cm) cm = header().number(group, name);
    }
    if (const auto h = header().number(group, "HubbleParam"); h && *h > 0) hubble = *h;
  }
  // GADGET's own unit, where a cosmological snapshot does not say another.
  const bool cosmological = header().number("Header", "Omega0").value_or(0) > 0;
  constexpr double kpc = 3.085678e21;
  if (!cm && !cosmological) return "unknown";
  return length_unit_name(cm.value_or(kpc)) + (hubble != 1 ? "/h" : "");
}

std::vector<float>* find_values(ParticleSet& particles, std::string_view name) {
  for (Property& property : particles.properties) {
    if (property.name == name) return &property.values;
  }
  return nullptr;
}

void GadgetSnapshot::add_table_masses(const std::vector<TypeRange>& types,
                                      ParticleSet& particles) const {
  const auto table = header().numbers("Header", "MassTable");
  if (!table) return;
  for (const TypeRange& type : types) {
    if (type.type >= table->size() || !((*table)[type.type] > 0)) continue;
    std::vector<float>* mass = find_values(particles, "mass");
    if (mass == nullptr) {
      particles.properties.push_back(
          {"mass", std::vector<float>(particles.size(), std::numeric_limits<float>::quiet_NaN())});
      mass = &particles.properties.back().values;
    }
    for (float& m : type.of(*mass)) {
      if (std::isnan(m)) m = static_cast<float>((*table)[type.type]);
    }
  }
}

void GadgetSnapshot::add_radii(const std::vector<TypeRange>& types, ParticleSet& particles) const {
  std::vector<float> radius(particles.size(), std::numeric_limits<float>::quiet_NaN());
  bool any = false;
  for (const TypeRange& type : types) {
    const bool given = set_radii(type, particles, radius);
    any = any || given;
    particles.radii_from_neighbors = particles.radii_from_neighbors || !given;
  }
  if (any) particles.properties.push_back({"radius", std::move(radius)});
}

/// Sets the radii of one type, from what the file has of it; false if it has nothing.
bool GadgetSnapshot::set_radii(const TypeRange& type, ParticleSet& particles,
                               std::vector<float>& radius) const {
  const auto values = [&](std::string_view name) -> std::span<float> {
    std::vector<float>* all = find_values(particles, name);
    if (all == nullptr) return {};
    const std::span<float> own = type.of(*all);
    const bool given = std::any_of(own.begin(), own.end(), [](float v) { return !std::isnan(v); });
    return given ? own : std::span<float>{};
  };
  const std::span<float> out = type.of(radius);
  double scale = support_per_sigma;
  if (const auto h = values("h"); !h.empty()) {
    // NaN would ask for the distance to neighbours.
    std::transform(h.begin(), h.end(), out.begin(), [](float v) { return std::isnan(v) ? 0 : v; });
    if (swift_) scale = 2;  // SWIFT's h is twice the standard deviation whatever its kernel
  } else {
    const auto mass = values("mass"), density = values("density"), volume = values("volume");
    if (volume.empty() && (mass.empty() || density.empty())) return false;
    const std::vector<float> support =
        volume.empty()
            ? smoothing_lengths_from_density(mass, density)
            : smoothing_lengths_from_density(volume, std::vector<float>(volume.size(), 1.0F));
    std::copy(support.begin(), support.end(), out.begin());
  }
  for (float& r : out) r = static_cast<float>(r / scale);
  return true;
}

}  // namespace

bool is_gadget_hdf5(const Hdf5File& file) {
  if (file.has_dataset("Coordinates")) return true;
  for (std::size_t type = 0; type < num_types; ++type) {
    if (file.has_group(type_group(type))) return true;
  }
  return false;
}

std::unique_ptr<Trajectory> open_gadget_hdf5(Hdf5File file, const ReadOptions& options) {
  return std::make_unique<GadgetSnapshot>(open_parts(std::move(file), options), options);
}

}  // namespace motes
