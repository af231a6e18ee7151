// Smoothing lengths of SPH and N-body particles, and the Gaussians that stand for their kernels.
//
// Codes name their smoothing lengths differently. Here H is the kernel's radius of support, beyond
// which it is zero, and sigma its standard deviation along one axis: the radius of the Gaussian
// that stands for it (Dehnen & Aly 2012, MNRAS 425, 1068, Table 1).
#pragma once

#include <span>
#include <vector>

#include "core/report.h"
#include "particles/neighbors.h"

namespace motes {

/// H / sigma of the cubic spline (GADGET, Phantom and most others).
inline constexpr double support_per_sigma = 2 * 1.825742;

/// How many particles lie within H where a file says nothing else: GADGET's customary number.
inline constexpr int num_smoothing_neighbors = 32;

/// H such that a sphere of radius H at the particle's density holds the mass of 32 particles:
/// (4/3) pi H^3 density = 32 mass. 0 where density or mass is not positive and finite.
/// Precondition: spans of one length. For Voronoi cells of volume V (AREPO) pass V and 1.
std::vector<float> smoothing_lengths_from_density(std::span<const float> mass,
                                                  std::span<const float> density);

/// H = the distance to the 32nd nearest neighbour. With fewer particles, the distance to the
/// farthest of them, scaled to 32 by the cube root; 0 for a lone particle and where the position is
/// not finite. Neighbours are looked for among all particles, but only for those `wanted` (all,
/// where that is empty); the others get 0.
std::vector<float> smoothing_lengths_from_neighbors(const Coordinates& coordinates,
                                                    const std::optional<Cell>& cell,
                                                    const std::vector<bool>& wanted = {},
                                                    Progress* progress = nullptr);

}  // namespace motes
