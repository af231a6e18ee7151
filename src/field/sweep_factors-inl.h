// The factors of the sweep: for each kernel that may reach a tile, and each plane that it may
// reach, a vector of column factors and one of row factors, in lists by field and plane. Included
// once per instruction set.
#if defined(MOTES_FIELD_SWEEP_FACTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_SWEEP_FACTORS_INL_H_
#undef MOTES_FIELD_SWEEP_FACTORS_INL_H_
#else
#define MOTES_FIELD_SWEEP_FACTORS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/aligned.h"
#include "field/gather-inl.h"
#include "field/sampling-inl.h"
#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Pixels of a side of a tile.
inline constexpr int sweep_tile = 16;
/// Planes of a slab, at most.
inline constexpr int max_sweep_planes = 32;
/// Vectors of a tile's columns or rows.
inline constexpr int sweep_vectors = sweep_tile / num_lanes;
/// Tiles are summed in strips: one vector wide, so many pixels high. Strips go row by row.
inline constexpr int strip_height = 4;
inline constexpr int sweep_strips = sweep_vectors * sweep_tile / strip_height;

/// The samples of a tile in a slab's frame: that in column i and row j on plane k lies at (x[k][i],
/// y[k][j], z[k]).
struct TileSamples {
  alignas(64) float x[max_sweep_planes][sweep_tile], y[max_sweep_planes][sweep_tile];
  float z[max_sweep_planes];
};

inline TileSamples place_samples(const RayBounds& rays, const SlabFrame& frame) {
  TileSamples samples;
  for (int k = 0; k < frame.count; ++k) {
    samples.z[k] = frame.first_depth + static_cast<float>(k) * frame.step;
  }
  const auto place = [&](const Range& origin, const Range& direction, double reference,
                         bool falling, float(*out)[sweep_tile]) {
    for (int i = 0; i < sweep_tile; ++i) {
      const double t = static_cast<double>(falling ? sweep_tile - 1 - i : i) / (sweep_tile - 1);
      const double slope = direction.low + t * (direction.high - direction.low);
      const double at = origin.low + t * (origin.high - origin.low);
      const auto offset = static_cast<float>(at + frame.reference_depth * slope - reference);
      for (int k = 0; k < frame.count; ++k) {
        out[k][i] = offset + samples.z[k] * static_cast<float>(slope);
      }
    }
  };
  place(rays.origin_x, rays.direction_x, frame.reference_x, false, samples.x);
  place(rays.origin_y, rays.direction_y, frame.reference_y, true, samples.y);
  return samples;
}

/// Kernels that may reach a tile in a slab, and the planes on which.
struct TileKernels {
  AlignedVector<std::uint32_t> index;  ///< of those gathered
  AlignedVector<float> first, last;    ///< planes of the slab, both included; whole numbers
  std::size_t size = 0;
};

/// Finds those of the gathered kernels that may reach `frustum`.
HWY_NOINLINE void find_tile_kernels(const SamplingConstants& constants,
                                    const GatheredKernels& gathered, const SlabFrame& frame,
                                    const Frustum& frustum, TileKernels& out) {
  const LaneTag d;
  const hn::RebindToUnsigned<LaneTag> du;
  out.size = 0;
  if (out.index.size() < gathered.size + max_lanes) {
    const std::size_t room = 2 * gathered.size + max_lanes;
    out.index.resize(room);
    out.first.resize(room);
    out.last.resize(room);
  }
  for (std::size_t i = 0; i < gathered.size; i += hn::Lanes(d)) {
    const Centers<Lanes> centers{hn::Load(d, gathered.x.data() + i),
                                 hn::Load(d, gathered.y.data() + i),
                                 hn::Load(d, gathered.z.data() + i)};
    const Lanes support =
        hn::Mul(hn::Load(d, gathered.radius.data() + i), hn::Set(d, constants.max_support_factor));
    const Reach<LaneTag> reach = find_reach(d, frame, frustum, centers, support);
    const auto index = hn::Iota(du, static_cast<std::uint32_t>(i));
    hn::StoreU(hn::Compress(index, hn::RebindMask(du, reach.any)), du, out.index.data() + out.size);
    hn::StoreU(hn::Compress(reach.first, reach.any), d, out.first.data() + out.size);
    hn::StoreU(hn::Compress(reach.last, reach.any), d, out.last.data() + out.size);
    out.size += hn::CountTrue(d, reach.any);
  }
}

/// A kernel as the sweep needs it: place in the frame, in camera axes.
struct SweptKernel {
  float x, y, z;
  float exponent_scale;  ///< -log2(e) / (2 radius^2)
  float minus_inverse_radius_sq;
  float peak;           ///< kappa * weight, of a normalised field over the kernel's integral
  float support_value;  ///< exp(-sigma^2 / 2): the kernel is zero where it would be less
};

