// The chemical elements: what a species' name or mass says about its size and colour.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace motes {

struct Element {
  std::string_view symbol;
  int number;                         ///< atomic number
  double mass;                        ///< standard atomic weight, u
  float covalent_radius;              ///< angstrom
  std::array<std::uint8_t, 3> color;  ///< sRGB, the customary colour in molecular pictures
};

/// Angstrom: Mantina et al. (2009) and Bondi (1964), as gemmi gives them; of transition metals,
/// lanthanides and actinides, for which these have none or much smaller ones, Alvarez (2013).
float van_der_waals_radius(const Element& element);

/// gemmi's list, without germanium and antimony, whose bonds have directions.
bool is_metal(const Element& element);

/// The element that a species' name begins with, or null. Case does not matter. The symbol may be
/// followed by digits, charge signs and marks ("Si1", "O2-", "Fe3+", "H*") and by a suffix after an
/// underscore ("C_R"); any other letter makes it another word: "water" is not tungsten.
/// "D" and "T" are hydrogen.
const Element* find_element(std::string_view name);

/// Hydrogen is 1; null where there is no such element in the table (1 to 96).
const Element* element_by_number(int number);

/// The element whose atomic weight is nearest to `mass` (u) and not farther than 0.2 u, so that
/// rounded weights are found (28 is Si, 56 is Fe); null if there is none.
const Element* element_by_mass(double mass);

}  // namespace motes
