// What a field asks of the particles that they do not have.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace motes {

struct FieldMistake {
  std::size_t field = 0;
  std::string key;      ///< of the field in a scene file, as "select.species"
  std::string message;  ///< "unknown species 'Sj'; did you mean 'Si'?"
};

/// The first name in `fields` (of species and properties, also in expressions) that `particles` do
/// not have.
std::optional<FieldMistake> find_mistake(const std::vector<Field>& fields,
                                         const ParticleSet& particles);

}  // namespace motes
