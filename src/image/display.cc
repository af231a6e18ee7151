#include "image/display.h"

#include <cmath>
#include <cstddef>

namespace motes {

namespace {

std::uint8_t encode_channel(float linear) {
  if (!(linear > 0)) return 0;  // NaN too
  if (linear >= 1) return 255;
  return static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(linear)));
}

}  // namespace

DisplayImage to_display(const Framebuffer& framebuffer, double termination_opacity,
                        const Color& background) {
  DisplayImage image{framebuffer.width, framebuffer.height, {}};
  image.rgb.reserve(3 * framebuffer.num_pixels());
  const float back[3] = {background.r, background.g, background.b};
  const auto stopped_above = static_cast<float>(termination_opacity);
  for (std::size_t i = 0; i < framebuffer.rgba.size(); i += 4) {
    const float* pixel = &framebuffer.rgba[i];
    const float alpha = pixel[3];
    const bool stopped = alpha > stopped_above;
    const float scale = stopped ? 1 / alpha : 1;
    const float transparency = stopped ? 0 : 1 - alpha;
    for (int c = 0; c < 3; ++c) {
      image.rgb.push_back(encode_channel(scale * pixel[c] + transparency * back[c]));
    }
  }
  return image;
}

}  // namespace motes
