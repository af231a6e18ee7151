// Radii from properties, elements or spacing.
#include "particles/radii.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <type_traits>

#include "core/error.h"
#include "particles/elements.h"
#include "particles/neighbors.h"
#include "particles/smoothing.h"

namespace motes {

namespace {

constexpr const char* from_neighbors = "smoothing lengths, else the 32nd neighbour's distance";

std::vector<std::size_t> count_species(const ParticleSet& particles) {
  std::vector<std::size_t> counts(particles.species_names.size());
  for (const std::uint16_t s : particles.species) ++counts[s];
  return counts;
}

bool lengths_are_angstrom(const ParticleSet& particles) {
  const std::string& unit = particles.length_unit;
  return unit == "angstrom" || unit == "unknown" || unit.empty();
}

/// Radius of each species, or nothing where most particles are no elements.
std::optional<std::vector<float>> species_radii(const ParticleSet& particles, Warnings& warnings) {
  if (particles.species.empty() || !lengths_are_angstrom(particles)) return std::nullopt;
  const std::vector<std::size_t> counts = count_species(particles);
  std::vector<float> radii(counts.size(), 0.0F);
  double sum = 0;
  std::size_t num_known = 0;
  for (std::size_t s = 0; s < radii.size(); ++s) {
    const Element* element = find_element(particles.species_names[s]);
    if (element == nullptr) continue;
    radii[s] = element->covalent_radius;
    sum += element->covalent_radius * static_cast<double>(counts[s]);
    num_known += counts[s];
  }
  if (num_known == 0 || 2 * num_known < particles.size()) return std::nullopt;

  const float mean = static_cast<float>(sum / static_cast<double>(num_known));
  for (std::size_t s = 0; s < radii.size(); ++s) {
    if (radii[s] > 0 || counts[s] == 0) continue;
    radii[s] = mean;
    warnings.add(
        fmt::format("species {} is no element; its radius is {:.3g}, the mean of the others",
                    printable(particles.species_names[s]), mean));
  }
  return radii;
}

/// The property "radius", completed by the distances to neighbours for the particles `wanted`.
std::vector<float> complete_radii(const ParticleSet& particles, const std::vector<bool>& wanted,
                                  Progress* progress) {
  std::vector<float> radius(particles.size(), std::numeric_limits<float>::quiet_NaN());
  if (const Property* own = particles.find_property("radius")) radius = own->values;
  std::vector<std::vector<std::size_t>> lacking(particles.species_names.size() + 1);
  for (std::size_t i = 0; i < radius.size(); ++i) {
    if (!std::isnan(radius[i])) continue;
    lacking[particles.species.empty() ? 0 : particles.species[i]].push_back(i);
  }
  for (const std::vector<std::size_t>& indices : lacking) {
    const auto gather = [&](const auto& values) {
      std::decay_t<decltype(values)> own(indices.size());
      std::transform(indices.begin(), indices.end(), own.begin(),
                     [&](std::size_t i) { return values[i]; });
      return own;
    };
    const std::vector<bool> ours =
        wanted.empty() ? std::vector<bool>(indices.size(), true) : gather(wanted);
    if (std::find(ours.begin(), ours.end(), true) == ours.end()) continue;
    const std::vector<float> x = gather(particles.x), y = gather(particles.y),
                             z = gather(particles.z);
    const std::vector<float> support =
        smoothing_lengths_from_neighbors({x, y, z}, particles.cell, ours, progress);
    for (std::size_t k = 0; k < indices.size(); ++k) {
      if (ours[k]) radius[indices[k]] = static_cast<float>(support[k] / support_per_sigma);
    }
  }
  return radius;
}

}  // namespace

double mean_neighbor_distance(const ParticleSet& particles) {
  // Few queries: most of the time is the tree's build. The mean is good to about 1 %.
  constexpr std::size_t num_samples = 4096, leaf_size = 1024;
  const NeighborTree tree({particles.x, particles.y, particles.z}, particles.cell, leaf_size);
  double sum = 0;
  std::size_t count = 0;
  for (const float distance : tree.sample_nearest_distances(num_samples)) {
    if (!(distance > 0) || !std::isfinite(distance)) continue;
    sum += distance;
    ++count;
  }
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

bool has_sizes(const ParticleSet& particles) {
  return particles.radii_from_neighbors || particles.find_property("radius") != nullptr;
}

DefaultRadii default_radii(const ParticleSet& particles, Warnings& warnings,
                           const std::vector<bool>& wanted, Progress* progress) {
  assert(wanted.empty() || wanted.size() == particles.size());
  if (particles.radii_from_neighbors) {
    return {complete_radii(particles, wanted, progress), from_neighbors};
  }
  if (const Property* radius = particles.find_property("radius")) {
    return {radius->values, "the file's radii or smoothing lengths"};
  }
  if (const auto radii = species_radii(particles, warnings)) {
    std::vector<float> radius(particles.size());
    std::transform(particles.species.begin(), particles.species.end(), radius.begin(),
                   [&](std::uint16_t s) { return (*radii)[s]; });
    return {std::move(radius), "covalent radii (Cordero et al. 2008)"};
  }
  const double distance = mean_neighbor_distance(particles);
  if (distance > 0) {
    return {{static_cast<float>(distance / 2)}, "half the mean distance of nearest neighbours"};
  }
  return {{1.0F}, "1, since no two particles lie apart"};
}

std::string default_radii_source(const ParticleSet& particles) {
  if (particles.radii_from_neighbors) return from_neighbors;
  Warnings warnings;  // that radii are guessed is no trouble here
  return default_radii(particles, warnings).source;
}

}  // namespace motes
