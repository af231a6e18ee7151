// The cosmological box: many particles out of each of a small simulation's.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "motes/bench/random.h"
#include "motes/bench/recipes.h"

namespace motes {

ParticleSet make_cosmology(const ParticleSet& box, std::size_t children) {
  const Property* h = box.find_property("h");
  if (h == nullptr || !box.cell) {
    throw Error("the cosmological box has no smoothing lengths or no cell; expected data/demo's");
  }
  const std::size_t n = box.size() * children;
  const double side = std::cbrt(static_cast<double>(n));
  const double scale = side / box.cell->vectors[0].x;
  // h holds 32 neighbours.
  constexpr double neighbors = 32, width = 0.5;
  const double spread = width * std::cbrt(4 * std::numbers::pi / 3 / neighbors) * scale;
  const Random random(5);
  ParticleSet out;
  out.length_unit = "mean distance of particles";
  const auto fill = [&](int axis, std::vector<float>& values) {
    values.resize(n);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, box.size()), [&](const auto& range) {
      for (std::size_t parent = range.begin(); parent < range.end(); ++parent) {
        const double center = (box.position(parent) - box.cell->origin)[axis] * scale;
        const double deviation = spread * static_cast<double>(h->values[parent]);
        for (std::size_t i = parent * children; i < (parent + 1) * children; ++i) {
          const double x =
              center + deviation * random.normal(3 * i + static_cast<std::size_t>(axis));
          values[i] = static_cast<float>(x - side * std::floor(x / side));
        }
      }
    });
  };
  fill(0, out.x);
  fill(1, out.y);
  fill(2, out.z);
  return out;
}

}  // namespace motes
