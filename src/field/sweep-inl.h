// The sweep: the field on the planes of an area of pixels, kernel by kernel. Included once per
// instruction set.
//
// On a plane of constant depth a sample's squared distance to a kernel's centre is a sum of one
// term for its column of pixels and one for its row, so the Gaussian is a product of a column
// factor and a row factor: a few vectors of exponentials serve all samples that the kernel reaches
// there (docs/sweep.md). Kernels of other shapes are functions of the sum. What is worked out for
// columns and rows is called a factor in either case.
#if defined(MOTES_FIELD_SWEEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_SWEEP_INL_H_
#undef MOTES_FIELD_SWEEP_INL_H_
#else
#define MOTES_FIELD_SWEEP_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "field/gather-inl.h"
#include "field/sampling-inl.h"
#include "field/shapes-inl.h"
#include "field/sweep_boxes-inl.h"
#include "samples/area_buffer.h"
#include "samples/lanes-inl.h"
#include "samples/spread-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// A block is one vector of a group's pixels, so many rows high.
inline constexpr int block_rows = num_lanes / AreaBuffer::group_size;
inline constexpr int group_blocks = AreaBuffer::group_pixels / num_lanes;

/// Which channels there are and what shape the kernels have, known to the compiler.
template <bool kGradientsV, bool kAbsoluteV, bool kCountV = false, class ShapeV = GaussianShape>
struct Channels {
  using Shape = ShapeV;
  static constexpr bool gradients = kGradientsV, absolute = kAbsoluteV;
  /// Counts the samples inside of supports, which takes time; of Gaussians alone.
  static constexpr bool count = kCountV;
};

/// A kernel on a plane.
struct SweptKernel {
  float x, y;  ///< of the first column and row of its box, relative to the centre
  float dx, dy;
  float dz;  ///< of the plane, relative to the centre
  float minus_inverse_radius_sq, peak;
};

HWY_INLINE SweptKernel place_kernel(const GatheredKernels& gathered, std::size_t i,
                                    const AreaPlane& plane, const KernelBox& box) {
  const auto first_column = static_cast<float>(box.column * AreaBuffer::group_size);
  const auto first_row = static_cast<float>(box.row * AreaBuffer::group_size);
  return {plane.x + first_column * plane.dx - gathered.x[i],
          plane.y + first_row * plane.dy - gathered.y[i],
          plane.dx,
          plane.dy,
          plane.z - gathered.z[i],
          gathered.minus_inverse_radius_sq[i],
          gathered.peak[i]};
}

/// A kernel's factors in the columns and rows of its box, for at most so many groups of each.
/// Column factors of Gaussians carry the peak; with gradients each has its derivative's part: the
/// coordinate relative to the centre times minus_inverse_radius_sq.
template <int kColumns, int kRows, class C>
struct BoxFactors {
  static constexpr int room(int groups) {
    return (groups * AreaBuffer::group_size + num_lanes - 1) / num_lanes * num_lanes;
  }
  alignas(64) float column[room(kColumns)], row[room(kRows)];
  alignas(64) float column_slope[C::gradients ? room(kColumns) : 1];
  alignas(64) float row_slope[C::gradients ? room(kRows) : 1];
  float slope_z;

  /// Those of the first `columns` and `rows` groups.
  HWY_INLINE void fill(LaneTag d, const SweptKernel& kernel, int columns, int rows) {
    const Lanes slope = hn::Set(d, kernel.minus_inverse_radius_sq);
    const Lanes peak = hn::Set(d, kernel.peak);
    const auto share = [&](Lanes distance_sq) MOTES_INLINE HWY_ATTR {
      return share_of<typename C::Shape>(d, slope, distance_sq);
    };
    const auto coordinates = [&](int i, float first, float step) HWY_ATTR {
      return hn::MulAdd(hn::Iota(d, static_cast<float>(i)), hn::Set(d, step), hn::Set(d, first));
    };
    for (int i = 0; i < columns * AreaBuffer::group_size; i += num_lanes) {
      const Lanes x = coordinates(i, kernel.x, kernel.dx);
      const Lanes of_column = share(hn::Mul(x, x));
      hn::Store(C::Shape::is_product ? hn::Mul(peak, of_column) : of_column, d, column + i);
      if constexpr (C::gradients) hn::Store(hn::Mul(x, slope), d, column_slope + i);
    }
    const Lanes dz_sq = hn::Set(d, kernel.dz * kernel.dz);
    for (int i = 0; i < rows * AreaBuffer::group_size; i += num_lanes) {
      const Lanes y = coordinates(i, kernel.y, kernel.dy);
      hn::Store(share(hn::MulAdd(y, y, dz_sq)), d, row + i);
      if constexpr (C::gradients) hn::Store(hn::Mul(y, slope), d, row_slope + i);
    }
    slope_z = kernel.dz * kernel.minus_inverse_radius_sq;
  }
};

