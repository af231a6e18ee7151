// From a framebuffer to what a screen shows.
#pragma once

#include <cstdint>
#include <vector>

#include "core/color.h"
#include "image/framebuffer.h"

namespace motes {

/// sRGB-encoded RGB, 8 bits a channel, [height][width][3], rows from the top.
struct DisplayImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  bool operator==(const DisplayImage&) const = default;
};

/// `framebuffer` over `background`. A pixel whose opacity exceeds `termination_opacity` belongs to
/// a ray that stopped early: it is shown as opaque, scaled by 1/opacity. Clamped to [0, 1], NaN to
/// 0.
DisplayImage to_display(const Framebuffer& framebuffer, double termination_opacity,
                        const Color& background);

}  // namespace motes
