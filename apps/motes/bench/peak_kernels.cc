#include "motes/bench/peak_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "motes/bench/peak_kernels.cc"
#include <hwy/foreach_target.h>
// Included again for each instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, PeakEntry::columns>;
using Vector = hn::Vec<Tag>;

/// sum + v where `inside`; with AVX-512 that is one operation, also where v is a product.
HWY_INLINE Vector add_masked(hn::Mask<Tag> inside, Vector v, Vector sum) {
  return HWY_TARGET <= HWY_AVX3 ? hn::IfThenElse(inside, hn::Add(sum, v), sum)
                                : hn::Add(sum, hn::IfThenElseZero(inside, v));
}

/// The sums of kRows rows: independent additions enough that none waits for the one before.
template <bool kGradients, int kRows>
std::uint64_t add_rows(std::span<const PeakEntry> entries, std::size_t rounds, float& total) {
  const Tag d;
  Vector value[kRows], gradient[kGradients ? 3 : 1][kRows];
  for (int j = 0; j < kRows; ++j) {
    value[j] = hn::Zero(d);
    for (auto& component : gradient) component[j] = hn::Zero(d);
  }
  for (std::size_t round = 0; round < rounds; ++round) {
    for (const PeakEntry& entry : entries) {
      const Vector column = hn::Load(d, entry.column), cut = hn::Set(d, entry.cut);
      Vector slope_x = hn::Zero(d), slope_z = hn::Zero(d);
      if constexpr (kGradients) {
        slope_x = hn::Load(d, entry.slope_x);
        slope_z = hn::Set(d, entry.slope_z);
      }
      for (int j = 0; j < kRows; ++j) {
        const Vector p = hn::Mul(column, hn::Set(d, entry.row[j]));
        const hn::Mask<Tag> inside = hn::Ge(hn::Abs(p), cut);
        value[j] = add_masked(inside, p, value[j]);
        if constexpr (kGradients) {
          const Vector phi = hn::IfThenElseZero(inside, p);
          gradient[0][j] = hn::MulAdd(phi, slope_x, gradient[0][j]);
          gradient[1][j] = hn::MulAdd(phi, hn::Set(d, entry.slope_y[j]), gradient[1][j]);
          gradient[2][j] = hn::MulAdd(phi, slope_z, gradient[2][j]);
        }
      }
    }
  }
  for (int j = 0; j < kRows; ++j) {
    for (const auto& component : gradient) value[j] = hn::Add(value[j], component[j]);
    total += hn::GetLane(hn::SumOfLanes(d, value[j]));
  }
  return rounds * entries.size() * static_cast<std::size_t>(kRows) * hn::Lanes(d);
}

std::uint64_t add_entries(std::span<const PeakEntry> entries, bool lit, std::size_t rounds,
                          float& total) {
  // As many rows as there are registers for their sums: 32 with AVX-512, else 16.
  constexpr int lit_rows = HWY_TARGET <= HWY_AVX3 ? 4 : 2;
  return lit ? add_rows<true, lit_rows>(entries, rounds, total)
             : add_rows<false, PeakEntry::rows>(entries, rounds, total);
}

int num_peak_lanes() { return static_cast<int>(hn::Lanes(Tag())); }

float sum_of(const float* values, std::size_t n) {
  const Tag d;
  constexpr std::size_t at_once = 64;
  const std::size_t lanes = hn::Lanes(d);
  Vector sums[4] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (std::size_t i = 0; i < n; i += at_once) {
    for (std::size_t j = 0; j < at_once; j += lanes) {
      Vector& sum = sums[j / lanes % 4];
      sum = hn::Add(sum, hn::Load(d, values + i + j));
    }
  }
  return hn::GetLane(
      hn::SumOfLanes(d, hn::Add(hn::Add(sums[0], sums[1]), hn::Add(sums[2], sums[3]))));
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace motes {
namespace {

HWY_EXPORT(add_entries);
HWY_EXPORT(num_peak_lanes);
HWY_EXPORT(sum_of);

}  // namespace

std::uint64_t add_entries(std::span<const PeakEntry> entries, bool lit, std::size_t rounds,
                          float& total) {
  return HWY_DYNAMIC_DISPATCH(add_entries)(entries, lit, rounds, total);
}

int num_peak_lanes() { return HWY_DYNAMIC_DISPATCH(num_peak_lanes)(); }

float sum_of(const float* values, std::size_t n) { return HWY_DYNAMIC_DISPATCH(sum_of)(values, n); }

}  // namespace motes
#endif
