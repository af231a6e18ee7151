// From particles and a scene with open ends to what is rendered: what `motes render`, `bench` and
// `view` share.
#pragma once

#include <string>
#include <vector>

#include "core/report.h"
#include "core/vec.h"
#include "particles/particle_set.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace motes {

/// What the fields and the geometry of a scene take of its data.
struct GatheredScene {
  std::vector<FieldSource> sources;  ///< one a visible field
  GeometrySource geometry;
};

/// `fields` are all that the scene comes to, visible or not (expand_fields()). Throws Error for
/// what asks for something that the data do not have.
GatheredScene gather_scene(const Scene& scene, const std::vector<Field>& fields,
                           const ParticleSet& particles, const std::vector<LoadedGrid>& grids,
                           Progress* progress, Warnings& warnings);

/// Says what is not seen of the data that `renderer` was made of: sticks, where atoms have no bonds
/// by distance, and samples of grids that are not finite.
void warn_of_what_is_missing(const ParticleSet& particles, const std::vector<FieldSource>& sources,
                             const GeometrySource& geometry, const Renderer& renderer,
                             Warnings& warnings);

/// Where the data are.
struct DataExtent {
  Bounds3d bounds;
  std::string length_unit;
};

/// Of the particles and the renderer's grids, which are those of `sources`.
DataExtent data_extent(const ParticleSet& particles, const Renderer& renderer,
                       const std::vector<FieldSource>& sources);

struct PreparedScene {
  Renderer renderer;
  ResolvedScene resolved;
  Scene filled_in;  ///< the scene with all that was fitted to the data
  DataExtent extent;
  double read_ms = 0;  ///< 0 where the particles were there already
};

/// Gathers the scene's fields of `particles`, builds the tree and fits what the scene leaves open;
/// `particles` and `grids` are not needed afterwards. Throws Error, which knows at most the scene's
/// key.
PreparedScene prepare_scene(Scene scene, const ParticleSet& particles,
                            const std::vector<LoadedGrid>& grids, Progress* progress,
                            Warnings& warnings);

}  // namespace motes
