// What puts surfaces in the way of rays.
#pragma once

#include <functional>

#include "samples/layers.h"

namespace motes {

/// Pixels x to x + width - 1, y to y + height - 1.
struct Tile {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Sets the layers of a tile's pixels. Called by many threads at once.
using LayerSource = std::function<void(const Tile&, TileLayers&)>;

}  // namespace motes
