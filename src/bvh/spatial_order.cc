// The order of particles in the tree: Hilbert keys, computed many at once, and a parallel radix
// sort.
#include <tbb/concurrent_vector.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_for_each.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <limits>
#include <vector>

#include "bvh/bvh.h"

namespace motes {
namespace {

constexpr std::size_t grain = 1 << 14;

/// What is sorted: a key in the upper half, the particle's index in the lower one, which makes all
/// words different and any way of sorting them give the same order.
using Word = std::uint64_t;
constexpr std::uint32_t index_of(Word word) { return static_cast<std::uint32_t>(word); }
constexpr std::uint32_t key_of(Word word) { return static_cast<std::uint32_t>(word >> 32); }

constexpr int key_bits = 10;  // per axis
constexpr double cells = 1 << key_bits;

/// Every third bit of the result holds a bit of v (10 bits).
constexpr std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 16) & 0x030000ff;
  v = (v | v << 8) & 0x0300f00f;
  v = (v | v << 4) & 0x030c30c3;
  v = (v | v << 2) & 0x09249249;
  return v;
}

/// Particles whose keys are computed together.
constexpr std::size_t block = 256;
using Block = std::array<std::uint32_t, block>;

/// Replaces x by the distance along the Hilbert curve of the cells with coordinates of key_bits
/// bits (Skilling 2004, "Programming the Hilbert curve": axes to transposed index, then
/// interleaved), for the first `count`. Free of branches, so that the compiler makes vectors of it.
void hilbert_keys(std::size_t count, Block& x, Block& y, Block& z) {
  // Undo the rotations and reflections of each level: where the level's bit of y (then z) is set,
  // the lower bits of x are inverted, else exchanged with those of y (z).
  for (int level = key_bits - 1; level > 0; --level) {
    const std::uint32_t lower = (1u << level) - 1;
    for (std::size_t i = 0; i < count; ++i) {
      const auto bit = [level](std::uint32_t v) { return 0u - (v >> level & 1u); };
      std::uint32_t a = x[i] ^ (lower & bit(x[i]));
      const std::uint32_t by = bit(y[i]), bz = bit(z[i]);
      const std::uint32_t swap_y = (a ^ y[i]) & lower & ~by;
      a ^= swap_y | (lower & by);
      y[i] ^= swap_y;
      const std::uint32_t swap_z = (a ^ z[i]) & lower & ~bz;
      z[i] ^= swap_z;
      x[i] = a ^ (swap_z | (lower & bz));
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    // Gray encode; `t` holds the parity of the bits of the last axis above each bit.
    const std::uint32_t b = y[i] ^ x[i], c = z[i] ^ b;
    std::uint32_t t = c >> 1;
    t ^= t >> 1;
    t ^= t >> 2;
    t ^= t >> 4;
    t ^= t >> 8;
    x[i] = spread_bits(x[i] ^ t) << 2 | spread_bits(b ^ t) << 1 | spread_bits(c ^ t);
  }
}

/// Particles in another order than that of memory are asked for so long before they are used.
constexpr std::size_t ahead = 16;

/// The grid of the curve through the bounds of some particles.
struct Grid {
  Bounds3f box;

  Grid(std::span<const Sphere> spheres, std::span<const Word> words) { add(spheres, words); }
  /// Of many, in parallel.
  static Grid of_many(std::span<const Sphere> spheres, std::span<const Word> words) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, words.size(), grain), Grid(spheres, {}),
        [&](const auto& range, Grid grid) {
          grid.add(spheres, words.subspan(range.begin(), range.size()));
          return grid;
        },
        [](Grid a, const Grid& b) {
          a.box.add(b.box);
          return a;
        });
  }

  void add(std::span<const Sphere> spheres, std::span<const Word> words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (i + ahead < words.size()) __builtin_prefetch(&spheres[index_of(words[i + ahead])]);
      box.add(spheres[index_of(words[i])].center());
    }
  }

  /// Cells per length, the same along all axes, so that cells are cubes; 0 where all is one point.
  double scale() const {
    const Vector3d extent(Point3d(box.max) - Point3d(box.min));
    const double longest = std::max({extent.x, extent.y, extent.z});
    return longest > 0 ? (cells - 1) / longest : 0;
  }

  /// Writes `words` with the keys of their cells to `keyed`, which may be `words`.
  void set_keys(std::span<const Sphere> spheres, std::span<const Word> words,
                std::span<Word> keyed) const {
    const double s = scale();
    const auto cell = [s](float p, float min) {
      return static_cast<std::uint32_t>(
          static_cast<int>(s * (static_cast<double>(p) - static_cast<double>(min))));
    };
    Block x, y, z;
    for (std::size_t begin = 0; begin < words.size(); begin += block) {
      const std::size_t count = std::min(block, words.size() - begin);
      for (std::size_t i = 0; i < count; ++i) {
        const Sphere& sphere = spheres[index_of(words[begin + i])];
        x[i] = cell(sphere.x, box.min.x);
        y[i] = cell(sphere.y, box.min.y);
        z[i] = cell(sphere.z, box.min.z);
      }
      hilbert_keys(count, x, y, z);
      for (std::size_t i = 0; i < count; ++i) {
        keyed[begin + i] = Word{x[i]} << 32 | index_of(words[begin + i]);
      }
    }
  }
};

