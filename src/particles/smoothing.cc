// The two ways to a smoothing length that a file does not give.
#include "particles/smoothing.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace motes {

std::vector<float> smoothing_lengths_from_density(std::span<const float> mass,
                                                  std::span<const float> density) {
  assert(mass.size() == density.size());
  std::vector<float> lengths(mass.size());
  std::transform(mass.begin(), mass.end(), density.begin(), lengths.begin(), [](float m, float d) {
    const double volume = double(m) / double(d);
    if (!(m > 0) || !(d > 0) || !std::isfinite(volume)) return 0.0F;
    return static_cast<float>(
        std::cbrt(3 * num_smoothing_neighbors * volume / (4 * std::numbers::pi)));
  });
  return lengths;
}

std::vector<float> smoothing_lengths_from_neighbors(const Coordinates& coordinates,
                                                    const std::optional<Cell>& cell,
                                                    const std::vector<bool>& wanted,
                                                    Progress* progress) {
  const NeighborTree tree(coordinates, cell);
  if (tree.size() < 2) return std::vector<float>(coordinates.x.size(), 0.0F);
  const int k = static_cast<int>(std::min<std::size_t>(num_smoothing_neighbors, tree.size() - 1));
  std::vector<float> lengths = tree.kth_distances(k, wanted, progress);
  const float scale = static_cast<float>(std::cbrt(double(num_smoothing_neighbors) / k));
  for (float& length : lengths) length = std::isfinite(length) ? length * scale : 0.0F;
  return lengths;
}

}  // namespace motes
