// The particles' fields on a lattice: grids of them.
#pragma once

#include <vector>

#include "core/report.h"
#include "field/kernel_set.h"
#include "grid/lattice.h"
#include "particles/grid.h"

namespace motes {

/// The fields of `kernels` at the samples of `lattice`: one grid a field, in their order and with
/// their names; unit of length left unknown. Not interpolated from anything: each sample is the sum
/// of all kernels that reach it (docs/field.md), in single precision. On all threads; the same
/// whatever their number. Throws Error, before the memory is taken, for a field whose kernels are
/// so high or low that floats do not hold their sums, and std::bad_alloc.
std::vector<Grid> resample(const KernelSet& kernels, const Lattice& lattice,
                           Progress* progress = nullptr);

}  // namespace motes
