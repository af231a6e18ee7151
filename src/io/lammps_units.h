// The unit of length in LAMMPS' systems of units.
#pragma once

#include <string>
#include <string_view>

namespace motes {

/// `units` as the command of that name takes it (docs.lammps.org/units.html): "real" -> "angstrom";
/// "unknown" for others.
inline std::string lammps_length_unit(std::string_view units) {
  if (units == "real" || units == "metal") return "angstrom";
  if (units == "lj") return "sigma";
  if (units == "si") return "m";
  if (units == "cgs") return "cm";
  if (units == "electron") return "bohr";
  if (units == "micro") return "micrometre";
  if (units == "nano") return "nm";
  return "unknown";
}

}  // namespace motes
