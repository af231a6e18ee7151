// Fields resampled into grids, and these rendered.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "grid/lattice.h"
#include "particles/grid.h"
#include "render/renderer.h"

namespace motes {

/// Grids of all fields of `kernels`, one a field.
std::vector<std::shared_ptr<const Grid>> resample_all(const KernelSet& kernels,
                                                      const Lattice& lattice);

/// A renderer of fields that are grids.
Renderer make_grid_renderer(const std::vector<std::shared_ptr<const Grid>>& grids,
                            Reconstruction interpolation);

/// What it keeps of them: samples or coefficients.
std::size_t grid_bytes(const Renderer& renderer);

}  // namespace motes
