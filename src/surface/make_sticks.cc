#include "surface/make_sticks.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "particles/minimum_image.h"

namespace motes {
namespace {

/// What a particle is bonded to.
struct Partner {
  std::uint32_t particle;
  std::array<std::int8_t, 3> image;  ///< Bond::image, from the particle on
};

/// The partners of each particle: of particle p they are partners[begin[p]] and what follows.
struct Neighborhoods {
  std::vector<std::uint32_t> begin;
  std::vector<Partner> partners;
};

Vector3d between(const ParticleSet& particles, std::uint32_t from, std::uint32_t to) {
  const auto d = [&](const std::vector<float>& x) { return static_cast<double>(x[to]) - x[from]; };
  return {d(particles.x), d(particles.y), d(particles.z)};
}

Neighborhoods find_neighborhoods(const ParticleSet& particles, std::span<const Bond> bonds,
                                 const MinimumImage& image, double length_scale) {
  // Internal lengths are near 1 for the whole of the data.
  const auto has_direction = [&](const Bond& bond) {
    const Vector3d v = image(between(particles, bond.first, bond.second)) + image.shift(bond.image);
    const double d = length_scale * length(v);
    return d > 1e-15 && std::isfinite(d);
  };
  Neighborhoods n;
  n.begin.assign(particles.size() + 2, 0);
  const auto for_all = [&](auto&& add) {
    for (const Bond& bond : bonds) {
      if (!has_direction(bond)) continue;
      const auto opposite = [&](std::size_t a) { return static_cast<std::int8_t>(-bond.image[a]); };
      add(bond.first, {bond.second, bond.image});
      add(bond.second, {bond.first, {opposite(0), opposite(1), opposite(2)}});
    }
  };
  // Counted two places further on, then where each one's begin one place further on, which filling
  // moves to where the next one's begin.
  for_all([&](std::uint32_t p, const Partner&) { ++n.begin[p + 2]; });
  for (std::size_t p = 2; p < n.begin.size(); ++p) n.begin[p] += n.begin[p - 1];
  n.partners.resize(n.begin.back());
  for_all([&](std::uint32_t p, const Partner& q) { n.partners[n.begin[p + 1]++] = q; });
  return n;
}

}  // namespace

UninitializedVector<std::uint32_t> particles_in_order(const std::vector<FieldSource>& fields,
                                                      const KernelOrder& order) {
  UninitializedVector<std::uint32_t> particle_of(order.kernels.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, particle_of.size(), 1 << 14),
                    [&](const auto& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        const std::uint32_t k = order.kernels[i];
                        std::size_t f = 0;
                        while (k >= order.begins[f + 1]) ++f;
                        particle_of[i] = fields[f].index[k - order.begins[f]];
                      }
                    });
  return particle_of;
}

Sticks make_sticks(const ParticleSet& particles, std::span<const Bond> bonds,
                   std::span<const std::uint32_t> particle_of, const KernelSet& kernels,
                   float radius) {
  assert(particle_of.size() == kernels.size());
  Sticks sticks;
  sticks.radius.assign(1, radius);
  const MinimumImage image(particles.cell);
  const Neighborhoods n = find_neighborhoods(particles, bonds, image, kernels.length_scale);
  if (n.partners.empty() || kernels.size() == 0) return sticks;
  sticks.begin.resize(kernels.x.size() + 1);
  sticks.begin[0] = 0;
  for (std::size_t i = 0; i < kernels.x.size(); ++i) {
    std::uint32_t count = 0;
    if (i < kernels.size()) count = n.begin[particle_of[i] + 1] - n.begin[particle_of[i]];
    sticks.begin[i + 1] = sticks.begin[i] + count;
  }
  sticks.resize(sticks.size());

  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, kernels.size(), 1 << 12), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          const std::uint32_t p = particle_of[i];
          for (std::uint32_t s = sticks.begin[i]; s < sticks.begin[i + 1]; ++s) {
            const Partner& q = n.partners[n.begin[p] + s - sticks.begin[i]];
            const Vector3d whole = image(between(particles, p, q.particle)) + image.shift(q.image);
            const Vector3d half = 0.5 * kernels.length_scale * whole;
            sticks.x[s] = static_cast<float>(half.x);
            sticks.y[s] = static_cast<float>(half.y);
            sticks.z[s] = static_cast<float>(half.z);
            sticks.owner[s] = static_cast<std::uint8_t>(i % Bvh::leaf_size);
          }
        }
      });
  return sticks;
}

}  // namespace motes
