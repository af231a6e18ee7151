// The fields of a picture that are grids, ready to be sampled: what rendering keeps of them.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/vec.h"
#include "field/kernel_set.h"
#include "field/probe.h"
#include "grid/grid_sampler.h"
#include "grid/macro_cells.h"
#include "scene/scene.h"

namespace motes {

/// Field number `field` is this grid. Fields of one grid and interpolation share the rest.
struct GridField {
  std::size_t field = 0;
  std::shared_ptr<const GridSampler> sampler;
  std::shared_ptr<const MacroCells> cells;
};
using GridFields = std::vector<GridField>;

/// Makes those of `fields` ready that are grids; needs neither these nor their grids afterwards.
/// Throws Error as GridSampler does.
GridFields make_grid_fields(const std::vector<FieldSource>& fields);

/// Gives the fields of `kernels` that are grids what the buffer's units and pass 2 go by, and where
/// there are no particles a scale of lengths.
void set_units(const GridFields& grids, KernelSet& kernels);

/// Memory of the grids' arrays and macro cells, each counted once.
std::size_t num_bytes(const GridFields& grids);

/// The volume's one box: that of the kernels, and of all grids; file's lengths, world axes.
Bounds3d volume_box(const KernelSet& kernels, const GridFields& grids);

/// All fields at `points`, as probe() has it; `outside` is what a grid has beyond its hull.
std::vector<FieldSample> probe(const KernelSet& kernels, const GridFields& grids,
                               std::span<const Point3d> points, double outside);

}  // namespace motes