/// sum + v where `inside`. Not sum itself elsewhere: compilers make a masked store of that, which
/// processors do not forward to the next load.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V add_inside(D, hn::Mask<D> inside, V v, V sum) {
  return hn::Add(sum, hn::IfThenElseZero(inside, v));
}

/// What the groups of a row have in common: vectors, one a block.
template <class C>
struct RowFactors {
  Lanes row[group_blocks], slope[C::gradients ? group_blocks : 1];
  Lanes slope_z, height;
};

/// What add_to_samples() needs of a kernel besides its factors: of a Gaussian where it is cut off,
/// of others the peak.
template <class Shape>
HWY_INLINE float height_of(const GatheredKernels& gathered, std::size_t i) {
  return Shape::is_product ? gathered.cut[i] : gathered.peak[i];
}

template <int kColumns, int kRows, class C>
HWY_INLINE RowFactors<C> spread_group(LaneTag d, const BoxFactors<kColumns, kRows, C>& factors,
                                      float height, int row) {
  RowFactors<C> out;
  for (int v = 0; v < group_blocks; ++v) {
    out.row[v] = spread_rows(d, factors.row + AreaBuffer::group_size * row, v);
    if constexpr (C::gradients) {
      out.slope[v] = spread_rows(d, factors.row_slope + AreaBuffer::group_size * row, v);
    }
  }
  out.slope_z = hn::Set(d, factors.slope_z);
  out.height = hn::Set(d, height);
  return out;
}

/// How a kernel's gradient follows from its steepness: what each component is multiplied by.
template <class V>
struct GradientSlopes {
  V x, y, z;
};

/// Adds a kernel's gradient, its slopes times `steepness`, to channels 1 to 3.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void add_gradient(D d, V steepness, const GradientSlopes<V>& slopes, float* samples,
                             int channel_floats) {
  const auto add = [&](int channel, V slope) MOTES_INLINE HWY_ATTR {
    float* const gradient = samples + channel * channel_floats;
    hn::Store(hn::MulAdd(steepness, slope, hn::Load(d, gradient)), d, gradient);
  };
  add(1, slopes.x);
  add(2, slopes.y);
  add(3, slopes.z);
}

/// Adds a kernel that is no product to samples of a field, as add_to_samples() does: `phi` is its
/// shape there.
template <class C, class D, class V = hn::Vec<D>>
HWY_INLINE void add_radial(D d, const RadialLanes<V>& phi, V height,
                           const GradientSlopes<V>& slopes, float* samples, int channel_floats) {
  hn::Store(hn::MulAdd(height, phi.value, hn::Load(d, samples)), d, samples);
  if constexpr (C::gradients) {
    add_gradient(d, hn::Mul(height, phi.steepness), slopes, samples, channel_floats);
  }
  if constexpr (C::absolute) {
    float* const absolute = samples + 4 * channel_floats;
    const V magnitude = hn::Abs(hn::Mul(height, phi.value));
    hn::Store(hn::Add(magnitude, hn::Load(d, absolute)), d, absolute);
  }
}

/// Adds a kernel to samples of a field: channel 0 at `samples`, each further one `channel_floats`
/// behind. `column` and `row` are the samples' factors, `height` is as height_of(). Returns how
/// many samples lie inside of the support, if C::count.
template <class C, class D, class V = hn::Vec<D>>
HWY_INLINE std::uint64_t add_to_samples(D d, const typename C::Shape& shape, V column, V row,
                                        V height, const GradientSlopes<V>& slopes, float* samples,
                                        int channel_floats) {
  if constexpr (C::Shape::is_product) {
    // The kernel ends where its value falls below that at the support radius: no distance is
    // needed.
    const V values = hn::Mul(column, row), magnitude = hn::Abs(values);
    const auto inside = hn::Ge(magnitude, height);
    hn::Store(add_inside(d, inside, values, hn::Load(d, samples)), d, samples);
    if constexpr (C::gradients) {
      add_gradient(d, hn::IfThenElseZero(inside, values), slopes, samples, channel_floats);
    }
    if constexpr (C::absolute) {
      float* const absolute = samples + 4 * channel_floats;
      hn::Store(add_inside(d, inside, magnitude, hn::Load(d, absolute)), d, absolute);
    }
    return C::count ? hn::CountTrue(d, inside) : 0;
  } else {
    const auto phi = shape.template at<C::gradients>(d, hn::Add(column, row));
    add_radial<C>(d, phi, height, slopes, samples, channel_floats);
    return 0;
  }
}

