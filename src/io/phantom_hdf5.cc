// Maps Phantom's names and types of particles.
#include "io/phantom_hdf5.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "io/hdf5_columns.h"
#include "io/in_memory.h"
#include "io/length_unit.h"
#include "particles/smoothing.h"

namespace motes {

namespace {

std::string species_name(std::int64_t type) {
  switch (type) {
    case 1:
      return "gas";
    case 3:
      return "boundary";
    case 4:
      return "stars";
    case 5:
      return "dark matter";
    case 6:
      return "bulge";
    default:  // 2 in old versions, 7 and more in new ones
      return "dust";
  }
}

/// Species from itype, and masses, which are one a type. The property itype is spent on it.
void set_types(const Hdf5File& file, ParticleSet& particles) {
  const Property* types = particles.find_property("itype");
  std::vector<double> mass_of_type;
  if (file.has_dataset("header/massoftype")) {
    mass_of_type = file.read<double>("header/massoftype");
  }
  std::vector<float> mass(particles.size(), std::numeric_limits<float>::quiet_NaN());
  particles.species.resize(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    // Negative types mark particles that are not active.
    const float value = types == nullptr ? 1 : std::abs(types->values[i]);
    const std::int64_t type = value < 128 ? static_cast<std::int64_t>(value) : 0;
    particles.species[i] = particles.species_index(species_name(type));
    const auto index = static_cast<std::size_t>(type - 1);
    if (index < mass_of_type.size() && mass_of_type[index] > 0) {
      mass[i] = static_cast<float>(mass_of_type[index]);
    }
  }
  std::erase_if(particles.properties, [](const Property& p) { return p.name == "itype"; });
  particles.properties.push_back({"mass", std::move(mass)});
}

void add_radii(ParticleSet& particles) {
  const Property* h = particles.find_property("h");
  if (h == nullptr) return;
  constexpr double support_per_h = 2;
  std::vector<float> radius(particles.size());
  for (std::size_t i = 0; i < radius.size(); ++i) {
    // A negative h marks a particle that was accreted: no picture takes a negative radius.
    radius[i] = static_cast<float>(h->values[i] * support_per_h / support_per_sigma);
  }
  particles.properties.push_back({"radius", std::move(radius)});
}

}  // namespace

bool is_phantom_hdf5(const Hdf5File& file) {
  return file.has_group("header") && file.has_dataset("particles/xyz");
}

std::unique_ptr<Trajectory> open_phantom_hdf5(Hdf5File file, const ReadOptions& options) {
  const std::vector<Hdf5Block> blocks{
      {&file, "particles", 0, count_positions(file, "particles/xyz")}};
  ParticleSet particles;
  read_columns(blocks, "xyz", "",
               {{"vxyz", {"vx", "vy", "vz"}}, {"h", {"h"}}, {"itype", {"itype"}}}, options,
               particles);
  particles.length_unit = "unknown";
  if (file.has_dataset("header/udist")) {
    particles.length_unit = length_unit_name(file.read<double>("header/udist").at(0));
  }
  if (file.has_dataset("header/time")) particles.time = file.read<double>("header/time").at(0);
  set_types(file, particles);
  add_radii(particles);
  if (options.warnings != nullptr && file.has_dataset("sinks/xyz")) {
    options.warnings->add(
        fmt::format("left out {} sink particles", count_positions(file, "sinks/xyz")));
  }
  std::vector<ParticleSet> frames;
  frames.push_back(std::move(particles));
  return std::make_unique<InMemoryTrajectory>("Phantom HDF5", file.path(), std::move(frames));
}

}  // namespace motes
