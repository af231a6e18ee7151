// What a scene takes of its data.
#pragma once

#include <vector>

#include "core/report.h"
#include "particles/particle_set.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace motes {

/// The fields of a scene, one by one, and what its geometry draws.
struct GatheredScene {
  std::vector<Field> all_fields;     ///< that the scene comes to (expand_fields())
  std::vector<Field> fields;         ///< of these, the visible ones
  std::vector<FieldSource> sources;  ///< one a visible field
  GeometrySource geometry;
};

/// Colours `scene` by species first, where it leaves that to the data. Throws Error, which names the
/// key, for what the data do not have.
GatheredScene gather(Scene& scene, const ParticleSet& particles,
                     const std::vector<LoadedGrid>& grids, Progress* progress, Warnings& warnings);

/// What is left open, fitted to the data.
ResolvedScene resolve(const Scene& scene, const GatheredScene& gathered,
                      const ParticleSet& particles, const Renderer& renderer, Progress* progress);

/// `scene` with all that was fitted, fields that are not visible in their places.
Scene fill_in(const Scene& scene, const GatheredScene& gathered, const ResolvedScene& resolved);

}  // namespace motes
