// Building the tree over particles in spatial order: bounds from the leaves up.
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>

#include "bvh/bvh.h"

namespace motes {
namespace {

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

Bounds3f bounds_of(const Bvh::Node& node) {
  Bounds3f box;
  for (std::size_t c = 0; c < Bvh::width; ++c) {
    box.add(Bounds3f{{node.min_x[c], node.min_y[c], node.min_z[c]},
                     {node.max_x[c], node.max_y[c], node.max_z[c]}});
  }
  return box;
}

/// The union of a node's children becomes child c of its parent.
void set_child(Bvh::Node& parent, std::size_t c, const Bvh::Node& node) {
  const float max_radius =
      *std::max_element(std::begin(node.max_radius), std::end(node.max_radius));
  set_child(parent, c, bounds_of(node), max_radius);
}

/// Sets the nodes of a level in parallel: set(node, index within the level).
template <class Set>
void fill_level(Bvh& bvh, std::size_t level, Set&& set) {
  const std::size_t begin = bvh.level_begin[level], count = bvh.level_end(level) - begin;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      bvh.nodes[begin + i] = empty_node();
      set(bvh.nodes[begin + i], i);
    }
  });
}

}  // namespace

Bvh build_bvh(std::span<const float> x, std::span<const float> y, std::span<const float> z,
              std::span<const float> radius) {
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
  refit_bvh(bvh, x, y, z, radius);
  return bvh;
}

void refit_bvh(Bvh& bvh, std::span<const float> x, std::span<const float> y,
               std::span<const float> z, std::span<const float> radius) {
  assert(x.size() == bvh.num_particles && y.size() == x.size() && z.size() == x.size());
  assert(radius.size() == x.size() || radius.size() == 1);
  if (x.empty()) return;
  // Children that are leaves: bounds of up to 16 particles each.
  const std::size_t last_level = bvh.level_begin.size() - 1;
  fill_level(bvh, last_level, [&](Bvh::Node& node, std::size_t i) {
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
    const std::size_t num_below = bvh.level_end(level + 1) - below;
    fill_level(bvh, level, [&](Bvh::Node& node, std::size_t i) {
      for (std::size_t c = 0; c < Bvh::width && i * Bvh::width + c < num_below; ++c) {
        set_child(node, c, bvh.nodes[below + i * Bvh::width + c]);
      }
    });
  }
}

Bounds3f bounds_of(const Bvh& bvh) {
  return bvh.nodes.empty() ? Bounds3f{} : bounds_of(bvh.nodes.front());
}

double leaf_area(const Bvh& bvh) {
  if (bvh.nodes.empty()) return 0;
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(bvh.level_begin.back(), bvh.nodes.size(), 1 << 12), 0.0,
      [&](const auto& range, double sum) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          const Bvh::Node& node = bvh.nodes[i];
          for (std::size_t c = 0; c < Bvh::width; ++c) {
            if (node.min_x[c] > node.max_x[c]) continue;  // not there
            const double reach = 2 * static_cast<double>(node.max_radius[c]);
            const double x = static_cast<double>(node.max_x[c]) - node.min_x[c] + reach;
            const double y = static_cast<double>(node.max_y[c]) - node.min_y[c] + reach;
            const double z = static_cast<double>(node.max_z[c]) - node.min_z[c] + reach;
            sum += 2 * (x * y + y * z + z * x);
          }
        }
        return sum;
      },
      std::plus<>());
}

}  // namespace motes
