// A tabulated kernel as the engines take it: a cubic for each step of the distance or of its
// square.
#pragma once

#include <cstddef>

#include "core/aligned.h"
#include "scene/kernel.h"

namespace motes {

/// Value at a place, in segments: c[0] + t (c[1] + t (c[2] + t c[3])), where t is the fraction and
/// c are the four coefficients of the whole part's segment. The place is q^2 * segments_per_unit
/// for tables `of_squares`, which take no square root, and q * segments_per_unit for others; q is
/// the distance in radii.
struct RadialTable {
  static constexpr std::size_t record_size = 4;
  /// Tables of up to so many segments fit into registers where these are wide; those of squares,
  /// which cost less to look up, may have more.
  static constexpr int few = 32, few_of_squares = 64;

  bool of_squares = false;
  float support_sq = 0;  ///< square radii
  float segments_per_unit = 0;
  float last_segment = 0;
  AlignedVector<float> coefficients;

  bool has_few() const { return last_segment < (of_squares ? few_of_squares : few); }
};

/// With few segments if these give the kernel's values to 1e-6 of the largest and its slopes to
/// 1e-5 of the steepest, of squares where possible; else the profile's own. Precondition: the
/// kernel is tabulated.
RadialTable make_radial_table(const Kernel& kernel);

}  // namespace motes
