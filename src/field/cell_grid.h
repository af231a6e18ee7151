// A uniform grid of cells over the kernels: how Nanovol finds them (Reda et al. 2013).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/kernel_set.h"

namespace motes {

/// Cells of one size over the volume's box. Each lists the kernels whose supports' boxes reach into
/// it, by their index into the KernelSet. Lengths are internal.
struct CellGrid {
  Point3d corner;                       ///< least of all coordinates
  double per_length = 0;                ///< cells a length
  std::array<std::int64_t, 3> count{};  ///< along each axis
  std::vector<std::uint64_t> begin;     ///< into `kernels`; one a cell, x fastest, and the end
  std::vector<std::uint32_t> kernels;

  std::size_t bytes() const {
    return begin.size() * sizeof(begin[0]) + kernels.size() * sizeof(kernels[0]);
  }
  /// Number of the cell that holds p; -1 outside of all.
  std::int64_t cell_of(const Point3d& p) const {
    std::array<std::int64_t, 3> place;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = (p[axis] - corner[axis]) * per_length;
      const auto i = static_cast<std::size_t>(axis);
      if (!(at >= 0 && at < static_cast<double>(count[i]))) return -1;
      place[i] = static_cast<std::int64_t>(at);
    }
    return (place[2] * count[1] + place[1]) * count[0] + place[0];
  }
  std::span<const std::uint32_t> kernels_in(std::int64_t cell) const {
    const auto c = static_cast<std::size_t>(cell);
    return std::span(kernels).subspan(begin[c], begin[c + 1] - begin[c]);
  }
};

/// Cells as wide as a typical support, so that most kernels are in eight of them; larger ones where
/// radii differ so much that lists would have more than 32 entries a kernel, or there would be more
/// than four cells a kernel; none where no kernel is in a field. In parallel; deterministic. Throws
/// std::bad_alloc.
CellGrid build_cell_grid(const KernelSet& kernels);

}  // namespace motes
