// Adds kernels to the samples of a brick. Included once per instruction set.
//
// A sample's squared distance to a kernel's centre is a sum of one term for each axis, so a
// Gaussian is the product of three factors, A(x) B(y) C(z): a few vectors of exponentials serve all
// samples that the kernel reaches in the brick. Of a group of 4 x 4 samples A B is one vector for
// all planes; each plane costs a product, a comparison and a sum. Other shapes are functions of the
// sum of the three terms.
#if defined(MOTES_GRID_SUM_BRICK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_GRID_SUM_BRICK_INL_H_
#undef MOTES_GRID_SUM_BRICK_INL_H_
#else
#define MOTES_GRID_SUM_BRICK_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/inline.h"
#include "field/kernel_set.h"
#include "field/sampling-inl.h"
#include "field/shapes-inl.h"
#include "grid/brick.h"
#include "samples/lanes-inl.h"
#include "samples/spread-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// The samples of a brick along one axis that a kernel may reach, and its share there.
struct KernelSpan {
  int first, last;      ///< within the brick; first > last: none
  float place;          ///< of sample 0 of the brick's group (or plane) of `first`, relative to the
                        ///< centre, in steps
  float per_radius_sq;  ///< (step / radius)^2
};

/// `center` relative to the brick's first sample; `unit`: samples from which `place` counts. In
/// double, so that samples are as well placed far from the kernel's own scale.
HWY_INLINE KernelSpan find_span(double center, double radius, double support, double step,
                                double inverse_step, int size, int unit) {
  const double middle = center * inverse_step, reach = support * inverse_step * (1 + 1e-6);
  KernelSpan span;
  span.first = static_cast<int>(std::ceil(std::max(middle - reach, 0.)));
  span.last = static_cast<int>(std::floor(std::min(middle + reach, size - 1.)));
  const int counted_from = span.first / unit * unit;
  span.place = static_cast<float>(counted_from - middle);
  span.per_radius_sq = static_cast<float>(step / radius * (step / radius));
  return span;
}

/// A kernel in a brick.
struct BrickKernel {
  KernelSpan x, y, z;
  float peak;

  bool reaches() const { return x.first <= x.last && y.first <= y.last && z.first <= z.last; }
};

HWY_INLINE BrickKernel place_kernel(const KernelSet& kernels, const FieldConstants& field,
                                    std::size_t i, const Brick& brick) {
  const double radius = kernels.radius[i], support = field.support_factor * radius;
  const auto along = [&](float center, int axis, int unit) MOTES_INLINE {
    return find_span(center - brick.origin[axis], radius, support, brick.step[axis],
                     brick.inverse_step[axis], brick.size[static_cast<std::size_t>(axis)], unit);
  };
  return {along(kernels.x[i], 0, BrickSamples::group_size),
          along(kernels.y[i], 1, BrickSamples::group_size), along(kernels.z[i], 2, 1),
          kernels.weight[i]};
}

/// Shares of `count` samples along an axis, of a Gaussian factors.
template <class Shape>
HWY_INLINE void fill_shares(LaneTag d, const KernelSpan& span, int count, float* shares) {
  const Lanes first = hn::Set(d, span.place), per_radius_sq = hn::Set(d, span.per_radius_sq);
  for (int i = 0; i < count; i += num_lanes) {
    const Lanes place = hn::Add(hn::Iota(d, static_cast<float>(i)), first);
    const Lanes share = share_of<Shape>(d, hn::Neg(per_radius_sq), hn::Mul(place, place));
    hn::Store(share, d, shares + i);
  }
}

/// Adds a kernel to planes `first` to `last` of a group: `samples` is the group's plane 0,
/// `columns` and `rows` its shares, `planes` those of plane `first` and so on.
template <class Shape>
HWY_INLINE void add_to_group(LaneTag d, const Shape& shape, const float* columns, const float* rows,
                             const float* planes, int first, int last, float peak, float cut,
                             float* samples) {
  constexpr int blocks = BrickSamples::group_samples / num_lanes;
  const Lanes column = hn::LoadDup128(d, columns);
  Lanes shares[blocks];
  unroll<blocks>([&](auto v) MOTES_INLINE HWY_ATTR {
    const Lanes row = spread_rows(d, rows, v);
    shares[v] = Shape::is_product ? hn::Mul(column, row) : hn::Add(column, row);
  });
  const Lanes height = hn::Set(d, peak), least = hn::Set(d, cut);
  float* plane = samples + first * BrickSamples::group_samples;
  for (int k = first; k <= last; ++k, plane += BrickSamples::group_samples) {
    const Lanes share = hn::Set(d, planes[k - first]);
    unroll<blocks>([&](auto v) MOTES_INLINE HWY_ATTR {
      float* const at = plane + v * num_lanes;
      Lanes phi;
      if constexpr (Shape::is_product) {
        // It ends where it falls below its value at the support radius: no distance is needed.
        const Lanes value = hn::Mul(shares[v], share);
        phi = hn::IfThenElseZero(hn::Ge(value, least), value);
      } else {
        phi = shape.template at<false>(d, hn::Add(shares[v], share)).value;
      }
      hn::Store(hn::MulAdd(height, phi, hn::Load(d, at)), d, at);
    });
  }
}

/// Adds kernels of one field, by their numbers, to its samples: as high as their internal weights.
/// Hot: nothing is checked.
template <class Shape>
HWY_NOINLINE void add_kernels(const Shape& shape, const KernelSet& kernels,
                              const FieldConstants& field, std::span<const std::uint32_t> numbers,
                              const Brick& brick, BrickSamples& samples) {
  const LaneTag d;
  const Shape local = shape;  // so that what it holds may stay in registers
  constexpr int room = Brick::max_side + max_lanes;
  alignas(64) float columns[room], rows[room], planes[room];
  for (const std::uint32_t i : numbers) {
    const BrickKernel kernel = place_kernel(kernels, field, i, brick);
    if (!kernel.reaches()) continue;
    const auto group_of = [](int sample) { return sample / BrickSamples::group_size; };
    const int first_column = group_of(kernel.x.first), last_column = group_of(kernel.x.last);
    const int first_row = group_of(kernel.y.first), last_row = group_of(kernel.y.last);
    constexpr int side = BrickSamples::group_size;
    fill_shares<Shape>(d, kernel.x, (last_column - first_column + 1) * side, columns);
    fill_shares<Shape>(d, kernel.y, (last_row - first_row + 1) * side, rows);
    fill_shares<Shape>(d, kernel.z, kernel.z.last - kernel.z.first + 1, planes);
    // (All of the box: of its corners which a kernel leaves out is what no branch predictor can
    // guess, and that takes longer than to add them.)
    for (int row = first_row; row <= last_row; ++row) {
      for (int column = first_column; column <= last_column; ++column) {
        add_to_group(d, local, columns + (column - first_column) * side,
                     rows + (row - first_row) * side, planes, kernel.z.first, kernel.z.last,
                     kernel.peak, field.support_value, samples.at(column, row));
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
