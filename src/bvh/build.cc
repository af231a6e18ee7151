// Building the tree: Hilbert keys, a parallel sort, then bounds from the leaves up.
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <limits>

#include "bvh/bvh.h"

namespace motes {
namespace {

constexpr std::size_t grain = 1 << 14;

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
};

bool before(const Keyed& a, const Keyed& b) {
  return a.key != b.key ? a.key < b.key : a.index < b.index;
}

constexpr int key_bits = 16;  // per axis

/// Every third bit of the result holds a bit of v (16 bits).
constexpr std::uint64_t spread_bits(std::uint64_t v) {
  v = (v | v << 16) & 0x0000ff0000ff;
  v = (v | v << 8) & 0x00f00f00f00f;
  v = (v | v << 4) & 0x0c30c30c30c3;
  v = (v | v << 2) & 0x249249249249;
  return v;
}

/// Distance along the Hilbert curve of a cell with 16-bit coordinates (Skilling 2004, "Programming
/// the Hilbert curve": axes to transposed index, then interleaved).
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  // Undo the rotations and reflections of each level.
  for (std::uint32_t q = 1u << (key_bits - 1); q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    if (x & q) x ^= p;
    if (y & q) {
      x ^= p;
    } else {
      const std::uint32_t t = (x ^ y) & p;
      x ^= t;
      y ^= t;
    }
    if (z & q) {
      x ^= p;
    } else {
      const std::uint32_t t = (x ^ z) & p;
      x ^= t;
      z ^= t;
    }
  }
  // Gray encode.
  y ^= x;
  z ^= y;
  std::uint32_t t = 0;
  for (std::uint32_t q = 1u << (key_bits - 1); q > 1; q >>= 1) {
    if (z & q) t ^= q - 1;
  }
  return spread_bits(x ^ t) << 2 | spread_bits(y ^ t) << 1 | spread_bits(z ^ t);
}

struct Positions {
  std::span<const float> x, y, z;
  Point3f operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

Bounds3f bounds_of(const Positions& positions, std::span<const Keyed> items) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, items.size(), grain), Bounds3f{},
      [&](const auto& range, Bounds3f box) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          box.add(positions[items[i].index]);
        }
        return box;
      },
      [](Bounds3f a, const Bounds3f& b) {
        a.add(b);
        return a;
      });
}

/// Sorts `items` along the Hilbert curve through their own bounds. Where many particles fall into
/// one cell of the curve's grid (a few far outliers squeeze all others together), these are sorted
/// again through their own, smaller bounds; coincident particles end it.
void sort_spatially(const Positions& positions, std::span<Keyed> items) {
  const Bounds3f box = bounds_of(positions, items);
  const Vector3d extent(Point3d(box.max) - Point3d(box.min));
  const double longest = std::max({extent.x, extent.y, extent.z});
  if (!(longest > 0)) return;  // none, or all in one point: the order of the input stays

  // One scale for all axes keeps the curve's cells cubes.
  constexpr double cells = 1 << key_bits;
  const double scale = (cells - 1) / longest;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, items.size(), grain), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          const Vector3d p = scale * (Point3d(positions[items[i].index]) - Point3d(box.min));
          items[i].key =
              hilbert_key(static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y),
                          static_cast<std::uint32_t>(p.z));
        }
      });
  tbb::parallel_sort(items.begin(), items.end(), before);

  for (std::size_t first = 0; first < items.size();) {
    std::size_t last = first + 1;
    while (last < items.size() && items[last].key == items[first].key) ++last;
    if (last - first > Bvh::leaf_size && last - first < items.size()) {
      sort_spatially(positions, items.subspan(first, last - first));
    }
    first = last;
  }
}

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A node whose children are all empty.
Bvh::Node empty_node() {
  Bvh::Node node;
  for (std::size_t c = 0; c < Bvh::width; ++c) {
    node.min_x[c] = node.min_y[c] = node.min_z[c] = infinity;
    node.max_x[c] = node.max_y[c] = node.max_z[c] = -infinity;
    node.max_radius[c] = 0;
  }
  return node;
}