constexpr int digit_bits = 10;
constexpr std::size_t num_digit_values = 1 << digit_bits;
constexpr int num_digits = 3 * key_bits / digit_bits;
/// Number of words with each digit, or where these begin.
using Counts = std::array<std::uint32_t, num_digit_values>;

constexpr std::size_t digit_of(Word word, int digit) {
  return word >> (32 + digit * digit_bits) & (num_digit_values - 1);
}

/// Moves words to `to`, sorted by digit(word), equal digits in the order that they have. Returns
/// where each digit's words begin.
template <class Digit>
Counts scatter(std::span<const Word> from, std::span<Word> to, Digit&& digit) {
  constexpr std::size_t max_parts = 64;
  const std::size_t part_size = std::max(grain, (from.size() + max_parts - 1) / max_parts);
  const std::size_t num_parts = (from.size() + part_size - 1) / part_size;
  std::vector<Counts> next(num_parts);  // of each part
  const auto words_of = [&](std::size_t part) {
    return from.subspan(part * part_size, std::min(part_size, from.size() - part * part_size));
  };
  tbb::parallel_for(std::size_t{0}, num_parts, [&](std::size_t part) {
    next[part].fill(0);
    for (const Word word : words_of(part)) ++next[part][digit(word)];
  });
  Counts begin;
  std::uint32_t sum = 0;
  for (std::size_t value = 0; value < num_digit_values; ++value) {
    begin[value] = sum;
    for (Counts& counts : next) sum += std::exchange(counts[value], sum);
  }
  tbb::parallel_for(std::size_t{0}, num_parts, [&](std::size_t part) {
    Counts& at = next[part];
    for (const Word word : words_of(part)) to[at[digit(word)]++] = word;
  });
  return begin;
}

/// Calls sort(first, count) for the words of each digit, in parallel.
template <class Sort>
void for_each_digit(const Counts& begin, std::size_t size, Sort&& sort) {
  tbb::parallel_for(std::size_t{0}, num_digit_values, [&](std::size_t value) {
    const std::size_t first = begin[value];
    const std::size_t last = value + 1 < num_digit_values ? begin[value + 1] : size;
    if (first != last) sort(first, last - first);
  });
}

/// One pass of a radix sort on one thread.
void scatter_serially(std::span<const Word> from, std::span<Word> to, int digit) {
  Counts next{};
  for (const Word word : from) ++next[digit_of(word, digit)];
  std::uint32_t sum = 0;
  for (std::uint32_t& count : next) sum += std::exchange(count, sum);
  for (const Word word : from) to[next[digit_of(word, digit)]++] = word;
}

/// Sorts words whose keys differ in the lowest `digits` digits. Every word moves once a digit
/// between the two arrays, so with an odd number of digits the sorted ones are in `to`, else in
/// `from`: whether the digits are taken from the highest, in parallel, or, of few words, from the
/// lowest.
void radix_sort(std::span<Word> from, std::span<Word> to, int digits) {
  constexpr std::size_t few = 1 << 17;  // both arrays fit a core's cache
  if (digits == 0) return;
  if (from.size() <= few) {
    for (int digit = 0; digit < digits; ++digit) {
      scatter_serially(from, to, digit);
      std::swap(from, to);
    }
    return;
  }
  const Counts begin =
      scatter(from, to, [digits](Word word) { return digit_of(word, digits - 1); });
  for_each_digit(begin, from.size(), [&](std::size_t first, std::size_t count) {
    radix_sort(to.subspan(first, count), from.subspan(first, count), digits - 1);
  });
}

/// Calls visit(first, count) for all words of one key in a row that begin in [begin, end), where
/// they are more than a leaf takes. What follows such words is looked at after the call.
template <class Visit>
void for_each_crowded_cell(std::span<const Word> words, std::size_t begin, std::size_t end,
                           Visit&& visit) {
  std::size_t first = begin;
  if (begin > 0) {  // the rest of one that began before
    while (first < end && key_of(words[first]) == key_of(words[begin - 1])) ++first;
  }
  while (first < end) {
    const std::uint32_t key = key_of(words[first]);
    std::size_t last = first + 1;
    while (last < words.size() && key_of(words[last]) == key) ++last;
    if (last - first > Bvh::leaf_size) visit(first, last - first);
    first = last;
  }
}

/// sort_spatially() on one thread.
void sort_few_spatially(std::span<const Sphere> spheres, std::span<Word> words) {
  const Grid grid(spheres, words);
  if (!(grid.scale() > 0)) return;
  grid.set_keys(spheres, words, words);
  std::sort(words.begin(), words.end());
  for_each_crowded_cell(words, 0, words.size(), [&](std::size_t first, std::size_t count) {
    sort_few_spatially(spheres, words.subspan(first, count));
  });
}

