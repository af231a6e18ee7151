// The picture as it is rendered, before anything is done to show it.
#pragma once

#include <cstddef>
#include <vector>

namespace motes {

/// Linear, premultiplied RGBA, 32-bit float, [height][width][4], rows from the top.
struct Framebuffer {
  int width = 0, height = 0;
  std::vector<float> rgba;

  Framebuffer() = default;
  /// All pixels transparent black.
  Framebuffer(int width_, int height_)
      : width(width_),
        height(height_),
        rgba(std::size_t{4} * static_cast<std::size_t>(width_) *
             static_cast<std::size_t>(height_)) {}

  std::size_t num_pixels() const { return rgba.size() / 4; }
  /// First of the four channels of the pixel in column px from the left and row py from the top.
  float* pixel(int px, int py) { return rgba.data() + offset(px, py); }
  const float* pixel(int px, int py) const { return rgba.data() + offset(px, py); }

  bool operator==(const Framebuffer&) const = default;

 private:
  std::size_t offset(int px, int py) const {
    return 4 * (static_cast<std::size_t>(py) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(px));
  }
};

}  // namespace motes
