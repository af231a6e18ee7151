// The sweep: the field on a slab of planes, tile by tile and block by block of pixels. Included
// once per instruction set.
//
// On a plane of constant depth a sample's squared distance to a kernel's centre is a sum of one
// term for its column of pixels and one for its row, so the Gaussian is a product of a column
// factor and a row factor: two vectors of exponentials serve all 256 samples of a tile. Those of
// all kernels that meet the tile are listed first (sweep_factors-inl.h); then each block takes what
// reaches it from the lists, and its sums never leave the registers (docs/sweep.md).
#if defined(MOTES_FIELD_SWEEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_SWEEP_INL_H_
#undef MOTES_FIELD_SWEEP_INL_H_
#else
#define MOTES_FIELD_SWEEP_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "field/sampling-inl.h"
#include "field/sweep_factors-inl.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// What is summed is kept in blocks of one vector, 4 pixels wide: what is seen of small things lies
/// in fewer of them than of rows. Blocks of a tile go row by row.
inline constexpr int sweep_block_width = 4;
inline constexpr int sweep_block_height = num_lanes / sweep_block_width;
inline constexpr int sweep_blocks_across = sweep_tile / sweep_block_width;
inline constexpr int sweep_blocks = sweep_blocks_across * sweep_tile / sweep_block_height;

/// Bit s is set if a block of strip s has its bit set in `blocks`.
inline unsigned strips_of(std::uint64_t blocks) {
  unsigned strips = 0;
  for (; blocks != 0; blocks &= blocks - 1) {
    const int b = std::countr_zero(blocks);
    const int row = b / sweep_blocks_across * sweep_block_height;
    const int h = b % sweep_blocks_across * sweep_block_width / num_lanes;
    strips |= 1u << (row / strip_height * sweep_vectors + h);
  }
  return strips;
}

/// Bit s is set if some row of strip s is set in `rows`, which has an element for each vector of
/// columns.
inline unsigned strips_of(const std::array<RowBits, sweep_vectors>& rows) {
  unsigned strips = 0;
  for (int s = 0; s < sweep_strips; ++s) {
    const unsigned of_column = rows[static_cast<std::size_t>(s % sweep_vectors)];
    const bool any = (of_column >> (s / sweep_vectors * strip_height) & 0xfu) != 0;
    strips |= static_cast<unsigned>(any) << s;
  }
  return strips;
}

/// Bit i: entry `at` + i of the 32 may reach some of `rows`.
HWY_INLINE std::uint32_t entries_reaching(const RowBits* at, RowBits rows) {
  const hn::CappedTag<RowBits, 32> d;
  std::uint32_t entries = 0;
  for (std::size_t i = 0; i < 32; i += hn::Lanes(d)) {
    const auto reached = hn::And(hn::Load(d, at + i), hn::Set(d, rows));
    std::uint32_t bits = 0;
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, hn::Ne(reached, hn::Zero(d)), bytes);
    std::memcpy(&bits, bytes, sizeof bits);
    entries |= bits << i;
  }
  return entries;
}

/// Calls visit(entry) for the entries of a list that may reach some of `rows` in the columns of
/// vector `h`. Returns how many there are.
template <class Visit>
HWY_INLINE std::uint64_t for_each_entry(const FactorLists& lists, const FactorLists::List& list,
                                        std::size_t h, RowBits rows, Visit&& visit) {
  std::uint64_t visited = 0;
  for (std::size_t begin = list.begin; begin < list.end; begin += 32) {
    std::uint32_t entries = entries_reaching(lists.rows[h].data() + begin, rows);
    if (list.end - begin < 32) entries &= (1u << (list.end - begin)) - 1;
    visited += static_cast<std::uint64_t>(std::popcount(entries));
    for (; entries != 0; entries &= entries - 1) {
      visit(begin + static_cast<std::size_t>(std::countr_zero(entries)));
    }
  }
  return visited;
}

/// sum + v where `inside`; AVX-512 does that in one operation.
HWY_INLINE Lanes add_inside(LaneTag, LaneMask inside, Lanes v, Lanes sum) {
  return HWY_TARGET <= HWY_AVX3 ? hn::IfThenElse(inside, hn::Add(sum, v), sum)
                                : hn::Add(sum, hn::IfThenElseZero(inside, v));
}

/// What one round of lists adds to the samples of a tile.
struct SweepRound {
  const FactorLists& lists;
  const TileSamples& tile;
  /// Of each field: gradients are kept only where some value of a strip may be seen.
  const Visibility* visibility;
  bool first;  ///< the samples hold nothing yet
};

