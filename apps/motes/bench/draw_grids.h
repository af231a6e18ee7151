// Pictures of grids, as the renderer makes them of particles: what the benchmarks hold the field
// against.
#pragma once

#include <vector>

#include "grid/grid_sampler.h"
#include "grid/macro_cells.h"
#include "image/framebuffer.h"
#include "particles/grid.h"
#include "scene/scene.h"

namespace motes {

/// Fields on one lattice, ready to be sampled.
class DrawnGrids {
 public:
  /// Grids of one lattice, and the box outside which nothing is sampled, within their hull.
  DrawnGrids(const std::vector<Grid>& grids, Reconstruction reconstruction, const Bounds3d& box);

  const std::vector<GridSampler>& samplers() const { return samplers_; }
  const std::vector<MacroCells>& macro_cells() const { return macro_cells_; }
  const Bounds3d& box() const { return box_; }
  /// Memory of the samples or coefficients.
  std::size_t num_bytes() const;

 private:
  std::vector<GridSampler> samplers_;
  std::vector<MacroCells> macro_cells_;
  Bounds3d box_;
};

/// Renders the fields with a scene's transfer functions, one a field, its camera, lighting, step
/// and termination: the same samples as of its particles, by pass 2 of the engines. Where a block
/// of rays passes through macro cells in which nothing is seen, nothing is sampled. On all threads.
void draw_grids(const DrawnGrids& fields, const ResolvedScene& scene, Framebuffer& image);

}  // namespace motes
