// The numbers that a reconstruction weighs: a grid's samples or the B-spline's coefficients, with a
// border so that no point of the hull is special.
#pragma once

#include <array>
#include <cstddef>

#include "core/aligned.h"
#include "particles/grid.h"

namespace motes {

/// Coefficients of samples -1 to dims[a], and of one more where the grid is periodic: number (i, j,
/// k) is at (i + 1) + (j + 1) row + (k + 1) plane. Beyond the border the grid goes on as a line
/// through its outermost two samples, or from the beginning where it is periodic.
struct Coefficients {
  UninitializedVector<float> values;
  /// Distance of rows and of planes, in floats: odd numbers of cache lines, so that rows that are
  /// used together do not fall into the same sets of a cache.
  std::size_t row = 0, plane = 0;
  /// Samples that were not finite; 0 stands for them.
  std::size_t num_not_finite = 0;
};

/// The samples themselves. On all threads.
Coefficients sample_coefficients(const Grid& grid);

/// Those of the cubic B-spline that passes through the samples. Where the grid ends, its second
/// derivative across the face is 0 (a natural spline), so that it goes on as a line; a periodic one
/// is periodic. In double precision; on all threads.
Coefficients spline_coefficients(const Grid& grid);

}  // namespace motes
