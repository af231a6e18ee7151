// Radii that a scene takes from a table of elements.
#pragma once

#include <vector>

#include "core/report.h"
#include "particles/particle_set.h"
#include "scene/geometry.h"

namespace motes {

/// Radii by the particles' elements, one a particle, or one for all; file's length. Species that
/// are no elements have the mean radius of those that are, with a warning. Where no particle is of
/// an element all have their default_radii(), with a warning that says which those are: as standard
/// deviations of a Gaussian and as balls that touch their neighbours these have the same size. They
/// are found for those `wanted` alone (all, where that is empty); the others may have NaN.
std::vector<float> radii_by_element(const ParticleSet& particles, ElementRadius table,
                                    const std::vector<bool>& wanted, Warnings& warnings,
                                    Progress* progress = nullptr);

}  // namespace motes
