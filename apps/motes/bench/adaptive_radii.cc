#include "motes/bench/adaptive_radii.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/vec.h"
#include "motes/bench/random.h"

namespace motes {
namespace {

double side_of(std::size_t count) { return std::cbrt(static_cast<double>(count)); }

/// Uniform at random in the cube, with the radii that radius_of(i) gives.
template <class RadiusOf>
ParticleSet evenly_spread(std::size_t count, const RadiusOf& radius_of) {
  const Random random(31);
  const double half = side_of(count) / 2;
  ParticleSet particles;
  particles.properties = {{"radius", {}}};
  std::vector<float>* const values[] = {&particles.x, &particles.y, &particles.z,
                                        &particles.properties[0].values};
  for (auto* array : values) array->resize(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      (*values[axis])[i] = static_cast<float>(random.uniform(3 * i + axis, -half, half));
    }
    (*values[3])[i] = static_cast<float>(radius_of(i));
  });
  return particles;
}

/// From 2 down over so many orders of magnitude.
ParticleSet log_uniform(std::size_t count, double orders) {
  const Random random(32);
  return evenly_spread(
      count, [&](std::size_t i) { return 2 * std::pow(10, -orders * random.uniform(i)); });
}

/// All 0.25, but one in `every` of 10.
ParticleSet few_huge(std::size_t count, std::size_t every) {
  every = std::min(every, count);
  return evenly_spread(count, [&](std::size_t i) { return i % every == every / 2 ? 10 : 0.25; });
}

/// A cluster whose density falls with the distance's cube: as many particles in each decade of
/// distances, and distances of neighbours that are proportional to the distance.
struct Cluster {
  static constexpr double decades = 4;
  Vector3d center;
  double size, particles;

  double density(const Vector3d& p) const {
    const double inner = size * std::pow(10, -decades);
    const double distance = std::max(length(p - center), inner);
    if (distance > size) return 0;
    return particles /
           (4 * std::numbers::pi * decades * std::numbers::ln10 * distance * distance * distance);
  }
};

std::vector<Cluster> make_clusters(double side, double particles) {
  constexpr std::size_t count = 64;
  const Random random(33);
  std::vector<Cluster> clusters;
  clusters.reserve(count);
  for (std::size_t c = 0; c < count; ++c) {
    const auto coordinate = [&](std::size_t axis) {
      return random.uniform(4 * c + axis, -0.5, 0.5) * side;
    };
    clusters.push_back({{coordinate(0), coordinate(1), coordinate(2)},
                        side * 0.05 * std::pow(6, random.uniform(4 * c + 3)),
                        particles / count});
  }
  return clusters;
}

Vector3d random_direction(const Random& random, std::size_t i) {
  const double z = random.uniform(2 * i, -1, 1);
  const double angle = 2 * std::numbers::pi * random.uniform(2 * i + 1);
  const double across = std::sqrt(1 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

/// Four fifths of the particles in clusters, the others evenly spread; a particle's radius is half
/// of the distance of neighbours at the density where it is, as smoothing lengths are.
ParticleSet cosmological_run(std::size_t count) {
  const double side = side_of(count), spread = 0.2;
  const std::vector<Cluster> clusters =
      make_clusters(side, (1 - spread) * static_cast<double>(count));
  ParticleSet particles = evenly_spread(count, [](std::size_t) { return 0.0; });
  const Random distances(34), directions(35);
  const auto first = static_cast<std::size_t>(spread * static_cast<double>(count));
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    Vector3d p{particles.x[i], particles.y[i], particles.z[i]};
    if (i >= first) {
      const Cluster& cluster = clusters[i % clusters.size()];
      const double distance = cluster.size * std::pow(10, -Cluster::decades * distances.uniform(i));
      p = cluster.center + distance * random_direction(directions, i);
      particles.x[i] = static_cast<float>(p.x);
      particles.y[i] = static_cast<float>(p.y);
      particles.z[i] = static_cast<float>(p.z);
    }
    double density = spread;
    for (const Cluster& cluster : clusters) density += cluster.density(p);
    particles.properties[0].values[i] = static_cast<float>(0.5 / std::cbrt(density));
  });
  return particles;
}

/// The same with ten huge ones.
ParticleSet cosmological_run_with_huge(std::size_t count) {
  ParticleSet particles = cosmological_run(count);
  for (std::size_t i = 0; i < 10; ++i) {
    particles.properties[0].values[i * (count / 10)] = static_cast<float>(0.1 * side_of(count));
  }
  return particles;
}

constexpr AdaptiveRadii all[] = {
    {"clusters", "clusters, smoothing lengths", cosmological_run},
    {"clusters_huge", "the same, ten huge ones", cosmological_run_with_huge},
    {"four_orders", "log-uniform, 2e-4 to 2", [](std::size_t n) { return log_uniform(n, 4); }},
    {"eight_orders", "log-uniform, 2e-8 to 2", [](std::size_t n) { return log_uniform(n, 8); }},
    {"huge_rare", "0.25, one in 200,000 of 10", [](std::size_t n) { return few_huge(n, 200'000); }},
    {"huge_many", "0.25, one in 2,000 of 10", [](std::size_t n) { return few_huge(n, 2'000); }}};

}  // namespace

std::span<const AdaptiveRadii> adaptive_radii() { return all; }

}  // namespace motes
