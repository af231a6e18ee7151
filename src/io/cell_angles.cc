// Crystallography's convention for the axes of a cell.
#include "io/cell_angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace motes {

std::optional<Cell> cell_from_angles(const std::array<double, 3>& edges,
                                     const std::array<double, 3>& angles) {
  const auto is_placeholder = [](double e) { return e == 0 || e == 1; };
  const bool usable =
      std::all_of(edges.begin(), edges.end(), [](double e) { return std::isfinite(e) && e > 0; }) &&
      std::all_of(angles.begin(), angles.end(), [](double a) { return a > 0 && a < 180; });
  if (!usable || std::all_of(edges.begin(), edges.end(), is_placeholder)) return std::nullopt;

  // Right angles give exact zeros.
  const auto cosine = [](double degrees) {
    return degrees == 90 ? 0 : std::cos(degrees * std::numbers::pi / 180);
  };
  const double cos_alpha = cosine(angles[0]), cos_beta = cosine(angles[1]),
               cos_gamma = cosine(angles[2]);
  const double sin_gamma = std::sqrt(1 - cos_gamma * cos_gamma);
  const double cy = (cos_alpha - cos_beta * cos_gamma) / sin_gamma;
  const double cz_squared = 1 - cos_beta * cos_beta - cy * cy;
  if (!(cz_squared > 0)) return std::nullopt;
  Cell cell;
  cell.vectors[0] = {edges[0], 0, 0};
  cell.vectors[1] = {edges[1] * cos_gamma, edges[1] * sin_gamma, 0};
  cell.vectors[2] = {edges[2] * cos_beta, edges[2] * cy, edges[2] * std::sqrt(cz_squared)};
  return cell;
}

}  // namespace motes
