// A tabulated kernel as the engines take it: polynomials for segments of the distance or of its
// square.
#pragma once

#include <cstddef>

#include "core/aligned.h"
#include "scene/kernel.h"

namespace motes {

/// Even segments of the support. The place is q^2 * per_unit of those `of_squares`, which take no
/// square root, and q * per_unit of others; q is the distance in radii. Segment i is that of the
/// places from i to i + 1, and its polynomial is in the place from its middle, i + 1/2.
struct TableSegments {
  bool of_squares = false;
  float per_unit = 0;
  float last = 0;  ///< their number less one
};

struct RadialTable {
  float support_sq = 0;  ///< square radii

  /// The curve as it is: a cubic for each of the profile's steps.
  static constexpr std::size_t record_size = 4;
  TableSegments steps;
  AlignedVector<float> records;  ///< a step's four coefficients each, from the constant on

  /// The same curve in a few polynomials where it is smooth enough for them: vectors hold one of
  /// their coefficients for all segments.
  static constexpr std::size_t smooth_segments = 8, smooth_degree = 6;
  static constexpr std::size_t smooth_row = 2 * smooth_segments;
  TableSegments smooth;
  AlignedVector<float> rows;  ///< a coefficient's segments each, twice; none where it is rough

  bool is_smooth() const { return !rows.empty(); }
  std::size_t num_steps() const { return records.size() / record_size; }
};

/// Polynomials if they give the kernel's values to 1e-6 of the largest and its slopes to 1e-5 of
/// the steepest, of squares where possible. Precondition: the kernel is tabulated.
RadialTable make_radial_table(const Kernel& kernel);

}  // namespace motes
