// The sweep: the field on a slab of planes, for all pixels of a tile at once. Included once per
// instruction set.
//
// On a plane of constant depth a sample's squared distance to a kernel's centre is a sum of one
// term for its column of pixels and one for its row, so the Gaussian is a product of a column
// factor and a row factor: two vectors of exponentials serve all 256 samples of a tile. From plane
// to plane the factors are Gaussians in depth, stepped by two multiplications (docs/sweep.md).
#if defined(MOTES_FIELD_SWEEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_SWEEP_INL_H_
#undef MOTES_FIELD_SWEEP_INL_H_
#else
#define MOTES_FIELD_SWEEP_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "core/aligned.h"
#include "field/sampling-inl.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Pixels of a side of a tile.
inline constexpr int sweep_tile = 16;
/// A block is 4 pixels wide and as high as the lanes allow; blocks of a tile go row by row.
inline constexpr int sweep_block_width = 4;
inline constexpr int sweep_block_height = num_lanes / sweep_block_width;
inline constexpr int sweep_blocks = sweep_tile * sweep_tile / num_lanes;
/// Planes of a slab, at most.
inline constexpr int max_sweep_planes = 32;
/// Vectors of a tile's columns or rows.
inline constexpr int sweep_vectors = sweep_tile / num_lanes;

static_assert(64 % sweep_blocks == 0, "a word of cells holds whole planes");

/// Kernels that may reach some rays in a slab: placed in the slab's frame, in the tree's order.
struct GatheredKernels {
  AlignedVector<float> x, y, z, radius;
  AlignedVector<std::uint32_t> index;  ///< of the kernel in its set
  std::size_t size = 0;

  /// Makes room for `count` more and for what a vector writes beyond them.
  void reserve(std::size_t count) {
    if (size + count + max_lanes <= x.size()) return;
    const std::size_t room = 2 * (size + count + max_lanes);
    for (auto* array : {&x, &y, &z, &radius}) array->resize(room);
    index.resize(room);
  }
};

/// Finds the kernels that may reach `frustum`.
HWY_NOINLINE void gather_kernels(const KernelSet& kernels, const SamplingConstants& constants,
                                 const SlabFrame& frame, const Frustum& frustum,
                                 GatheredKernels& out) {
  const LaneTag d;
  const hn::RebindToUnsigned<LaneTag> du;
  out.size = 0;
  const auto visit = [&](std::size_t leaf) HWY_ATTR {
    out.reserve(Bvh::leaf_size);
    for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::Lanes(d)) {
      const std::size_t at = leaf * Bvh::leaf_size + i;
      const Centers<Lanes> centers = place_centers(d, kernels, at, frame);
      const Lanes radius = hn::Load(d, kernels.radius.data() + at);
      const Lanes support = hn::Mul(radius, hn::Set(d, constants.max_support_factor));
      const LaneMask reaches = find_reach(d, frame, frustum, centers, support).any;
      const auto index = hn::Iota(du, static_cast<std::uint32_t>(at));
      hn::StoreU(hn::Compress(centers.x, reaches), d, out.x.data() + out.size);
      hn::StoreU(hn::Compress(centers.y, reaches), d, out.y.data() + out.size);
      hn::StoreU(hn::Compress(centers.z, reaches), d, out.z.data() + out.size);
      hn::StoreU(hn::Compress(radius, reaches), d, out.radius.data() + out.size);
      hn::StoreU(hn::Compress(index, hn::RebindMask(du, reaches)), du, out.index.data() + out.size);
      out.size += hn::CountTrue(d, reaches);
    }
  };
  traverse(
      kernels.bvh,
      [&](const Bvh::Node& node) {
        return node_hits(node, frame, frustum, constants.max_support_factor);
      },
      visit);
  // Fills the last vector with kernels that reach nothing.
  out.reserve(max_lanes);
  hn::StoreU(hn::Set(d, 1e15f), d, out.x.data() + out.size);
  hn::StoreU(hn::Zero(d), d, out.radius.data() + out.size);
}

/// The rays of a tile in a slab's frame: the sample in column i and row j at depth dz relative to
/// the reference is (column_offset[i] + dz column_direction[i], row_offset[j] + dz
/// row_direction[j], dz).
struct TileRays {
  alignas(64) float column_offset[sweep_tile], column_direction[sweep_tile];
  alignas(64) float row_offset[sweep_tile], row_direction[sweep_tile];
  float first_depth, step;
  float inverse_shift;  ///< one over the farthest that a sample of a ray lies from the next
};