/// Adds a kernel to the samples of a group: `column` is that of the group in the kernel's box,
/// `samples` the field's channel 0 in the group's first block. Returns how many samples lie inside
/// of the support, if C::count.
template <int kColumns, int kRows, class C>
HWY_INLINE std::uint64_t add_to_group(LaneTag d, const typename C::Shape& shape,
                                      const BoxFactors<kColumns, kRows, C>& factors,
                                      const RowFactors<C>& rows, int column, float* samples,
                                      std::size_t block_floats) {
  std::uint64_t inside_support = 0;
  const Lanes columns = hn::LoadDup128(d, factors.column + AreaBuffer::group_size * column);
  GradientSlopes<Lanes> slopes{columns, columns, columns};
  if constexpr (C::gradients) {
    slopes.x = hn::LoadDup128(d, factors.column_slope + AreaBuffer::group_size * column);
    slopes.z = rows.slope_z;
  }
  const auto each_block = [&](auto&& add) MOTES_INLINE HWY_ATTR {
    float* block = samples;
    for (int v = 0; v < group_blocks; ++v, block += block_floats) {
      if constexpr (C::gradients) slopes.y = rows.slope[v];
      add(v, block);
    }
  };
  if constexpr (C::Shape::is_product) {
    each_block([&](int v, float* block) MOTES_INLINE HWY_ATTR {
      inside_support +=
          add_to_samples<C>(d, shape, columns, rows.row[v], rows.height, slopes, block, num_lanes);
    });
  } else {
    // What takes long to find is found for all blocks before it is waited for.
    decltype(shape.template find<C::gradients>(d, columns)) found[group_blocks];
    for (int v = 0; v < group_blocks; ++v) {
      found[v] = shape.template find<C::gradients>(d, hn::Add(columns, rows.row[v]));
    }
    each_block([&](int v, float* block) MOTES_INLINE HWY_ATTR {
      const auto phi = shape.template at<C::gradients>(d, found[v]);
      add_radial<C>(d, phi, rows.height, slopes, block, num_lanes);
    });
  }
  return inside_support;
}

/// Kernel evaluations, lane by lane.
struct EvaluationCounts {
  std::uint64_t carried_out = 0;     ///< those outside of the support included
  std::uint64_t inside_support = 0;  ///< if Channels::count
};

/// Groups with rays under way.
class LiveGroups {
 public:
  GroupBits row(int i) const { return rows_[static_cast<std::size_t>(i)]; }

  void set(const std::array<GroupBits, AreaBuffer::groups>& rows) {
    rows_ = rows;
    for (std::size_t row = 0; row < AreaBuffer::groups; ++row) {
      std::uint16_t count = 0;
      for (std::size_t column = 0; column < AreaBuffer::groups; ++column) {
        count = static_cast<std::uint16_t>(count + (rows[row] >> column & 1));
        before_[row + 1][column + 1] = static_cast<std::uint16_t>(before_[row][column + 1] + count);
      }
    }
  }

  bool any_in(const KernelBox& box) const {
    const auto &low = before_[box.row], &high = before_[std::size_t{box.last_row} + 1];
    const std::size_t begin = box.column, end = std::size_t{box.last_column} + 1;
    return high[end] - high[begin] != low[end] - low[begin];
  }

 private:
  std::array<GroupBits, AreaBuffer::groups> rows_{};  ///< a bit each
  /// How many lie above and to the left of the corner of a group.
  std::uint16_t before_[AreaBuffer::groups + 1][AreaBuffer::groups + 1] = {};
};

/// Samples of some planes of the area.
struct PlaneSamples {
  const AreaPlane* planes;
  AreaBuffer& buffer;
  std::size_t field_floats;  ///< from a field of a block to the next
  const LiveGroups& live;

  float* at(int row, int column, std::uint32_t field, std::size_t plane) const {
    return buffer.at(row, column) + plane * buffer.plane_floats() + field * field_floats;
  }
};

/// Columns of the box's groups that a kernel may reach in each row of groups, a bit each.
struct ReachedColumns {
  alignas(64) GroupBits of_row[AreaBuffer::groups];

