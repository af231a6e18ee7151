// The fields at single points, in double precision: what `motes probe` prints.
#pragma once

#include <span>
#include <vector>

#include "core/vec.h"
#include "field/kernel_set.h"

namespace motes {

/// A field at a point: value in the field's unit, gradient in that per file's length, world axes.
struct FieldSample {
  double value = 0;
  Vector3d gradient;
};

/// All fields at `points` (file's lengths, world coordinates): [point][field]. Outside every
/// support a field is 0. A point that is not finite gives NaN.
std::vector<FieldSample> probe(const KernelSet& kernels, std::span<const Point3d> points);

/// How many kernels probe() looks at on average for one of `points`: what it costs. Precondition:
/// there is a point.
double mean_kernels_tested(const KernelSet& kernels, std::span<const Point3d> points);

}  // namespace motes
