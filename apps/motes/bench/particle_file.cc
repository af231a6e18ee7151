// Packs rows, a piece of them at a time.
#include "motes/bench/particle_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

namespace motes {

void write_npy_particles(AtomicFile& file, const ParticleSet& particles) {
  static_assert(std::endian::native == std::endian::little, "the header says little endian");
  std::vector<const std::vector<float>*> columns{&particles.x, &particles.y, &particles.z};
  std::size_t species_width = 0;
  if (!particles.species.empty()) {
    for (const std::string& name : particles.species_names) {
      species_width = std::max(species_width, name.size());
    }
  }
  std::string fields = "('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ";
  for (const Property& property : particles.properties) {
    fields += fmt::format("('{}', '<f4'), ", property.name);
    columns.push_back(&property.values);
  }
  if (species_width > 0) fields += fmt::format("('species', '|S{}'), ", species_width);
  std::string header = fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}",
                                   fields, particles.size());
  // Magic, version 1.0 and the length of the rest, which ends with a new line at a multiple of 64.
  constexpr std::size_t before = 10, alignment = 64;
  header.append(alignment - (before + header.size() + 1) % alignment, ' ');
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  file.write(std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(length & 0xffU) +
             static_cast<char>(length >> 8U) + header);

  const std::size_t row = columns.size() * sizeof(float) + species_width;
  constexpr std::size_t rows_at_a_time = 65536;
  for (std::size_t first = 0; first < particles.size(); first += rows_at_a_time) {
    const std::size_t count = std::min(rows_at_a_time, particles.size() - first);
    std::string bytes(count * row, '\0');
    for (std::size_t i = 0; i < count; ++i) {
      char* out = bytes.data() + i * row;
      for (const std::vector<float>* column : columns) {
        std::memcpy(out, &(*column)[first + i], sizeof(float));
        out += sizeof(float);
      }
      if (species_width > 0) {
        const std::string& name = particles.species_names[particles.species[first + i]];
        std::copy(name.begin(), name.end(), out);
      }
    }
    file.write(bytes);
  }
}

}  // namespace motes
