// Atoms that come with a periodic grid, in the cell that the grid fills.
#pragma once

#include <vector>

#include "particles/particle_set.h"

namespace motes {

/// Moves positions, arrays of one length, by whole edges of the cell into it: to 0 or more and less
/// than 1 along each edge; what is within 1e-6 of 1 goes to 0. Precondition: the cell has a volume.
void move_into_cell(const Cell& cell, std::vector<double>& x, std::vector<double>& y,
                    std::vector<double>& z);

}  // namespace motes
