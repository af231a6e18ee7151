// The one tree of Motes: bounds of particles' centres and their largest radii, eight children a
// node.
//
// Particles are put in the order of a Hilbert curve; sixteen in a row make a leaf, eight leaves in
// a row a node, eight nodes a node of the next level, up to one root; particles of very different
// radii lie in different stretches of the order. So there are no pointers, the
// depth is the logarithm of the number of particles whatever their positions, and a leaf's
// particles load straight into vectors. Supports are no part of the tree: traversal extends the
// bounds by support_factor * max_radius, so that sigma changes without touching it.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/aligned.h"
#include "core/vec.h"

namespace motes {

struct Bvh {
  static constexpr std::size_t width = 8;       ///< children a node
  static constexpr std::size_t leaf_size = 16;  ///< particles a leaf
  static constexpr int max_levels = 11;         ///< enough for 2^32 particles: 16 * 8^10 > 2^32

  /// The bounds of eight children. A child that is not there has an empty box (min > max), which no
  /// test against its extended bounds hits.
  struct alignas(32) Node {
    float min_x[width], min_y[width], min_z[width];
    float max_x[width], max_y[width], max_z[width];
    float max_radius[width];
  };

  /// Levels one after another, the root's (one node) first. Child c of node i of a level is node
  /// 8 i + c of the next level; under the last level, leaf 8 i + c.
  UninitializedVector<Node> nodes;
  std::vector<std::size_t> level_begin;  ///< index into nodes, one a level
  std::size_t num_particles = 0;

  std::size_t num_leaves() const { return (num_particles + leaf_size - 1) / leaf_size; }
  std::size_t level_end(std::size_t level) const {
    return level + 1 < level_begin.size() ? level_begin[level + 1] : nodes.size();
  }
  std::size_t bytes() const { return nodes.size() * sizeof(Node); }
};

/// A particle as the tree sees it.
struct Sphere {
  float x, y, z, radius;
  Point3f center() const { return {x, y, z}; }
};

/// Particles' order along a Hilbert curve through their bounding box: element i is the particle
/// that comes i-th. Where radii differ by more than a factor of four and some are larger than the
/// particles' spacing, those come first, class by class, each class along a curve of its own, so
/// that they do not extend the leaves of the others. Deterministic: the same for any number of
/// threads; particles in one place keep the order of the input. Centres are finite, and fewer than
/// 2^32. Takes 16 bytes a particle while it works, besides what it returns.
UninitializedVector<std::uint32_t> spatial_order(std::span<const Sphere> spheres);

/// The tree over particles that are already in spatial order. radius: one a particle, or one for
/// all.
Bvh build_bvh(std::span<const float> x, std::span<const float> y, std::span<const float> z,
              std::span<const float> radius);

/// Fits the bounds of a tree to its particles where they are now, in the order that it was built
/// in.
void refit_bvh(Bvh& bvh, std::span<const float> x, std::span<const float> y,
               std::span<const float> z, std::span<const float> radius);

/// The box of all particles' centres.
Bounds3f bounds_of(const Bvh& bvh);

/// Surface of all leaves' boxes, each extended by its largest radius: what the number of leaves
/// that rays meet goes with. Particles that moved on since the tree was built make it larger.
double leaf_area(const Bvh& bvh);

/// Visits the leaves that `hits` does not rule out. hits(const Bvh::Node&) -> bit c set if child c
/// is to be visited; visit(leaf index). Hot: nothing is checked.
template <class Hits, class Visit>
void traverse(const Bvh& bvh, Hits&& hits, Visit&& visit) {
  struct Entry {
    std::uint32_t level;
    std::uint32_t index;  // within the level
  };
  // A node pops itself before it pushes at most 8 children, so 7 a level and one remain.
  std::array<Entry, 7 * Bvh::max_levels + 1> stack;
  std::size_t size = 0;
  const auto leaf_level = static_cast<std::uint32_t>(bvh.level_begin.size());
  if (leaf_level != 0) stack[size++] = {0, 0};
  while (size != 0) {
    const Entry entry = stack[--size];
    unsigned mask = hits(bvh.nodes[bvh.level_begin[entry.level] + entry.index]);
    const std::uint32_t child_level = entry.level + 1;
    while (mask != 0) {
      const std::uint32_t child = entry.index * static_cast<std::uint32_t>(Bvh::width) +
                                  static_cast<std::uint32_t>(__builtin_ctz(mask));
      mask &= mask - 1;
      if (child_level == leaf_level) {
        visit(child);
      } else {
        stack[size++] = {child_level, child};
      }
    }
  }
}

}  // namespace motes