/// Sums of a few rows of a strip.
template <int kRows, bool kGradients, bool kAbsolute>
struct RowSums {
  Lanes value[kRows], gradient[kGradients ? 3 : 1][kRows], absolute[kRows];
};

/// Adds a list's entries on plane `k` in the columns of vector `h`, `row` being the first of the
/// rows. Returns how many entries.
template <int kRows, bool kGradients, bool kAbsolute>
HWY_INLINE std::uint64_t sum_rows(LaneTag d, const SweepRound& round, const FactorLists::List& list,
                                  int k, int h, int row,
                                  RowSums<kRows, kGradients, kAbsolute>& sums) {
  const FactorLists& lists = round.lists;
  const Lanes x = hn::Load(d, round.tile.x[k] + h * num_lanes);
  const auto rows = static_cast<RowBits>(((1u << kRows) - 1) << row);
  return for_each_entry(
      lists, list, static_cast<std::size_t>(h), rows, [&](std::size_t entry) HWY_ATTR {
        const float* const factors =
            lists.factors.data() + entry * (sweep_tile * (kGradients ? 3u : 2u));
        const Lanes columns = hn::Load(d, factors + h * num_lanes);
        const Lanes cut = hn::Set(d, lists.cut[entry]);
        const float* const row_factors = factors + sweep_tile + row;
        Lanes slope_x = hn::Zero(d), slope_z = hn::Zero(d);
        if constexpr (kGradients) {
          const FactorLists::Slopes& slopes = lists.slopes[entry];
          slope_x =
              hn::Mul(hn::Sub(x, hn::Set(d, slopes.x)), hn::Set(d, slopes.minus_inverse_radius_sq));
          slope_z = hn::Set(d, slopes.z);
        }
        for (int j = 0; j < kRows; ++j) {
          const Lanes p = hn::Mul(columns, hn::Set(d, row_factors[j])), magnitude = hn::Abs(p);
          const LaneMask inside = hn::Ge(magnitude, cut);
          sums.value[j] = add_inside(d, inside, p, sums.value[j]);
          if constexpr (kGradients) {
            const Lanes phi = hn::IfThenElseZero(inside, p);
            const Lanes slope_y = hn::Set(d, row_factors[sweep_tile + j]);
            sums.gradient[0][j] = hn::MulAdd(phi, slope_x, sums.gradient[0][j]);
            sums.gradient[1][j] = hn::MulAdd(phi, slope_y, sums.gradient[1][j]);
            sums.gradient[2][j] = hn::MulAdd(phi, slope_z, sums.gradient[2][j]);
          }
          if constexpr (kAbsolute) {
            sums.absolute[j] = add_inside(d, inside, magnitude, sums.absolute[j]);
          }
        }
      });
}

/// Rows of a strip, one vector each, as many as a block is high, to the blocks that they make.
HWY_INLINE void rows_to_blocks(LaneTag d, Lanes* v) {
#if HWY_TARGET <= HWY_AVX3
  // Quarters of four vectors, transposed.
  const auto shuffle = [](Lanes a, Lanes b, auto order) HWY_ATTR {
    return Lanes{_mm512_shuffle_f32x4(a.raw, b.raw, decltype(order)::value)};
  };
  using First = std::integral_constant<int, 0x44>;
  using Last = std::integral_constant<int, 0xee>;
  using Even = std::integral_constant<int, 0x88>;
  using Odd = std::integral_constant<int, 0xdd>;
  const Lanes a = shuffle(v[0], v[1], First()), b = shuffle(v[2], v[3], First());
  const Lanes c = shuffle(v[0], v[1], Last()), e = shuffle(v[2], v[3], Last());
  v[0] = shuffle(a, b, Even());
  v[1] = shuffle(a, b, Odd());
  v[2] = shuffle(c, e, Even());
  v[3] = shuffle(c, e, Odd());
  (void)d;
#else
  if constexpr (sweep_block_height == 2) {
    const Lanes upper = v[0];
    v[0] = hn::ConcatLowerLower(d, v[1], upper);
    v[1] = hn::ConcatUpperUpper(d, v[1], upper);
  }
#endif
}

/// Turns rows of a strip into blocks and calls use(block, Lanes&) for each, blocks being counted
/// from the first row's first.
template <int kRows, class Use>
HWY_INLINE void for_each_block(LaneTag d, Lanes (&rows)[kRows], Use&& use) {
  for (int j = 0; j < kRows; j += sweep_block_height) {
    rows_to_blocks(d, rows + j);
    for (int i = 0; i < sweep_block_height; ++i) {
      use(j / sweep_block_height * sweep_blocks_across + i, rows[j + i]);
    }
  }
}