  HWY_INLINE void find(LaneTag d, const SweptKernel& kernel, float support_sq,
                       const KernelBox& box) {
    const hn::RebindToSigned<LaneTag> di;
    const hn::RebindToUnsigned<LaneTag> du;
    constexpr float size = AreaBuffer::group_size, middle = 0.5f * (size - 1);
    const Lanes disc_sq = hn::Set(d, support_sq - kernel.dz * kernel.dz);
    const Lanes per_column = hn::Set(d, 1 / kernel.dx);
    const Lanes center = hn::Set(d, -kernel.x / kernel.dx);
    const Lanes end = hn::Set(d, static_cast<float>(box.columns()) * size - 1);
    // Rounding of the square root and of places, in pixels.
    const Lanes slack = hn::Set(d, 1e-3f), stretch = hn::Mul(per_column, hn::Set(d, 1.0005f));
    for (int row = 0; row < box.rows(); row += num_lanes) {
      // The group's row of samples that is nearest to the centre, or between its rows.
      const Lanes number = hn::Iota(d, static_cast<float>(row));
      const Lanes y = hn::MulAdd(number, hn::Set(d, size * kernel.dy),
                                 hn::Set(d, kernel.y + middle * kernel.dy));
      const Lanes nearest =
          hn::Max(hn::Sub(hn::Abs(y), hn::Set(d, middle * std::abs(kernel.dy))), hn::Zero(d));
      const Lanes half_sq = hn::Max(hn::NegMulAdd(nearest, nearest, disc_sq), hn::Set(d, 1e-30f));
      const Lanes half =
          hn::MulAdd(hn::Mul(half_sq, hn::ApproximateReciprocalSqrt(half_sq)), stretch, slack);
      const auto group_at = [&](Lanes pixel) HWY_ATTR {
        const Lanes inside = hn::Min(hn::Max(pixel, hn::Zero(d)), end);
        return hn::BitCast(du, hn::ConvertTo(di, hn::Mul(inside, hn::Set(d, 1 / size))));
      };
      const auto first = group_at(hn::Ceil(hn::Sub(center, half)));
      const auto last = group_at(hn::Floor(hn::Add(center, half)));
      hn::Store(hn::Sub(hn::Shl(hn::Set(du, 2), last), hn::Shl(hn::Set(du, 1), first)), du,
                of_row + row);
    }
  }
};

/// Some kernels with their factors: worked out for all before the first is added, they do not wait
/// for each other. For boxes of kColumns columns, or of any size if these are all of the area's.
template <int kColumns, class C>
struct KernelBatch {
  static constexpr bool kWide = kColumns == AreaBuffer::groups;
  static constexpr std::size_t most = 16;
  struct Member {
    KernelBox box;
    float height;
    float* samples;                  ///< of the box's first group: the field's channel 0
    AreaBuffer::PlaneBits* touched;  ///< of the box's first group, the field's
    AreaBuffer::PlaneBits bit;       ///< the plane's
    ReachedColumns reached;          ///< of wide ones
    BoxFactors<kColumns, AreaBuffer::groups, C> factors;
  };
  Member members[most];
  std::size_t count = 0;

  /// Takes the next ones of `list`, but those without rays under way.
  HWY_INLINE void fill(LaneTag d, const GatheredKernels& gathered, const PlaneSamples& samples,
                       std::span<const BoxedKernel>& list) {
    count = 0;
    for (; !list.empty() && count < most; list = list.subspan(1)) {
      const KernelBox box = list[0].box;
      if (!samples.live.any_in(box)) continue;
      const std::size_t k = list[0].kernel, plane = list[0].plane;
      Member& out = members[count++];
      out.box = box;
      out.height = height_of<typename C::Shape>(gathered, k);
      out.samples = samples.at(box.row, box.column, gathered.field[k], plane);
      out.touched = samples.buffer.touched(box.row, box.column) + gathered.field[k];
      out.bit = AreaBuffer::PlaneBits{1} << plane;
      const SweptKernel kernel = place_kernel(gathered, k, samples.planes[plane], box);
      const bool any_columns = kWide || !C::Shape::is_product;
      out.factors.fill(d, kernel, any_columns ? box.columns() : kColumns, box.rows());
      if constexpr (kWide) out.reached.find(d, kernel, gathered.support_sq[k], box);
    }
  }
};

