// Where the samples of a field are taken for a grid, and what memory that asks for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/vec.h"

namespace motes {

/// A lattice along the axes of the world: sample (i, j, k) is at origin + (i, j, k) * step, axis by
/// axis. File's lengths.
struct Lattice {
  Point3d origin;
  Vector3d step;  ///< > 0
  std::array<std::size_t, 3> dims{};
};

/// Samples a step of `voxel_size` apart that reach from face to face of `box`, or as little beyond
/// as a whole number of steps takes, the same on both sides. Throws Error for more than 2^24 along
/// an axis. Preconditions: the box has a size, voxel_size > 0.
Lattice lattice_of_size(const Bounds3d& box, double voxel_size);

/// From face to face of `box`, with so many samples (at least 2) along each axis.
Lattice lattice_of_counts(const Bounds3d& box, const std::array<std::size_t, 3>& dims);

/// Bytes of the samples of that many fields. In double: it may be any number.
double sample_bytes(const Lattice& lattice, std::size_t num_fields);

/// Throws Error, which says how much memory it would take and a voxel size that would do, if the
/// samples of so many fields do not fit into `limit` bytes.
void expect_to_fit(const Lattice& lattice, std::size_t num_fields, std::uint64_t limit);

}  // namespace motes