inline TileRays make_tile_rays(const RayBounds& rays, const SlabFrame& frame) {
  TileRays tile;
  const auto place = [&](const Range& origin, const Range& direction, double reference,
                         bool falling, float* offsets, float* directions) {
    for (int i = 0; i < sweep_tile; ++i) {
      const double t = static_cast<double>(falling ? sweep_tile - 1 - i : i) / (sweep_tile - 1);
      const double slope = direction.low + t * (direction.high - direction.low);
      const double at = origin.low + t * (origin.high - origin.low);
      offsets[i] = static_cast<float>(at + frame.reference_depth * slope - reference);
      directions[i] = static_cast<float>(slope);
    }
  };
  place(rays.origin_x, rays.direction_x, frame.reference_x, false, tile.column_offset,
        tile.column_direction);
  place(rays.origin_y, rays.direction_y, frame.reference_y, true, tile.row_offset,
        tile.row_direction);
  tile.first_depth = frame.first_depth;
  tile.step = frame.step;
  const auto steepest = [](const Range& r) { return std::max(std::abs(r.low), std::abs(r.high)); };
  tile.inverse_shift = static_cast<float>(
      1 / (frame.step * std::hypot(1, steepest(rays.direction_x), steepest(rays.direction_y))));
  return tile;
}

/// A kernel as the sweep needs it: place in the frame, in camera axes.
struct SweptKernel {
  float x, y, z;
  float exponent_scale;  ///< -log2(e) / (2 radius^2)
  float inverse_radius_sq;
  float peak;           ///< kappa * weight, of a normalised field over the kernel's integral
  float support_value;  ///< exp(-sigma^2 / 2): the kernel is zero where it would be less
  int first, last;      ///< planes of the slab, both included
  int planes_per_seed;  ///< planes that stepping may reach from one seed
  int field;
};

/// Factors of a kernel on the planes of a slab, and the offsets of samples from its centre.
struct KernelFactors {
  alignas(64) float column[max_sweep_planes][sweep_tile], row[max_sweep_planes][sweep_tile];
  alignas(64) float x[max_sweep_planes][sweep_tile], y[max_sweep_planes][sweep_tile];
  float z[max_sweep_planes];
};

/// exp2(scale * distance_sq), or 0 where that is so small that stepping may not start from it.
HWY_INLINE Lanes seed_factor(LaneTag d, Lanes exponent) {
  constexpr float smallest = -120.0f;
  return hn::IfThenElseZero(hn::Ge(exponent, hn::Set(d, smallest)), exp2_bounded<6>(d, exponent));
}

/// exp2 of an exponent that may lie outside of what a float can hold.
HWY_INLINE Lanes step_factor(LaneTag d, Lanes exponent) {
  return exp2_bounded<6>(
      d, hn::Min(hn::Max(exponent, hn::Set(d, min_exponent)), hn::Set(d, -min_exponent)));
}

/// A factor on one plane, its ratio to the next, and the ratio of ratios.
struct SteppedFactor {
  Lanes value, ratio, ratio_of_ratios;

  void step() {
    value = hn::Mul(value, ratio);
    ratio = hn::Mul(ratio, ratio_of_ratios);
  }
};

/// exp2(scale * (s + k shift)^2) on plane k, for `distance_sq` = s^2, `twice_along` = 2 s . shift,
/// `shift_sq` = shift^2.
HWY_INLINE SteppedFactor seed(LaneTag d, Lanes scale, Lanes distance_sq, Lanes twice_along,
                              Lanes shift_sq) {
  return {seed_factor(d, hn::Mul(scale, distance_sq)),
          step_factor(d, hn::Mul(scale, hn::Add(twice_along, shift_sq))),
          step_factor(d, hn::Mul(hn::Add(scale, scale), shift_sq))};
}

/// Maximum of each group of `kSize` neighbours (1, 2 or 4), in all lanes of the group.
template <int kSize>
HWY_INLINE Lanes group_max(LaneTag, Lanes v) {
  if constexpr (kSize >= 2) v = hn::Max(v, hn::Shuffle2301(v));
  if constexpr (kSize >= 4) v = hn::Max(v, hn::Shuffle1032(v));
  return v;
}

