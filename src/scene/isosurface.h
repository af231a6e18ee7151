// Isosurfaces: what a scene draws of a field where that takes a value.
#pragma once

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "core/color.h"
#include "scene/geometry.h"

namespace motes {

/// The surface on which a field takes a value.
struct Isosurface {
  double value = 0;  ///< field's unit
  /// ColorBy: the mean of the particles' colours, weighted by their kernels' values at the surface;
  /// nullopt: what the transfer function has for the value, or else the display colour of the
  /// field's species.
  std::optional<std::variant<Color, ColorBy>> color;
  double opacity = 1;  ///< of one crossing, from whatever direction
  bool operator==(const Isosurface&) const = default;
};

/// An isosurface with nothing open.
struct ResolvedIsosurface {
  std::size_t field = 0;
  double value = 0;
  float opacity = 1;
  std::vector<Color> colors;  ///< linear; one, or one for each species of the particles
};

}  // namespace motes
