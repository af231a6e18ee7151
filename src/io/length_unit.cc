// The units in which codes of astrophysics measure lengths.
#include "io/length_unit.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace motes {

std::string length_unit_name(double centimetres) {
  struct Unit {
    std::string_view name;
    double centimetres;
  };
  // IAU 2012 (au), IAU 2015 (pc, nominal radii).
  constexpr Unit units[] = {{"cm", 1},
                            {"m", 100},
                            {"km", 1e5},
                            {"Earth radii", 6.3781e8},
                            {"solar radii", 6.957e10},
                            {"au", 1.495978707e13},
                            {"pc", 3.0856776e18},
                            {"kpc", 3.0856776e21},
                            {"Mpc", 3.0856776e24}};
  constexpr double tolerance = 2e-3;  // codes round their constants
  for (const Unit& unit : units) {
    if (std::abs(centimetres / unit.centimetres - 1) < tolerance) return std::string(unit.name);
  }
  return fmt::format("{:.5g} cm", centimetres);
}

}  // namespace motes
