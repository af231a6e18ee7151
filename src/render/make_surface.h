// Balls and sticks over the particles of a tree.
#pragma once

#include <optional>
#include <vector>

#include "field/kernel_set.h"
#include "particles/particle_set.h"
#include "render/field_colors.h"
#include "scene/geometry.h"
#include "scene/scene.h"
#include "surface/surface.h"

namespace motes {

/// What draws `geometry`, whose bonds by distance are found first, and whose particles, listed in
/// `is_drawn` alone (pack_index()), are all in `kernels`; these were built from `sources` in
/// `order`, and must outlive the surface. A particle that several fields have is drawn once.
/// `field_values` become those of particles in their fields' colours, or empty.
Surface make_surface(const ParticleSet& particles, GeometrySource& geometry,
                     const std::vector<bool>& is_drawn, const std::vector<FieldSource>& sources,
                     const KernelOrder& order, const KernelSet& kernels, FieldValues& field_values);

/// What the tree needs to have the drawn particles that no field has, or nothing if there are none.
std::optional<FieldSource> find_drawn_only(const ParticleSet& particles,
                                           const GeometrySource& geometry,
                                           const std::vector<FieldSource>& sources);

/// Takes the list of what is drawn away, and gives one bit for each of so many particles in its
/// stead: balls then need no more memory while they are built than a field does.
std::vector<bool> pack_index(GeometrySource& geometry, std::size_t num_particles);
/// Makes the list again.
void unpack_index(const std::vector<bool>& is_drawn, GeometrySource& geometry);

}  // namespace motes
