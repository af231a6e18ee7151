// Periodic cells of all shapes, and atoms in them.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/vec.h"
#include "particles/cell.h"
#include "particles/particle_set.h"

namespace motes {

/// Calls use(w) with the images w of v in the cell, all that are as short as v or as `reach`.
template <class F>
void for_images(const Cell& cell, const Vector3d& v, double reach, F&& use) {
  const std::array<Vector3d, 3>& e = cell.vectors;
  const double volume = dot(e[0], cross(e[1], e[2]));
  const auto across = [&](std::size_t a) { return cross(e[(a + 1) % 3], e[(a + 2) % 3]) / volume; };
  Vector3d from = v;  // an image not far from the origin, that there be few to look at
  for (std::size_t a = 0; a < 3; ++a) {
    if (cell.periodic[a]) from = from - std::round(dot(across(a), v)) * e[a];
  }
  std::array<int, 3> most{};
  for (std::size_t a = 0; a < 3; ++a) {
    // From there to such an image it is so far at most, and planes of images are so far apart:
    const double way = length(from) + std::max(length(from), reach);
    const double spacing = 1 / length(across(a));
    if (cell.periodic[a]) most[a] = static_cast<int>(way / spacing) + 1;
  }
  for (int i = -most[0]; i <= most[0]; ++i) {
    for (int j = -most[1]; j <= most[1]; ++j) {
      for (int k = -most[2]; k <= most[2]; ++k) {
        use(from + double(i) * e[0] + double(j) * e[1] + double(k) * e[2]);
      }
    }
  }
}

/// A cell with edges of up to `edge` in all directions, any of them periodic.
class CellSource {
 public:
  explicit CellSource(unsigned seed) : random_(seed) {}
  Cell draw(double edge) {
    Cell cell;
    do {
      for (Vector3d& v : cell.vectors) v = draw_vector(edge);
    } while (std::abs(dot(cell.vectors[0], cross(cell.vectors[1], cell.vectors[2]))) <
             0.05 * edge * edge * edge);
    for (bool& periodic : cell.periodic) periodic = uniform() < 0.75;
    return cell;
  }
  Vector3d draw_vector(double edge) {
    return {edge * (2 * uniform() - 1), edge * (2 * uniform() - 1), edge * (2 * uniform() - 1)};
  }
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }

 private:
  std::mt19937 random_;
};

inline ParticleSet atoms_at(const std::vector<std::pair<std::string, Point3d>>& atoms) {
  ParticleSet particles;
  std::vector<double> x, y, z;
  for (const auto& [species, p] : atoms) {
    particles.species.push_back(particles.species_index(species));
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  set_positions(particles, x, y, z);
  return particles;
}

}  // namespace motes