/// Indices for TableLookupLanes: lane l takes lane l / 4, its row of pixels in the block.
HWY_INLINE auto row_indices(LaneTag d) {
  alignas(64) std::int32_t indices[max_lanes];
  for (int l = 0; l < num_lanes; ++l) {
    indices[l] = l / sweep_block_width;
  }
  return hn::SetTableIndices(d, indices);
}

/// Bit b is set if a sample of block b may lie in the kernel's support: if the largest column
/// factor times the largest row factor of the block reaches its value there.
HWY_INLINE std::uint64_t covered_blocks(LaneTag d, const SteppedFactor* columns,
                                        const SteppedFactor* rows, Lanes support_value) {
  // Lane l: the maximum of columns 4 (l % 4) to 4 (l % 4) + 3.
  Lanes maxima[sweep_vectors];
  for (int v = 0; v < sweep_vectors; ++v) {
    maxima[v] = group_max<sweep_block_width>(d, columns[v].value);
  }
  for (int n = sweep_vectors, left = sweep_tile / sweep_block_width; left > 1; left /= 2) {
    for (int v = 0; v < std::max(n / 2, 1); ++v) {
      maxima[v] = hn::ConcatEven(d, maxima[std::min(2 * v + 1, n - 1)], maxima[2 * v]);
    }
    n = std::max(n / 2, 1);
  }
  const Lanes column_max = maxima[0];

  // Each row of blocks has four of them.
  constexpr int tests_per_vector = num_lanes / sweep_block_height / (num_lanes / 4);
  std::uint64_t blocks = 0;
  for (int v = 0; v < sweep_vectors; ++v) {
    const Lanes row_max = group_max<sweep_block_height>(d, rows[v].value);
    for (int t = 0; t < tests_per_vector; ++t) {
      // Lane l: row of blocks (l / 4) of this test.
      Lanes spread = row_max;
      if constexpr (sweep_block_height != 4) {
        alignas(64) std::int32_t indices[max_lanes];
        for (int l = 0; l < num_lanes; ++l) {
          indices[l] = (t * (num_lanes / 4) + l / 4) * sweep_block_height;
        }
        spread = hn::TableLookupLanes(row_max, hn::SetTableIndices(d, indices));
      }
      const LaneMask covered = hn::Ge(hn::Mul(column_max, spread), support_value);
      blocks |= static_cast<std::uint64_t>(mask_bits(d, covered))
                << (v * tests_per_vector + t) * num_lanes;
    }
  }
  return blocks;
}

