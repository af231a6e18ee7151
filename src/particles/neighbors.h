// Nearest neighbours of particles, through periodic boundaries where there are any.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/report.h"
#include "core/vec.h"
#include "particles/cell.h"

namespace motes {

/// Coordinates of particles, three arrays of one length.
struct Coordinates {
  std::span<const float> x, y, z;
};

/// A balanced k-d tree over positions that stores its nodes' boxes: for this room's own statistics
/// (spacing, smoothing lengths). Positions that are not finite are left out. Identical positions
/// are neighbours at distance 0.
class NeighborTree {
 public:
  /// In parallel, O(n log n). Of a periodic cell the 26 images next to it are looked at.
  /// Nodes of up to `leaf_size` points are not divided: large ones build faster and answer slower.
  /// Precondition: fewer than 2^32 particles.
  NeighborTree(const Coordinates& coordinates, const std::optional<Cell>& cell,
               std::size_t leaf_size = 12);

  /// Number of finite positions.
  std::size_t size() const { return points_.size(); }

  /// The distance from each `wanted` particle (all, where that is empty) to its k-th nearest other
  /// particle, wanted or not (its own images count as others), in the order of the coordinates;
  /// infinity where there are fewer than k, for positions that are not finite and for particles
  /// that are not wanted. In parallel; the result does not depend on the number of threads.
  /// Precondition: k >= 1.
  std::vector<float> kth_distances(int k, const std::vector<bool>& wanted = {},
                                   Progress* progress = nullptr) const;

  /// Distances to the nearest neighbour of about `num_samples` particles (of all, if there are
  /// fewer), evenly chosen: always the same ones. Infinity where there is no other particle.
  std::vector<float> sample_nearest_distances(std::size_t num_samples) const;

 private:
  struct Point {
    Point3f position;
    std::uint32_t index;
  };
  /// A node of the implicit binary tree, with the range of points below it; node i has the children
  /// 2i + 1 and 2i + 2, which share its range half and half.
  struct Node {
    std::size_t index, begin, end;
    Node left() const { return {2 * index + 1, begin, begin + (end - begin) / 2}; }
    Node right() const { return {2 * index + 2, begin + (end - begin) / 2, end}; }
  };
  class Nearest;

  Node root() const { return {0, 0, points_.size()}; }
  bool is_leaf(const Node& node) const { return 2 * node.index + 1 >= boxes_.size(); }
  void build(const Node& node);
  float kth_distance(const Point& query, Nearest& nearest) const;
  void search(const Point3f& center, std::uint32_t excluded, Nearest& nearest) const;

  std::vector<Point> points_;
  std::vector<Bounds3f> boxes_;
  std::vector<Vector3f> image_shifts_;
  std::size_t num_coordinates_ = 0;
};

}  // namespace motes
