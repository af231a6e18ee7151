// Cells that a file gives as three edges and three angles.
#pragma once

#include <array>
#include <optional>

#include "particles/cell.h"

namespace motes {

/// The periodic cell of edges a, b, c and angles alpha (between b and c), beta, gamma in degrees: a
/// lies along x, b in the xy plane. Nothing for what is no cell, and for the placeholders with
/// edges of 0 or 1 that programs write.
std::optional<Cell> cell_from_angles(const std::array<double, 3>& edges,
                                     const std::array<double, 3>& angles);

}  // namespace motes