/// Steps the kernel's factors over its planes. Sets the bits of the cells that it may reach, a word
/// for 64 cells.
template <bool kGradients>
HWY_INLINE void sweep_planes(const TileRays& tile, const SweptKernel& kernel,
                             std::uint64_t live_blocks, KernelFactors& factors,
                             std::uint64_t* cells) {
  const LaneTag d;
  constexpr std::size_t lanes = num_lanes;
  constexpr int planes_per_word = 64 / sweep_blocks;
  const Lanes scale = hn::Set(d, kernel.exponent_scale), two = hn::Set(d, 2.0f);
  const Lanes step = hn::Set(d, tile.step), support_value = hn::Set(d, kernel.support_value);
  for (int begin = kernel.first; begin <= kernel.last; begin += kernel.planes_per_seed) {
    const float depth = tile.first_depth + static_cast<float>(begin) * tile.step;
    const Lanes z = hn::Set(d, depth - kernel.z);
    SteppedFactor columns[sweep_vectors], rows[sweep_vectors];
    Lanes x[sweep_vectors], y[sweep_vectors], shift_x[sweep_vectors], shift_y[sweep_vectors];
    for (int v = 0; v < sweep_vectors; ++v) {
      const std::size_t at = static_cast<std::size_t>(v) * lanes;
      const Lanes direction_x = hn::Load(d, tile.column_direction + at);
      const Lanes direction_y = hn::Load(d, tile.row_direction + at);
      x[v] = hn::MulAdd(hn::Set(d, depth), direction_x,
                        hn::Sub(hn::Load(d, tile.column_offset + at), hn::Set(d, kernel.x)));
      y[v] = hn::MulAdd(hn::Set(d, depth), direction_y,
                        hn::Sub(hn::Load(d, tile.row_offset + at), hn::Set(d, kernel.y)));
      shift_x[v] = hn::Mul(direction_x, step);
      shift_y[v] = hn::Mul(direction_y, step);
      columns[v] = seed(d, scale, hn::Mul(x[v], x[v]), hn::Mul(two, hn::Mul(x[v], shift_x[v])),
                        hn::Mul(shift_x[v], shift_x[v]));
      rows[v] = seed(d, scale, hn::MulAdd(y[v], y[v], hn::Mul(z, z)),
                     hn::Mul(two, hn::MulAdd(y[v], shift_y[v], hn::Mul(z, step))),
                     hn::MulAdd(shift_y[v], shift_y[v], hn::Mul(step, step)));
    }
    const int end = std::min(kernel.last, begin + kernel.planes_per_seed - 1);
    for (int k = begin; k <= end; ++k) {
      for (int v = 0; v < sweep_vectors; ++v) {
        const std::size_t at = static_cast<std::size_t>(v) * lanes;
        hn::Store(columns[v].value, d, factors.column[k] + at);
        hn::Store(rows[v].value, d, factors.row[k] + at);
        if constexpr (kGradients) {
          hn::Store(x[v], d, factors.x[k] + at);
          hn::Store(y[v], d, factors.y[k] + at);
          x[v] = hn::Add(x[v], shift_x[v]);
          y[v] = hn::Add(y[v], shift_y[v]);
        }
      }
      if constexpr (kGradients) {
        factors.z[k] = tile.first_depth + static_cast<float>(k) * tile.step - kernel.z;
      }
      const std::uint64_t blocks = covered_blocks(d, columns, rows, support_value) & live_blocks;
      cells[k / planes_per_word] |= blocks << (k % planes_per_word * sweep_blocks);
      for (int v = 0; v < sweep_vectors; ++v) {
        columns[v].step();
        rows[v].step();
      }
    }
  }
}

/// Adds the kernel to the cells of one word: 64 word + i for each bit i.
template <bool kGradients, bool kAbsolute>
HWY_INLINE void add_to_cells(const SweptKernel& kernel, const KernelFactors& factors, int word,
                             std::uint64_t bits, SampleBuffer& buffer) {
  const LaneTag d;
  constexpr std::size_t lanes = num_lanes;
  const auto spread_rows = row_indices(d);
  const Lanes support_value = hn::Set(d, kernel.support_value), peak = hn::Set(d, kernel.peak);
  const int first_plane = word * (64 / sweep_blocks);
  const float *const columns = factors.column[first_plane], *const rows = factors.row[first_plane];
  float* const word_values = buffer.at(64 * word, kernel.field);
  const std::size_t cell_stride = buffer.layout().floats_per_sample();
  for (; bits != 0; bits &= bits - 1) {
    const auto cell = static_cast<std::size_t>(std::countr_zero(bits));  // of this word
    const std::size_t plane = cell / sweep_blocks;
    const std::size_t column = plane * sweep_tile + cell % 4 * 4;
    const std::size_t row = cell / 4 * sweep_block_height;
    const Lanes p = hn::Mul(hn::LoadDup128(d, columns + column),
                            hn::TableLookupLanes(hn::LoadDup128(d, rows + row), spread_rows));
    const LaneMask inside = hn::Ge(p, support_value);
    float* const values = word_values + cell * cell_stride;
    if constexpr (!kGradients) {
      const Lanes sum = hn::Load(d, values);
      hn::Store(hn::MulAdd(hn::IfThenElseZero(inside, p), peak, sum), d, values);
    } else {
      const Lanes phi = hn::IfThenElseZero(inside, hn::Mul(p, peak));
      hn::Store(hn::Add(phi, hn::Load(d, values)), d, values);
      const Lanes slope = hn::Mul(phi, hn::Set(d, -kernel.inverse_radius_sq));
      const Lanes offsets[3] = {
          hn::LoadDup128(d, factors.x[first_plane] + column),
          hn::TableLookupLanes(hn::LoadDup128(d, factors.y[first_plane] + row), spread_rows),
          hn::Set(d, factors.z[first_plane + static_cast<int>(plane)])};
      for (std::size_t i = 0; i < 3; ++i) {
        float* const gradient = values + (1 + i) * lanes;
        hn::Store(hn::MulAdd(slope, offsets[i], hn::Load(d, gradient)), d, gradient);
      }
      if constexpr (kAbsolute) {
        float* const absolute = values + 4 * lanes;
        hn::Store(hn::Add(hn::Abs(phi), hn::Load(d, absolute)), d, absolute);
      }
    }
  }
}

