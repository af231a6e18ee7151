#include "image/display.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

namespace motes {

namespace {

std::uint8_t round_channel(float linear) {
  return static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(linear)));
}

/// round_channel() without its power, of which a picture would take millions: what floats of the
/// same exponent and first bits of the mantissa come to differs by one at most.
class ChannelTable {
 public:
  ChannelTable() {
    for (std::uint32_t bin = 0; bin < num_bins; ++bin) {
      least_[bin] = round_channel(std::bit_cast<float>((first_bin + bin) << dropped_bits));
    }
    // Floats above 0 are ordered as their bits are.
    std::uint32_t low = 0, high = std::bit_cast<std::uint32_t>(1.0F);
    for (std::size_t value = 1; value < 256; ++value) {
      for (std::uint32_t end = high; low + 1 < end;) {
        const std::uint32_t middle = low + (end - low) / 2;
        (round_channel(std::bit_cast<float>(middle)) < value ? low : end) = middle;
      }
      first_[value] = std::bit_cast<float>(low + 1);
    }
  }

  /// `linear` in (0, 1).
  std::uint8_t operator()(float linear) const {
    const std::uint32_t bin = std::bit_cast<std::uint32_t>(linear) >> dropped_bits;
    if (bin < first_bin) return 0;
    const std::uint8_t value = least_[bin - first_bin];
    return value < 255 && linear >= first_[value + 1U] ? value + 1 : value;
  }

 private:
  static constexpr int dropped_bits = 23 - 7;
  /// At 2^-13, which still rounds to 0.
  static constexpr std::uint32_t first_bin = std::bit_cast<std::uint32_t>(0x1p-13F) >> dropped_bits;
  static constexpr std::uint32_t num_bins =
      (std::bit_cast<std::uint32_t>(1.0F) >> dropped_bits) - first_bin;

  std::array<std::uint8_t, num_bins> least_{};  ///< of a bin's floats
  std::array<float, 256> first_{};              ///< the first float that comes to a value
};

std::uint8_t encode_channel(float linear) {
  static const ChannelTable table;
  if (!(linear > 0)) return 0;  // NaN too
  if (linear >= 1) return 255;
  return table(linear);
}

}  // namespace

DisplayImage to_display(const Framebuffer& framebuffer, double termination_opacity,
                        const Color& background) {
  DisplayImage image{framebuffer.width, framebuffer.height, {}};
  image.rgb.resize(3 * framebuffer.num_pixels());
  const float back[3] = {background.r, background.g, background.b};
  const auto stopped_above = static_cast<float>(termination_opacity);
  std::uint8_t* out = image.rgb.data();
  for (std::size_t i = 0; i < framebuffer.rgba.size(); i += 4) {
    const float* pixel = &framebuffer.rgba[i];
    const float alpha = pixel[3];
    const bool stopped = alpha > stopped_above;
    const float scale = stopped ? 1 / alpha : 1;
    const float transparency = stopped ? 0 : 1 - alpha;
    for (int c = 0; c < 3; ++c) {
      *out++ = encode_channel(scale * pixel[c] + transparency * back[c]);
    }
  }
  return image;
}

}  // namespace motes