void set_child(Bvh::Node& node, std::size_t c, const Bounds3f& box, float max_radius) {
  node.min_x[c] = box.min.x;
  node.min_y[c] = box.min.y;
  node.min_z[c] = box.min.z;
  node.max_x[c] = box.max.x;
  node.max_y[c] = box.max.y;
  node.max_z[c] = box.max.z;
  node.max_radius[c] = max_radius;
}

/// The union of a node's children becomes child c of its parent.
void set_child(Bvh::Node& parent, std::size_t c, const Bvh::Node& node) {
  Bounds3f box;
  float max_radius = 0;
  for (std::size_t i = 0; i < Bvh::width; ++i) {
    box.add(Bounds3f{{node.min_x[i], node.min_y[i], node.min_z[i]},
                     {node.max_x[i], node.max_y[i], node.max_z[i]}});
    max_radius = std::max(max_radius, node.max_radius[i]);
  }
  set_child(parent, c, box, max_radius);
}

/// Sets nodes [begin, begin + count) in parallel: set(node, index within the level).
template <class Set>
void fill_level(Bvh& bvh, std::size_t begin, std::size_t count, Set&& set) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      bvh.nodes[begin + i] = empty_node();
      set(bvh.nodes[begin + i], i);
    }
  });
}

}  // namespace

std::vector<std::uint32_t> spatial_order(std::span<const float> x, std::span<const float> y,
                                         std::span<const float> z) {
  assert(x.size() == y.size() && x.size() == z.size());
  assert(x.size() <= std::numeric_limits<std::uint32_t>::max());
  std::vector<Keyed> items(x.size());
  for (std::size_t i = 0; i < items.size(); ++i) items[i].index = static_cast<std::uint32_t>(i);
  sort_spatially({x, y, z}, items);
  std::vector<std::uint32_t> order(items.size());
  std::transform(items.begin(), items.end(), order.begin(), [](const Keyed& k) { return k.index; });
  return order;
}

Bvh build_bvh(std::span<const float> x, std::span<const float> y, std::span<const float> z,
              std::span<const float> radius) {
  assert(x.size() == y.size() && x.size() == z.size());
  assert(radius.size() == x.size() || radius.size() == 1);
  Bvh bvh;
  bvh.num_particles = x.size();
  if (x.empty()) return bvh;

  // Sizes of the levels, from the one above the leaves up to the root.
  std::vector<std::size_t> sizes;
  for (std::size_t n = bvh.num_leaves(); sizes.empty() || n > 1;) {
    n = (n + Bvh::width - 1) / Bvh::width;
    sizes.push_back(n);
  }
  std::size_t total = 0;
  for (auto it = sizes.rbegin(); it != sizes.rend(); ++it) {
    bvh.level_begin.push_back(total);
    total += *it;
  }
  bvh.nodes.resize(total);

  // Children that are leaves: bounds of up to 16 particles each.
  const std::size_t last_level = sizes.size() - 1;
  fill_level(bvh, bvh.level_begin[last_level], sizes[0], [&](Bvh::Node& node, std::size_t i) {
    for (std::size_t c = 0; c < Bvh::width; ++c) {
      const std::size_t first = (i * Bvh::width + c) * Bvh::leaf_size;
      const std::size_t last = std::min(first + Bvh::leaf_size, bvh.num_particles);
      if (first >= last) break;
      Bounds3f box;
      float max_radius = 0;
      for (std::size_t p = first; p < last; ++p) {
        box.add(Point3f{x[p], y[p], z[p]});
        max_radius = std::max(max_radius, radius[radius.size() == 1 ? 0 : p]);
      }
      set_child(node, c, box, max_radius);
    }
  });
  // Then level by level up to the root.
  for (std::size_t level = last_level; level-- > 0;) {
    const std::size_t below = bvh.level_begin[level + 1];
    const std::size_t num_below = sizes[last_level - level - 1];
    fill_level(bvh, bvh.level_begin[level], sizes[last_level - level],
               [&](Bvh::Node& node, std::size_t i) {
                 for (std::size_t c = 0; c < Bvh::width && i * Bvh::width + c < num_below; ++c) {
                   set_child(node, c, bvh.nodes[below + i * Bvh::width + c]);
                 }
               });
  }
  return bvh;
}

}  // namespace motes