/// Kernel i of those gathered, but for its planes.
HWY_INLINE SweptKernel make_swept_kernel(const KernelSet& kernels,
                                         const SamplingConstants& constants,
                                         const GatheredKernels& gathered, std::size_t i,
                                         float inverse_shift) {
  const std::size_t at = gathered.index[i];
  const std::size_t f = kernels.field.empty() ? 0 : kernels.field[at];
  const FieldConstants& field = constants.fields[f];
  const float radius = gathered.radius[i];
  SweptKernel kernel;
  kernel.x = gathered.x[i];
  kernel.y = gathered.y[i];
  kernel.z = gathered.z[i];
  kernel.inverse_radius_sq = 1.0f / (radius * radius);
  kernel.exponent_scale = -0.5f * std::numbers::log2e_v<float> * kernel.inverse_radius_sq;
  kernel.peak = field.peak_factor * kernels.weight[at];
  kernel.support_value = field.support_value;
  // A factor below 2^-120, at 12.8 radii, is seeded as 0 and stays 0: so that no sample comes from
  // there into the support, stepping covers no more than the distance between them.
  const float planes = (12.8f - field.support_factor) * radius * inverse_shift;
  constexpr float most = 3;  // more save nothing, and errors grow with the square of the steps
  kernel.planes_per_seed = 1 + static_cast<int>(std::clamp(planes, 0.0f, most));
  kernel.field = static_cast<int>(f);
  return kernel;
}

/// Fills `buffer` (all zero before, sweep_blocks blocks) with the fields at the samples of the tile
/// with bounds `rays` in the frame's slab. Block b is done if bit b of `live_blocks` is set.
/// Returns kernel evaluations.
template <bool kGradients, bool kAbsolute>
HWY_NOINLINE std::uint64_t sample_sweep(const KernelSet& kernels,
                                        const SamplingConstants& constants, const View& view,
                                        const GatheredKernels& gathered, const SlabFrame& frame,
                                        const RayBounds& rays, std::uint64_t live_blocks,
                                        SampleBuffer& buffer) {
  const LaneTag d;
  const Frustum frustum = make_frustum(rays, frame, view);
  const TileRays tile = make_tile_rays(rays, frame);
  KernelFactors factors;
  std::uint64_t evaluations = 0;
  for (std::size_t i = 0; i < gathered.size; i += hn::Lanes(d)) {
    const Centers<Lanes> centers{hn::Load(d, gathered.x.data() + i),
                                 hn::Load(d, gathered.y.data() + i),
                                 hn::Load(d, gathered.z.data() + i)};
    const Lanes support =
        hn::Mul(hn::Load(d, gathered.radius.data() + i), hn::Set(d, constants.max_support_factor));
    const Reach<LaneTag> reach = find_reach(d, frame, frustum, centers, support);
    alignas(64) float first[max_lanes], last[max_lanes];
    hn::Store(reach.first, d, first);
    hn::Store(reach.last, d, last);
    for (unsigned bits = mask_bits(d, reach.any); bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      SweptKernel kernel =
          make_swept_kernel(kernels, constants, gathered, i + lane, tile.inverse_shift);
      kernel.first = static_cast<int>(first[lane]);
      kernel.last = static_cast<int>(last[lane]);
      constexpr int planes_per_word = 64 / sweep_blocks;
      std::uint64_t cells[max_sweep_planes / planes_per_word] = {};
      sweep_planes<kGradients>(tile, kernel, live_blocks, factors, cells);
      for (int word = kernel.first / planes_per_word; word <= kernel.last / planes_per_word;
           ++word) {
        buffer.touch_word(word, cells[word]);
        evaluations += static_cast<std::uint64_t>(std::popcount(cells[word]));
        add_to_cells<kGradients, kAbsolute>(kernel, factors, word, cells[word], buffer);
      }
    }
  }
  return evaluations * hn::Lanes(d);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
