// A tabulated kernel as the engines take it: a cubic for each step of the distance.
#pragma once

#include <cstddef>

#include "core/aligned.h"
#include "scene/kernel.h"

namespace motes {

/// Value at distance q, in radii: with place = q * segments_per_radius, whole part i and fraction
/// t, c[0] + t (c[1] + t (c[2] + t c[3])), where c are the four coefficients of segment i.
struct RadialTable {
  static constexpr std::size_t record_size = 4;
  /// Tables of up to so many segments fit into registers where these are wide.
  static constexpr int few = 32;

  float support_sq = 0;  ///< square radii
  float segments_per_radius = 0;
  float last_segment = 0;
  AlignedVector<float> coefficients;

  bool has_few() const { return last_segment < few; }
};

/// With few segments if these give the kernel's values to 1e-6 of the largest and its slopes to
/// 1e-5 of the steepest, else the profile's own. Precondition: the kernel is tabulated.
RadialTable make_radial_table(const Kernel& kernel);

}  // namespace motes
