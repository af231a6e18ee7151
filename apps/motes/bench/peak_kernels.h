// The loops of which measure_peak() takes the speed, in the instruction set in use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace motes {

/// A kernel on a plane as the sweep's sums take it (src/field/sweep-inl.h): factors of columns and
/// of rows, and for gradients what goes with each.
struct alignas(64) PeakEntry {
  static constexpr int columns = 16, rows = 8;
  float column[columns], slope_x[columns];
  float row[rows], slope_y[rows];
  float cut, slope_z;
};

/// Adds each of `entries` to sums that stay in registers, `rounds` times over, with gradients if
/// `lit`: a multiplication, an absolute value, a comparison and a masked addition a vector of
/// samples, and three multiply-adds more. Nothing else happens, as far as it can be helped: what an
/// entry needs is in the nearest cache. Adds what the sums come to to `total`, so that no work can
/// be left out. Returns kernel evaluations.
std::uint64_t add_entries(std::span<const PeakEntry> entries, bool lit, std::size_t rounds,
                          float& total);

/// Samples of a vector of these loops.
int num_peak_lanes();

/// The sum of `n` floats, a multiple of 64, aligned to 64 bytes.
float sum_of(const float* values, std::size_t n);

}  // namespace motes