/// Field of kernel i of those gathered.
HWY_INLINE std::size_t field_of(const KernelSet& kernels, const GatheredKernels& gathered,
                                std::size_t i) {
  return kernels.field.empty() ? 0 : kernels.field[gathered.index[i]];
}

/// Kernel i of those gathered.
HWY_INLINE SweptKernel make_swept_kernel(const KernelSet& kernels,
                                         const SamplingConstants& constants,
                                         const GatheredKernels& gathered, std::size_t i) {
  const std::size_t at = gathered.index[i];
  const FieldConstants& field = constants.fields[field_of(kernels, gathered, i)];
  const float radius = gathered.radius[i];
  SweptKernel kernel;
  kernel.x = gathered.x[i];
  kernel.y = gathered.y[i];
  kernel.z = gathered.z[i];
  const float inverse_radius_sq = 1.0f / (radius * radius);
  kernel.exponent_scale = -0.5f * std::numbers::log2e_v<float> * inverse_radius_sq;
  kernel.peak = field.peak_factor * kernels.weight[at];
  kernel.minus_inverse_radius_sq = -inverse_radius_sq;
  kernel.support_value = field.support_value;
  return kernel;
}

/// 2^exponent for exponents of at most 0; 0 where that is too small for a float.
HWY_INLINE Lanes factor_of(LaneTag d, Lanes exponent) {
#if HWY_TARGET <= HWY_AVX3
  // Fraction and power are one operation each, and underflow comes out right.
  const Lanes fraction{_mm512_reduce_ps(exponent.raw, _MM_FROUND_TO_NEAREST_INT)};
  const Lanes whole = hn::Sub(exponent, fraction);
  return Lanes{_mm512_scalef_ps(exp2_fraction(d, fraction).raw, whole.raw)};
#else
  return hn::IfThenElseZero(hn::Ge(exponent, hn::Set(d, min_exponent)), exp2_bounded(d, exponent));
#endif
}

/// Rows of a tile, a bit each.
using RowBits = std::uint16_t;
static_assert(sweep_tile == 16);

/// Rows on which a sample in the columns of one vector may lie in the kernel's support: the largest
/// column factor times the row's reaches the kernel's value there.
HWY_INLINE RowBits covered_rows(LaneTag d, Lanes columns, const Lanes* rows, Lanes support_value) {
  const Lanes column_max = hn::MaxOfLanes(d, columns);
  unsigned covered = 0;
  for (int v = 0; v < sweep_vectors; ++v) {
    covered |= mask_bits(d, hn::Ge(hn::Mul(rows[v], column_max), support_value)) << (v * num_lanes);
  }
  return static_cast<RowBits>(covered);
}

/// Factors of many kernels in a tile and slab, list by list: one for each field and plane. An entry
/// is one kernel on one plane.
struct FactorLists {
  struct List {
    std::uint32_t begin = 0, end = 0;  ///< entries; begin is a multiple of 32
  };
  /// What gradients need of an entry beside the factors.
  struct Slopes {
    float x;  ///< of the centre, in the slab's frame
    float minus_inverse_radius_sq;
    float z;  ///< (z of the plane - z of the centre) times the former
  };

  /// Column factors times the peak, then row factors; with gradients then (y - y of the centre) *
  /// minus_inverse_radius_sq of each row: sweep_tile floats each.
  AlignedVector<float> factors;
  AlignedVector<float> cut;  ///< an entry is zero where its absolute value would be less
  AlignedVector<Slopes> slopes;
  /// Rows that an entry may reach in the columns of each vector.
  std::array<AlignedVector<RowBits>, sweep_vectors> rows;
  std::array<RowBits, sweep_vectors> any_rows;  ///< that some entry may reach
  std::vector<List> lists;                      ///< [plane][field]

  void reserve(std::size_t entries, bool gradients) {
    if (entries <= cut.size() && (!gradients || entries <= slopes.size())) return;
    const std::size_t room = 2 * entries;
    factors.resize(sweep_tile * (gradients ? 3 : 2) * room);
    if (gradients) slopes.resize(room);
    for (auto& bits : rows) bits.resize(room);
    cut.resize(room);
  }
};

/// Entries that one round of lists may take, about: a few MB.
inline constexpr std::size_t max_list_entries = 1 << 14;