/// Adds kernels whose boxes have kColumns columns to all of their groups: no branch depends on
/// which of these a kernel reaches, and few do not. Of shapes that are no products, boxes may have
/// fewer: their loops are long enough without being made for a number of columns.
template <int kColumns, class C>
HWY_NOINLINE void add_narrow_kernels(LaneTag d, const typename C::Shape& shape,
                                     const GatheredKernels& gathered,
                                     std::span<const BoxedKernel> list, const PlaneSamples& samples,
                                     EvaluationCounts& counts) {
  const std::size_t row_floats = samples.buffer.row_floats();
  const std::size_t group_floats = samples.buffer.group_floats();
  const std::size_t block_floats = samples.buffer.block_floats();
  const std::size_t num_fields = samples.buffer.num_fields();
  const typename C::Shape local = shape;  // so that what it holds may stay in registers
  KernelBatch<kColumns, C> batch;
  while (!list.empty()) {
    batch.fill(d, gathered, samples, list);
    for (std::size_t i = 0; i < batch.count; ++i) {
      const auto& kernel = batch.members[i];
      AreaBuffer::PlaneBits* touched = kernel.touched;
      float* group = kernel.samples;
      const int columns = C::Shape::is_product ? kColumns : kernel.box.columns();
      for (int row = 0; row < kernel.box.rows(); ++row) {
        const auto rows = spread_group(d, kernel.factors, kernel.height, row);
        for (int column = 0; column < columns; ++column) {
          touched[static_cast<std::size_t>(column) * num_fields] |= kernel.bit;
          counts.inside_support +=
              add_to_group(d, local, kernel.factors, rows, column,
                           group + static_cast<std::size_t>(column) * group_floats, block_floats);
        }
        group += row_floats;
        touched += AreaBuffer::groups * num_fields;
      }
      counts.carried_out +=
          static_cast<std::uint64_t>(kernel.box.rows() * columns * AreaBuffer::group_pixels);
    }
  }
}

/// Adds kernels with boxes of any size to the groups that they reach, but where no ray is under
/// way.
template <class C>
HWY_NOINLINE void add_wide_kernels(LaneTag d, const typename C::Shape& shape,
                                   const GatheredKernels& gathered,
                                   std::span<const BoxedKernel> list, const PlaneSamples& samples,
                                   EvaluationCounts& counts) {
  const std::size_t row_floats = samples.buffer.row_floats();
  const std::size_t group_floats = samples.buffer.group_floats();
  const std::size_t num_fields = samples.buffer.num_fields();
  const typename C::Shape local = shape;
  KernelBatch<AreaBuffer::groups, C> batch;
  while (!list.empty()) {
    batch.fill(d, gathered, samples, list);
    for (std::size_t i = 0; i < batch.count; ++i) {
      const auto& kernel = batch.members[i];
      const KernelBox box = kernel.box;
      for (int row = 0; row < box.rows(); ++row) {
        const GroupBits reached_live =
            kernel.reached.of_row[row] & samples.live.row(box.row + row) >> box.column;
        if (reached_live == 0) continue;
        // All between the first and the last, which is simpler to count than those that are live.
        const int first = std::countr_zero(reached_live);
        const int count = std::bit_width(reached_live) - first;
        counts.carried_out += static_cast<std::uint64_t>(count) * AreaBuffer::group_pixels;
        const auto rows = spread_group(d, kernel.factors, kernel.height, row);
        float* group = kernel.samples + static_cast<std::size_t>(row) * row_floats +
                       static_cast<std::size_t>(first) * group_floats;
        AreaBuffer::PlaneBits* touched =
            kernel.touched +
            static_cast<std::size_t>(row * AreaBuffer::groups + first) * num_fields;
        for (int column = first; column < first + count; ++column) {
          *touched |= kernel.bit;
          counts.inside_support += add_to_group(d, local, kernel.factors, rows, column, group,
                                                samples.buffer.block_floats());
          touched += num_fields;
          group += group_floats;
        }
      }
    }
  }
}

/// Adds the kernels that reach some planes, sorted, to their samples.
template <class C>
void sum_planes(const typename C::Shape& shape, const GatheredKernels& gathered,
                const PlaneKernels& kernels, const PlaneSamples& samples,
                EvaluationCounts& counts) {
  const LaneTag d;
  if constexpr (C::Shape::is_product) {
    unroll<max_box_shape - 1>([&](auto i) HWY_ATTR {
      constexpr std::size_t columns = i + 1;
      add_narrow_kernels<columns, C>(d, shape, gathered, with_columns(kernels, columns, columns),
                                     samples, counts);
    });
  } else {
    constexpr std::size_t most = max_box_shape - 1;
    add_narrow_kernels<most, C>(d, shape, gathered, with_columns(kernels, 1, most), samples,
                                counts);
  }
  add_wide_kernels<C>(d, shape, gathered, with_columns(kernels, max_box_shape, max_box_shape),
                      samples, counts);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
