// Shapes carved out of periodic blocks of atoms.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "motes/bench/random.h"
#include "particles/particle_set.h"

namespace motes {

/// Atoms of one period of a rectangular crystal or glass; positions from 0 to `size`.
struct Block {
  std::vector<Vector3d> positions;
  std::vector<std::uint16_t> species;
  Vector3d size;
};

/// The block that `particles`, whose cell is rectangular, are one period of.
inline Block make_block(const ParticleSet& particles) {
  Block block;
  const Cell& cell = particles.cell.value();
  for (int axis = 0; axis < 3; ++axis) {
    block.size[axis] = cell.vectors[static_cast<std::size_t>(axis)][axis];
  }
  for (std::size_t i = 0; i < particles.size(); ++i) {
    block.positions.push_back(particles.position(i) - cell.origin);
    block.species.push_back(particles.species[i]);
  }
  return block;
}

/// Calls `visit(position, species)` for the atoms of copies of `block` that fill the cube from
/// -half to half; block by block, always in the same order.
template <class Visit>
void for_each_copy(const Block& block, double half, const Visit& visit) {
  int n[3];
  for (int axis = 0; axis < 3; ++axis) {
    n[axis] = static_cast<int>(std::ceil(2 * half / block.size[axis]));
  }
  for (int i = 0; i < n[0]; ++i) {
    for (int j = 0; j < n[1]; ++j) {
      for (int k = 0; k < n[2]; ++k) {
        const Vector3d corner{(i - 0.5 * n[0]) * block.size.x, (j - 0.5 * n[1]) * block.size.y,
                              (k - 0.5 * n[2]) * block.size.z};
        for (std::size_t a = 0; a < block.positions.size(); ++a) {
          visit(block.positions[a] + corner, block.species[a]);
        }
      }
    }
  }
}

/// Thermal noise of atom `index`.
inline Vector3d jitter(const Random& random, std::uint64_t index, double deviation) {
  return {deviation * random.normal(3 * index), deviation * random.normal(3 * index + 1),
          deviation * random.normal(3 * index + 2)};
}

inline void add_atom(ParticleSet& atoms, const Vector3d& position, std::uint16_t species) {
  atoms.x.push_back(static_cast<float>(position.x));
  atoms.y.push_back(static_cast<float>(position.y));
  atoms.z.push_back(static_cast<float>(position.z));
  atoms.species.push_back(species);
}

}  // namespace motes
