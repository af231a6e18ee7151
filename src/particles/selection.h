// Selecting particles by an expression over their properties: "z > 3 && species == 'Si'".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "particles/particle_set.h"

namespace motes {

/// Throws Error if `expression` is not well formed, naming the column and what was expected. Names
/// of properties are not looked at, nor whether they hold texts: that needs the particles.
void check_expression(std::string_view expression);

/// The same, and throws Error for names that the particles do not have.
void check_expression(std::string_view expression, const ParticleSet& particles);

/// The texts in quotes that a well-formed `expression` compares with, in their order.
std::vector<std::string> texts_of(std::string_view expression);

/// The particles for which `expression` holds, as increasing indices. The language is described in
/// docs/scene.md, "Expressions". Throws Error as check_expression() does, and for names that the
/// particles do not have, naming the nearest that they have.
std::vector<std::uint32_t> select_where(const ParticleSet& particles, std::string_view expression);

}  // namespace motes
