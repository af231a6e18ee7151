// Which particles a part of the scene takes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "particles/particle_set.h"

namespace motes {

/// Which particles are taken; all that is given must hold.
struct Selection {
  std::vector<std::string> species;
  std::optional<std::pair<std::uint64_t, std::uint64_t>> index;  ///< first and last, both included
  std::string expression;  ///< over properties: "z > 3 && species == 'Si'"
  bool operator==(const Selection&) const = default;
};

/// What `select` takes of `particles`: indices, increasing. Throws Error for unknown species,
/// properties or a bad expression, naming what there is.
std::vector<std::uint32_t> select_particles(const ParticleSet& particles, const Selection& select);

/// The property of that name. Throws Error for an unknown one, naming the nearest or what there is:
/// the properties and `others`, names that would do in its place.
const Property& property_named(const ParticleSet& particles, const std::string& name,
                               const std::vector<std::string>& others = {});

}  // namespace motes
