// Looks for a typical place, then counts outwards from it.
#include "motes/bench/cut_out.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace motes {
namespace {

/// Half the side of the smallest cube around `center` that holds particle `i`.
float cube_distance(const ParticleSet& particles, const Vector3d& center, std::size_t i) {
  const auto away = [](float a, double b) { return std::abs(a - static_cast<float>(b)); };
  return std::max({away(particles.x[i], center.x), away(particles.y[i], center.y),
                   away(particles.z[i], center.z)});
}

}  // namespace

Point3d typical_center(const ParticleSet& particles, const std::vector<std::size_t>& counts) {
  constexpr int candidates = 6;  // along each axis, in the middle half
  // A sample of the particles tells.
  const std::size_t stride = std::max<std::size_t>(1, particles.size() / 100'000);
  const Bounds3d box = particles.bounds();
  const Vector3d size = box.diagonal();
  const double density = static_cast<double>(particles.size()) / (size.x * size.y * size.z);
  Point3d best = box.center();
  double least = std::numeric_limits<double>::max();
  std::vector<double> found(counts.size());
  for (int c = 0; c < candidates * candidates * candidates; ++c) {
    const auto along = [](int i) { return 0.25 + 0.5 * (i + 0.5) / candidates; };
    const double u = along(c / (candidates * candidates)), v = along(c / candidates % candidates),
                 w = along(c % candidates);
    const Point3d center = box.min + Vector3d{u * size.x, v * size.y, w * size.z};
    const Vector3d local = center - particles.origin;
    std::ranges::fill(found, 0.0);
    for (std::size_t i = 0; i < particles.size(); i += stride) {
      const double distance = static_cast<double>(cube_distance(particles, local, i));
      for (std::size_t k = 0; k < counts.size(); ++k) {
        const double half = std::cbrt(static_cast<double>(counts[k]) / density) / 2;
        if (distance < half) found[k] += static_cast<double>(stride);
      }
    }
    double worst = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      // One stride more or less is chance.
      const auto chance = static_cast<double>(stride);
      const double ratio = (found[k] + chance) / (static_cast<double>(counts[k]) + chance);
      worst = std::max(worst, std::abs(std::log(ratio)));
    }
    if (worst < least) {
      least = worst;
      best = center;
    }
  }
  return best;
}

ParticleSet cut_out(const ParticleSet& particles, const Point3d& center, std::size_t count) {
  const Vector3d local = center - particles.origin;
  std::vector<float> distance(particles.size());
  for (std::size_t i = 0; i < distance.size(); ++i) {
    distance[i] = cube_distance(particles, local, i);
  }
  std::vector<float> sorted = distance;
  const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(count - 1);
  std::nth_element(sorted.begin(), last, sorted.end());
  std::vector<std::uint32_t> kept;
  kept.reserve(count);
  for (std::size_t i = 0; i < distance.size() && kept.size() < count; ++i) {
    if (distance[i] <= *last) kept.push_back(static_cast<std::uint32_t>(i));
  }
  const auto take = [&kept](const auto& values) {
    std::remove_cvref_t<decltype(values)> taken;
    if (values.empty()) return taken;
    taken.reserve(kept.size());
    for (const std::uint32_t i : kept) taken.push_back(values[i]);
    return taken;
  };
  ParticleSet out;
  out.origin = particles.origin;
  out.x = take(particles.x);
  out.y = take(particles.y);
  out.z = take(particles.z);
  out.species_names = particles.species_names;
  out.species = take(particles.species);
  for (const Property& property : particles.properties) {
    out.properties.push_back({property.name, take(property.values)});
  }
  out.length_unit = particles.length_unit;
  return out;
}

}  // namespace motes
