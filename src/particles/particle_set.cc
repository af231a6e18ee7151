#include "particles/particle_set.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace motes {

const Property* ParticleSet::find_property(std::string_view name) const {
  const auto it = std::find_if(properties.begin(), properties.end(),
                               [&](const Property& p) { return p.name == name; });
  return it == properties.end() ? nullptr : &*it;
}

std::uint16_t ParticleSet::species_index(std::string_view name) {
  const auto it = std::find(species_names.begin(), species_names.end(), name);
  if (it != species_names.end()) return static_cast<std::uint16_t>(it - species_names.begin());
  assert(species_names.size() < 65535);
  species_names.emplace_back(name);
  return static_cast<std::uint16_t>(species_names.size() - 1);
}

Bounds3d ParticleSet::bounds() const {
  Bounds3f box;
  for (std::size_t i = 0; i < size(); ++i) {
    if (std::isfinite(x[i]) && std::isfinite(y[i]) && std::isfinite(z[i])) {
      box.add(Point3f{x[i], y[i], z[i]});
    }
  }
  if (box.empty()) return {};
  const Vector3d shift{origin.x, origin.y, origin.z};
  return {Point3d(box.min) + shift, Point3d(box.max) + shift};
}

namespace {

/// The middle of the finite values, rounded to a multiple of a power of two near their extent;
/// 0 where the values are near zero already, so that files with small coordinates keep them as they
/// are.
template <class T>
double choose_origin(const std::vector<T>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  if (!(low <= high)) return 0;
  const double middle = low / 2 + high / 2, extent = high / 2 - low / 2;
  if (std::abs(middle) <= 4 * extent) return 0;
  if (extent == 0) return middle;
  const double grid = std::exp2(std::floor(std::log2(extent)));
  return std::round(middle / grid) * grid;
}

template <class T>
void shift_into(const std::vector<T>& values, double origin, std::vector<float>& out) {
  out.resize(values.size());  // `out` may be `values`
  std::transform(values.begin(), values.end(), out.begin(),
                 [&](T v) { return static_cast<float>(double(v) - origin); });
}

}  // namespace

void set_positions(ParticleSet& particles, const std::vector<double>& x,
                   const std::vector<double>& y, const std::vector<double>& z) {
  assert(x.size() == y.size() && x.size() == z.size());
  particles.origin = {choose_origin(x), choose_origin(y), choose_origin(z)};
  shift_into(x, particles.origin.x, particles.x);
  shift_into(y, particles.origin.y, particles.y);
  shift_into(z, particles.origin.z, particles.z);
}

void set_positions(ParticleSet& particles, std::vector<float> x, std::vector<float> y,
                   std::vector<float> z) {
  assert(x.size() == y.size() && x.size() == z.size());
  particles.x = std::move(x);
  particles.y = std::move(y);
  particles.z = std::move(z);
  particles.origin = {choose_origin(particles.x), choose_origin(particles.y),
                      choose_origin(particles.z)};
  shift_into(particles.x, particles.origin.x, particles.x);
  shift_into(particles.y, particles.origin.y, particles.y);
  shift_into(particles.z, particles.origin.z, particles.z);
}

}  // namespace motes
