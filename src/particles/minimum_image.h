// The nearest of a particle's images in a periodic cell, however skewed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/vec.h"
#include "particles/cell.h"

namespace motes {

/// Shortens vectors between particles by whole edges of a cell along its periodic axes.
class MinimumImage {
 public:
  /// Axes whose edge is zero or not finite, or lies in those of the axes before it, count as not
  /// periodic. Without a cell nothing is.
  explicit MinimumImage(const std::optional<Cell>& cell);

  /// The shortest vector from a particle at `v` from another, or one of its images, to that one;
  /// to 1e-12 of its square where several are as short. The image of -v is minus that of v.
  Vector3d operator()(Vector3d v) const;

  /// What the periodic edges span, by short edges: as many as there are periodic axes, any two of
  /// them at an angle of 90 degrees or more.
  const std::vector<Vector3d>& edges() const { return edges_; }
  /// So many edges of each.
  Vector3d shift(const std::array<std::int8_t, 3>& count) const {
    Vector3d sum;
    for (std::size_t a = 0; a < edges_.size(); ++a)
      sum = sum + static_cast<double>(count[a]) * edges_[a];
    return sum;
  }

 private:
  struct Face {
    Vector3d to;  ///< the image beyond it
    double inverse_square = 0;
  };
  std::vector<Vector3d> edges_;
  std::vector<Face> faces_;  ///< of the region nearer to a particle than to its images, one a pair
};

}  // namespace motes
