// Names of length units, for the formats that give them as a number of centimetres.
#pragma once

#include <string>

namespace motes {

/// "kpc" for 3.0857e21, and so on; "1.5e13 cm" for lengths that have no name.
std::string length_unit_name(double centimetres);

}  // namespace motes