/// Where sums go: blocks of a tile, one after the other.
struct BlockSamples {
  std::size_t stride;      ///< floats from a block to the next
  float* samples;          ///< of block 0, laid out as in a SampleBuffer
  std::uint64_t* visible;  ///< [block][field]: bit k is set if something may be seen on plane k
};

/// Sums field `f` on plane `k` of a strip; `samples` is the field's channel 0 in block 0. Returns
/// how many entries.
template <bool kGradients, bool kAbsolute>
HWY_INLINE std::uint64_t sum_strip(LaneTag d, const SweepRound& round,
                                   const FactorLists::List& list, int k, std::size_t f,
                                   unsigned strip, const BlockSamples& blocks,
                                   std::size_t num_fields, float* samples) {
  // So many that all sums stay in registers; without AVX-512 there are only 16.
  constexpr int rows_at_once = kGradients && HWY_TARGET > HWY_AVX3 ? 2 : strip_height;
  const int h = static_cast<int>(strip) % sweep_vectors;
  const int first_row = static_cast<int>(strip) / sweep_vectors * strip_height;
  std::uint64_t visited = 0;
  for (int row = first_row; row < first_row + strip_height; row += rows_at_once) {
    RowSums<rows_at_once, kGradients, kAbsolute> sums;
    for (int j = 0; j < rows_at_once; ++j) {
      sums.value[j] = sums.absolute[j] = hn::Zero(d);
      for (auto& component : sums.gradient) component[j] = hn::Zero(d);
    }
    const std::uint64_t entries = sum_rows(d, round, list, k, h, row, sums);
    if (entries == 0 && !round.visibility[f].shows_zero()) continue;
    visited += entries;
    const int first_block = row / sweep_block_height * sweep_blocks_across + h * sweep_block_height;
    const auto add_before = [&](int channel, int block, Lanes& sum) HWY_ATTR {
      float* const at = samples + static_cast<std::size_t>(first_block + block) * blocks.stride +
                        channel * num_lanes;
      if (!round.first) sum = hn::Add(sum, hn::Load(d, at));
      hn::Store(sum, d, at);
    };
    bool any_seen = false;
    for_each_block(d, sums.value, [&](int block, Lanes& sum) HWY_ATTR {
      add_before(0, block, sum);
      const bool seen = may_be_seen(d, sum, round.visibility[f]);
      blocks.visible[static_cast<std::size_t>(first_block + block) * num_fields + f] |=
          std::uint64_t{seen} << k;
      any_seen = any_seen || seen;
    });
    if (!kGradients || !any_seen) continue;
    for (int i = 0; i < 3; ++i) {
      for_each_block(d, sums.gradient[i],
                     [&](int block, Lanes& sum) HWY_ATTR { add_before(1 + i, block, sum); });
    }
    if constexpr (kAbsolute) {
      for_each_block(d, sums.absolute,
                     [&](int block, Lanes& sum) HWY_ATTR { add_before(4, block, sum); });
    }
  }
  return visited;
}

/// Sets or, after the first round, adds to the samples on `num_planes` planes of the strips whose
/// bits are set in `strips`, and sets bits of `blocks.visible`. Where nothing may be seen,
/// gradients are left as they are. Returns kernel evaluations.
template <bool kGradients, bool kAbsolute>
HWY_NOINLINE std::uint64_t sum_planes(const SweepRound& round, const SampleLayout& layout,
                                      unsigned strips, int num_planes, const BlockSamples& blocks) {
  const LaneTag d;
  const auto num_fields = static_cast<std::size_t>(layout.num_fields);
  const std::size_t field_stride = layout.floats_per_sample() / num_fields;
  const FactorLists::List* list = round.lists.lists.data();
  float* samples = blocks.samples;
  std::uint64_t visited = 0;
  for (int k = 0; k < num_planes; ++k) {
    for (std::size_t f = 0; f < num_fields; ++f, ++list, samples += field_stride) {
      for (unsigned left = strips; left != 0; left &= left - 1) {
        visited += sum_strip<kGradients, kAbsolute>(d, round, *list, k, f,
                                                    static_cast<unsigned>(std::countr_zero(left)),
                                                    blocks, num_fields, samples);
      }
    }
  }
  return visited * strip_height * static_cast<std::uint64_t>(num_lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
