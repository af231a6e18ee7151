// How far two images are apart.
#pragma once

#include <cstddef>
#include <vector>

#include "image/display.h"
#include "image/framebuffer.h"

namespace motes {

struct ImageDifference {
  double max = 0;                ///< largest absolute difference of a linear channel
  double rms = 0;                ///< root of the mean square over all channels compared
  int worst_x = 0, worst_y = 0;  ///< pixel of `max`
  std::size_t compared = 0;      ///< pixels
};

/// Compares the four linear channels of `a` and `b`, of the same size, leaving out the pixels whose
/// flag in `skip` is not 0 (one flag a pixel, rows from the top; empty: all are compared).
/// A channel that is NaN in either image differs by infinity.
ImageDifference compare_images(const Framebuffer& a, const Framebuffer& b,
                               const std::vector<unsigned char>& skip = {});

/// Peak signal-to-noise ratio of `b` to `a`, of the same size, as they are shown: 20 log10(255 /
/// rms difference of the sRGB-encoded channels), decibels. Infinite where they are the same.
double peak_signal_to_noise(const DisplayImage& a, const DisplayImage& b);

}  // namespace motes
