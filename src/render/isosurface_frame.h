// From a scene's isosurfaces to what rays can meet.
#pragma once

#include <cstdint>
#include <vector>

#include "isosurface/shade_isosurfaces.h"
#include "particles/particle_set.h"
#include "render/render_tile.h"
#include "scene/scene.h"
#include "surface/shade.h"

namespace motes {

/// Species of the kernels that were built from `sources` in `order`, in leaf order; empty if no
/// source asks for them.
std::vector<std::uint16_t> species_of_kernels(const ParticleSet& particles,
                                              const std::vector<FieldSource>& sources,
                                              const KernelOrder& order);

/// The isosurfaces of `scene` in the frame's view; `species` is that of the kernels. This and
/// `grids` outlive what is returned.
ShadedIsosurfaces make_isosurfaces(const ResolvedScene& scene, const FrameContext& context,
                                   const GridFields& grids, const ImagePlane& plane,
                                   const SurfaceShading& shading,
                                   const std::vector<std::uint16_t>& species);

}  // namespace motes