/// Makes room in `lists` for the tile's kernels from `begin` on, as many as fit; returns the end of
/// these.
inline std::size_t lay_out_lists(const KernelSet& kernels, const GatheredKernels& gathered,
                                 const TileKernels& tile_kernels, int num_planes, bool gradients,
                                 std::size_t begin, FactorLists& lists) {
  const std::size_t num_fields = kernels.fields.size();
  // List.end: how many more kernels there are on a plane than on the one before; then sums.
  lists.lists.assign((static_cast<std::size_t>(num_planes) + 1) * num_fields, {});
  std::size_t end = begin, entries = 0;
  for (; end < tile_kernels.size && entries < max_list_entries; ++end) {
    const std::size_t field = field_of(kernels, gathered, tile_kernels.index[end]);
    const auto first = static_cast<std::size_t>(tile_kernels.first[end]);
    const auto last = static_cast<std::size_t>(tile_kernels.last[end]);
    ++lists.lists[first * num_fields + field].end;
    --lists.lists[(last + 1) * num_fields + field].end;  // unsigned: sums come out right
    entries += last - first + 1;
  }
  for (std::size_t i = num_fields; i < lists.lists.size(); ++i) {
    lists.lists[i].end += lists.lists[i - num_fields].end;
  }
  std::uint32_t next = 0;
  for (FactorLists::List& list : lists.lists) {
    const std::uint32_t count = list.end;
    list.begin = list.end = next;
    next += (count + 31) / 32 * 32;
  }
  lists.reserve(next + 64, gradients);
  return end;
}

/// Appends the kernel's factors on its planes to the lists of its field, `field_lists` being that
/// of plane 0.
template <bool kGradients>
HWY_INLINE void append_factors(const TileSamples& tile, const SweptKernel& kernel, int first,
                               int last, FactorLists::List* field_lists, std::size_t num_fields,
                               FactorLists& out) {
  const LaneTag d;
  const Lanes scale = hn::Set(d, kernel.exponent_scale), peak = hn::Set(d, kernel.peak);
  const Lanes support_value = hn::Set(d, kernel.support_value);
  const Lanes center_x = hn::Set(d, kernel.x), center_y = hn::Set(d, kernel.y);
  const float cut = kernel.support_value * std::abs(kernel.peak);
  for (int k = first; k <= last; ++k) {
    const std::size_t entry = field_lists[static_cast<std::size_t>(k) * num_fields].end++;
    float* const factors = out.factors.data() + entry * (sweep_tile * (kGradients ? 3u : 2u));
    const float z = tile.z[k] - kernel.z;
    const Lanes z_sq = hn::Set(d, z * z);
    Lanes columns[sweep_vectors], rows[sweep_vectors];
    for (int v = 0; v < sweep_vectors; ++v) {
      const int at = v * num_lanes;
      const Lanes x = hn::Sub(hn::Load(d, tile.x[k] + at), center_x);
      const Lanes y = hn::Sub(hn::Load(d, tile.y[k] + at), center_y);
      columns[v] = factor_of(d, hn::Mul(scale, hn::Mul(x, x)));
      rows[v] = factor_of(d, hn::Mul(scale, hn::MulAdd(y, y, z_sq)));
      hn::Store(hn::Mul(columns[v], peak), d, factors + at);
      hn::Store(rows[v], d, factors + sweep_tile + at);
      if constexpr (kGradients) {
        hn::Store(hn::Mul(y, hn::Set(d, kernel.minus_inverse_radius_sq)), d,
                  factors + 2 * sweep_tile + at);
      }
    }
    for (std::size_t h = 0; h < sweep_vectors; ++h) {
      const RowBits covered = covered_rows(d, columns[h], rows, support_value);
      out.rows[h][entry] = covered;
      out.any_rows[h] |= covered;
    }
    out.cut[entry] = cut;
    if constexpr (kGradients) {
      out.slopes[entry] = {kernel.x, kernel.minus_inverse_radius_sq,
                           z * kernel.minus_inverse_radius_sq};
    }
  }
}

/// Fills `lists` with kernels of the tile from `begin` on, as many as one round takes; returns the
/// end of these.
template <bool kGradients>
HWY_NOINLINE std::size_t list_factors(const KernelSet& kernels, const SamplingConstants& constants,
                                      const GatheredKernels& gathered,
                                      const TileKernels& tile_kernels, const TileSamples& tile,
                                      int num_planes, std::size_t begin, FactorLists& lists) {
  const std::size_t end =
      lay_out_lists(kernels, gathered, tile_kernels, num_planes, kGradients, begin, lists);
  const std::size_t num_fields = kernels.fields.size();
  lists.any_rows.fill(0);
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t index = tile_kernels.index[i];
    append_factors<kGradients>(
        tile, make_swept_kernel(kernels, constants, gathered, index),
        static_cast<int>(tile_kernels.first[i]), static_cast<int>(tile_kernels.last[i]),
        lists.lists.data() + field_of(kernels, gathered, index), num_fields, lists);
  }
  return end;
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
