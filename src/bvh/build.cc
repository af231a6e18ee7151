// Building the tree over particles in spatial order: bounds from the leaves up.
#include <tbb/parallel_for.h>

#include <algorithm>
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