/// Sorts `words` along the Hilbert curve through their own bounds. Where many particles fall into
/// one cell of the curve's grid (clusters, or a few far outliers that squeeze all others together),
/// these are sorted again through their own, smaller bounds, which are never the cell of all;
/// coincident particles end it, in the order of the input.
void sort_spatially(std::span<const Sphere> spheres, std::span<Word> words,
                    std::span<Word> scratch) {
  constexpr std::size_t few = 1 << 12;
  if (words.size() <= few) return sort_few_spatially(spheres, words);
  const Grid grid = Grid::of_many(spheres, words);
  if (!(grid.scale() > 0)) return;
  const auto in_parallel = [&](auto&& work) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, words.size(), grain), work);
  };
  in_parallel([&](const auto& range) {
    grid.set_keys(spheres, words.subspan(range.begin(), range.size()),
                  scratch.subspan(range.begin(), range.size()));
  });
  static_assert(num_digits % 2 == 1);
  radix_sort(scratch, words, num_digits);

  // Sorting again writes new keys: all crowded cells have to be known before.
  using Cell = std::pair<std::size_t, std::size_t>;
  tbb::concurrent_vector<Cell> crowded;
  in_parallel([&](const auto& range) {
    for_each_crowded_cell(words, range.begin(), range.end(),
                          [&](std::size_t first, std::size_t count) {
                            crowded.push_back({first, count});
                          });
  });
  tbb::parallel_for_each(crowded.begin(), crowded.end(), [&](const Cell& cell) {
    const auto [first, count] = cell;
    sort_spatially(spheres, words.subspan(first, count), scratch.subspan(first, count));
  });
}

/// Radii within a class differ by this power of two at most, where there are classes.
constexpr int class_bits = 2;
constexpr int max_classes = 64;

/// Smallest and largest binary exponent of the radii (biased; the radii are >= 0).
struct Exponents {
  int min = std::numeric_limits<int>::max(), max = 0;

  void add(int exponent) {
    min = std::min(min, exponent);
    max = std::max(max, exponent);
  }
};

int exponent_of(const Sphere& sphere) {
  return static_cast<int>(std::bit_cast<std::uint32_t>(sphere.radius) >> 23);
}

Exponents exponents_of(std::span<const Sphere> spheres) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, spheres.size(), grain), Exponents{},
      [&](const auto& range, Exponents e) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) e.add(exponent_of(spheres[i]));
        return e;
      },
      [](Exponents a, const Exponents& b) {
        a.add(b.min);
        a.add(b.max);
        return a;
      });
}

/// Exponent of the particles' mean spacing, were they spread evenly over their bounds: kernels
/// smaller than that hardly extend a leaf's box, whatever their radii.
int spacing_exponent(std::span<const Sphere> spheres, std::span<const Word> words) {
  const Vector3d d(Grid::of_many(spheres, words).box.diagonal());
  const double spacing = std::cbrt(d.x * d.y * d.z / static_cast<double>(words.size()));
  return exponent_of({0, 0, 0, static_cast<float>(spacing)});
}

/// Sorts `words`, in the order of the particles, by classes of radii, the largest first, and each
/// class along its own curve. A leaf or node then holds kernels of one class, but for one a level
/// where two classes meet; so a few huge kernels extend few boxes. All that are smaller than the
/// spacing are one class.
void sort_by_class(std::span<const Sphere> spheres, std::span<Word> words,
                   std::span<Word> scratch) {
  const Exponents exponents = exponents_of(spheres);
  if (exponents.max - exponents.min <= class_bits) return sort_spatially(spheres, words, scratch);
  const int least = spacing_exponent(spheres, words);
  const auto class_above = [least](int exponent) {
    return (std::max(exponent - least, 0) + class_bits - 1) / class_bits;
  };
  const int largest = class_above(exponents.max);
  if (largest == 0) return sort_spatially(spheres, words, scratch);
  const auto class_of = [&](Word word) {
    const int steps = largest - class_above(exponent_of(spheres[index_of(word)]));
    return static_cast<std::size_t>(std::min(steps, max_classes - 1));
  };
  const Counts begin = scatter(words, scratch, class_of);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, words.size(), grain),
                    [&](const auto& range) {
                      std::copy(scratch.begin() + static_cast<std::ptrdiff_t>(range.begin()),
                                scratch.begin() + static_cast<std::ptrdiff_t>(range.end()),
                                words.begin() + static_cast<std::ptrdiff_t>(range.begin()));
                    });
  for_each_digit(begin, words.size(), [&](std::size_t first, std::size_t count) {
    sort_spatially(spheres, words.subspan(first, count), scratch.subspan(first, count));
  });
}

}  // namespace

UninitializedVector<std::uint32_t> spatial_order(std::span<const Sphere> spheres) {
  assert(spheres.size() <= std::numeric_limits<std::uint32_t>::max());
  const std::size_t n = spheres.size();
  UninitializedVector<Word> words(n);
  {
    UninitializedVector<Word> scratch(n);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain), [&](const auto& range) {
      for (std::size_t i = range.begin(); i != range.end(); ++i) words[i] = i;
    });
    sort_by_class(spheres, words, scratch);
  }
  UninitializedVector<std::uint32_t> order(n);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) order[i] = index_of(words[i]);
  });
  return order;
}

}  // namespace motes
