// Build and search of the k-d tree.
#include "particles/neighbors.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace motes {

namespace {

constexpr std::uint32_t no_particle = std::numeric_limits<std::uint32_t>::max();
constexpr float infinity = std::numeric_limits<float>::infinity();

float squared(float v) { return v * v; }

float squared_distance(const Point3f& a, const Point3f& b) {
  return squared(a.x - b.x) + squared(a.y - b.y) + squared(a.z - b.z);
}

float squared_distance(const Point3f& p, const Bounds3f& box) {
  const float dx = std::max({box.min.x - p.x, p.x - box.max.x, 0.0F});
  const float dy = std::max({box.min.y - p.y, p.y - box.max.y, 0.0F});
  const float dz = std::max({box.min.z - p.z, p.z - box.max.z, 0.0F});
  return squared(dx) + squared(dy) + squared(dz);
}

int widest_axis(const Bounds3f& box) {
  const Vector3f d = box.diagonal();
  return d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
}

std::vector<Vector3f> shifts_to_images(const Cell& cell) {
  std::array<int, 3> reach{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double edge = length(cell.vectors[axis]);
    reach[axis] = cell.periodic[axis] && std::isfinite(edge) && edge > 0 ? 1 : 0;
  }
  std::vector<Vector3f> shifts;
  for (int i = -reach[0]; i <= reach[0]; ++i) {
    for (int j = -reach[1]; j <= reach[1]; ++j) {
      for (int k = -reach[2]; k <= reach[2]; ++k) {
        if (i == 0 && j == 0 && k == 0) continue;
        shifts.emplace_back(double(i) * cell.vectors[0] + double(j) * cell.vectors[1] +
                            double(k) * cell.vectors[2]);
      }
    }
  }
  return shifts;
}

}  // namespace

/// The k smallest squared distances seen, as a heap with the largest of them on top.
class NeighborTree::Nearest {
 public:
  explicit Nearest(int k) : k_(static_cast<std::size_t>(k)) { heap_.reserve(k_); }
  void clear() { heap_.clear(); }
  /// Nothing at this squared distance or beyond can change the result.
  float bound() const { return heap_.size() < k_ ? infinity : heap_.front(); }
  void add(float distance) {
    if (!(distance < bound())) return;
    if (heap_.size() == k_) {
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.back() = distance;
    } else {
      heap_.push_back(distance);
    }
    std::push_heap(heap_.begin(), heap_.end());
  }

 private:
  std::size_t k_;
  std::vector<float> heap_;
};

NeighborTree::NeighborTree(const Coordinates& coordinates, const std::optional<Cell>& cell,
                           std::size_t leaf_size)
    : num_coordinates_(coordinates.x.size()) {
  assert(num_coordinates_ < no_particle);
  points_.reserve(num_coordinates_);
  for (std::size_t i = 0; i < num_coordinates_; ++i) {
    const Point3f p{coordinates.x[i], coordinates.y[i], coordinates.z[i]};
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) {
      points_.push_back({p, static_cast<std::uint32_t>(i)});
    }
  }
  if (cell) image_shifts_ = shifts_to_images(*cell);
  const std::size_t num_leaves = std::bit_ceil(points_.size() / leaf_size + 1);
  boxes_.resize(2 * num_leaves - 1);
  if (!points_.empty()) build(root());
}

void NeighborTree::build(const Node& node) {
  Bounds3f& box = boxes_[node.index];
  for (std::size_t i = node.begin; i < node.end; ++i) box.add(points_[i].position);
  if (is_leaf(node)) return;

  const int axis = widest_axis(box);
  const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(
      at(node.begin), at(node.left().end), at(node.end),
      [axis](const Point& a, const Point& b) { return a.position[axis] < b.position[axis]; });
  constexpr std::size_t worth_a_task = 4096;
  if (node.end - node.begin > worth_a_task) {
    tbb::parallel_invoke([&] { build(node.left()); }, [&] { build(node.right()); });
  } else {
    build(node.left());
    build(node.right());
  }
}

void NeighborTree::search(const Point3f& center, std::uint32_t excluded, Nearest& nearest) const {
  struct Entry {
    Node node;
    float distance;
  };
  // A node leaves one sibling behind on each level: 64 levels are more than memory holds.
  std::array<Entry, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = {root(), squared_distance(center, boxes_[0])};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (!(entry.distance < nearest.bound())) continue;
    if (is_leaf(entry.node)) {
      for (std::size_t i = entry.node.begin; i < entry.node.end; ++i) {
        if (points_[i].index == excluded) continue;
        nearest.add(squared_distance(center, points_[i].position));
      }
      continue;
    }
    // The nearer child is visited first.
    Entry near{entry.node.left(), squared_distance(center, boxes_[entry.node.left().index])};
    Entry far{entry.node.right(), squared_distance(center, boxes_[entry.node.right().index])};
    if (far.distance < near.distance) std::swap(near, far);
    stack[depth++] = far;
    stack[depth++] = near;
  }
}

float NeighborTree::kth_distance(const Point& query, Nearest& nearest) const {
  nearest.clear();
  search(query.position, query.index, nearest);
  for (const Vector3f& shift : image_shifts_) {
    const Point3f image = query.position + shift;
    if (squared_distance(image, boxes_[0]) < nearest.bound()) search(image, no_particle, nearest);
  }
  return std::sqrt(nearest.bound());
}

std::vector<float> NeighborTree::kth_distances(int k, const std::vector<bool>& wanted,
                                               Progress* progress) const {
  assert(wanted.empty() || wanted.size() == num_coordinates_);
  std::vector<float> distances(num_coordinates_, infinity);
  const auto query = [&](const tbb::blocked_range<std::size_t>& range) {
    Nearest nearest(k);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::uint32_t index = points_[i].index;
      if (wanted.empty() || wanted[index]) distances[index] = kth_distance(points_[i], nearest);
    }
  };
  // In the tree's order, so that queries in a row walk the same nodes; in batches, so that the user
  // sees it go on.
  const std::size_t n = points_.size(), batch = n / 50 + 1;
  for (std::size_t begin = 0; begin < n; begin += batch) {
    const std::size_t end = std::min(begin + batch, n);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, 256), query);
    if (progress != nullptr) {
      progress->update("finding neighbours", static_cast<double>(end) / static_cast<double>(n));
    }
  }
  return distances;
}

std::vector<float> NeighborTree::sample_nearest_distances(std::size_t num_samples) const {
  const std::size_t n = std::min(num_samples, points_.size());
  std::vector<float> distances(n);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 64),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      Nearest nearest(1);
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        distances[i] = kth_distance(points_[i * points_.size() / n], nearest);
                      }
                    });
  return distances;
}

}  // namespace motes
