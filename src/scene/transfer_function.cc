// The built-in colour maps.
#include "scene/transfer_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "core/error.h"

namespace motes {
namespace {

struct ColorMap {
  std::string_view name;
  std::array<std::uint32_t, 33> srgb;  // 0xrrggbb at equal distances from low to high
};

// viridis, magma, inferno and plasma are sampled from the tables of matplotlib 3 (Smith and van der
// Walt, CC0); 33 points interpolated in linear light stay within 3 of 255 levels of them. heat goes
// through the colours of a glowing body and grey from black to white, both with CIELAB lightness
// that rises linearly.
constexpr std::array<ColorMap, 6> color_maps{{
    {"viridis",
     {0x440154, 0x470d60, 0x48186a, 0x482374, 0x472d7b, 0x453681, 0x424086, 0x3f4989, 0x3b528b,
      0x375a8d, 0x33638d, 0x2f6a8e, 0x2c728e, 0x297a8e, 0x26818e, 0x23898e, 0x21908c, 0x1f988b,
      0x1f9f88, 0x21a685, 0x28ae80, 0x31b57b, 0x3ebc74, 0x4cc26c, 0x5dc963, 0x6ece58, 0x82d34c,
      0x96d83f, 0xabdc32, 0xc0df24, 0xd5e21a, 0xeae51a, 0xfde725}},
    {"magma",
     {0x000004, 0x030311, 0x0a0822, 0x130d33, 0x1d1146, 0x28115a, 0x36106a, 0x430f76, 0x50127c,
      0x5d177f, 0x691c81, 0x762181, 0x822681, 0x8f2a81, 0x9c2e7f, 0xa9327d, 0xb63779, 0xc33b75,
      0xcf4170, 0xdb486a, 0xe65163, 0xee5c5e, 0xf5695c, 0xf9785d, 0xfb8761, 0xfd9668, 0xfea571,
      0xfeb47b, 0xfec387, 0xfed194, 0xfde0a2, 0xfceeb0, 0xfcfdbf}},
    {"inferno",
     {0x000004, 0x040312, 0x0b0724, 0x150b37, 0x210c4a, 0x2e0a5a, 0x3c0965, 0x4a0c6b, 0x57106d,
      0x63146e, 0x70196e, 0x7d1e6d, 0x89226a, 0x962766, 0xa32b61, 0xaf315c, 0xbb3755, 0xc63e4d,
      0xd14644, 0xdb4f3b, 0xe35932, 0xeb6528, 0xf1711e, 0xf67f14, 0xf98d0a, 0xfb9c06, 0xfcab0f,
      0xfbba1f, 0xf9ca32, 0xf5d949, 0xf2e865, 0xf3f586, 0xfcffa4}},
    {"plasma",
     {0x0d0887, 0x220690, 0x310596, 0x3f049c, 0x4c02a1, 0x5901a5, 0x6600a7, 0x7201a8, 0x7e03a8,
      0x8909a6, 0x9511a2, 0x9f1a9c, 0xa92396, 0xb22c8e, 0xbb3587, 0xc33e80, 0xcb4778, 0xd25071,
      0xd9596a, 0xe06263, 0xe66c5c, 0xeb7555, 0xf07f4f, 0xf48a48, 0xf89441, 0xfb9f3a, 0xfdab33,
      0xfeb72d, 0xfdc328, 0xfcd025, 0xf9dd25, 0xf5eb27, 0xf0f921}},
    {"heat",
     {0x000000, 0x1b0507, 0x29090d, 0x370911, 0x460615, 0x540317, 0x62001a, 0x70001c, 0x7d001e,
      0x8a001f, 0x960720, 0xa21221, 0xad1c22, 0xb72722, 0xc03320, 0xc93e1b, 0xd04a15, 0xd8560d,
      0xde6106, 0xe56c05, 0xe97906, 0xea8707, 0xe89608, 0xe6a40b, 0xe2b210, 0xdfc016, 0xddcc1e,
      0xded827, 0xe3e231, 0xeceb46, 0xf6f27b, 0xfdf9bc, 0xffffff}},
    {"grey",
     {0x000000, 0x0b0b0b, 0x141414, 0x1a1a1a, 0x212121, 0x272727, 0x2e2e2e, 0x343434, 0x3b3b3b,
      0x424242, 0x4a4a4a, 0x515151, 0x585858, 0x606060, 0x676767, 0x6f6f6f, 0x777777, 0x7f7f7f,
      0x878787, 0x8f8f8f, 0x979797, 0x9f9f9f, 0xa8a8a8, 0xb0b0b0, 0xb9b9b9, 0xc1c1c1, 0xcacaca,
      0xd2d2d2, 0xdbdbdb, 0xe4e4e4, 0xededed, 0xf6f6f6, 0xffffff}},
}};

}  // namespace

const std::vector<std::string>& color_map_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    all.reserve(color_maps.size());
    for (const ColorMap& map : color_maps) all.emplace_back(map.name);
    return all;
  }();
  return names;
}

Color color_from_srgb(std::uint32_t rrggbb) {
  const auto channel = [rrggbb](int shift) {
    return static_cast<float>(srgb_to_linear(((rrggbb >> shift) & 0xff) / 255.0));
  };
  return {channel(16), channel(8), channel(0)};
}

std::uint32_t color_to_srgb(const Color& color) {
  const auto level = [](float channel) {
    return static_cast<std::uint32_t>(
        std::lround(255 * linear_to_srgb(std::clamp(static_cast<double>(channel), 0.0, 1.0))));
  };
  return level(color.r) << 16 | level(color.g) << 8 | level(color.b);
}

std::optional<Color> color_from_text(std::string_view text) {
  if (text == "black") return Color{0, 0, 0};
  if (text == "white") return Color{1, 1, 1};
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  std::uint32_t srgb = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, srgb, 16);
  if (error != std::errc{} || end != text.data() + 7) return std::nullopt;
  return color_from_srgb(srgb);
}

TransferFunction named_transfer_function(std::string_view name, double low, double high,
                                         double extinction, bool log_scale) {
  const auto map = std::find_if(color_maps.begin(), color_maps.end(),
                                [name](const ColorMap& m) { return m.name == name; });
  if (map == color_maps.end()) throw unknown_name("colour map", name, color_map_names());
  if (!std::isfinite(low) || !std::isfinite(high) || !(low < high)) {
    throw Error(fmt::format("transfer function {}: range is {} to {}; expected low < high", name,
                            low, high));
  }
  if (log_scale && !(low > 0)) {
    throw Error(
        fmt::format("transfer function {}: range starts at {}; expected more than 0 for a "
                    "logarithmic scale",
                    name, low));
  }

  TransferFunction function;
  function.log_scale = log_scale;
  const std::size_t last = map->srgb.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    const double s = static_cast<double>(k) / static_cast<double>(last);
    double value = log_scale ? low * std::pow(high / low, s) : low + s * (high - low);
    if (k == last) value = high;
    if (!function.points.empty() && !(value > function.points.back().value)) {
      throw Error(
          fmt::format("transfer function {}: range {} to {} is too narrow", name, low, high));
    }
    function.points.push_back({value, color_from_srgb(map->srgb[k]), s * extinction});
  }
  return function;
}

TransferFunction::Point point_at(const TransferFunction& function, double value) {
  const auto& points = function.points;
  const auto above = std::find_if(points.begin(), points.end(),
                                  [&](const auto& point) { return point.value > value; });
  if (!(value > points.front().value)) return points.front();
  if (above == points.end()) return points.back();
  const auto place = [&](double v) { return function.log_scale ? std::log10(v) : v; };
  const auto& below = *(above - 1);
  const double s = (place(value) - place(below.value)) / (place(above->value) - place(below.value));
  const auto t = static_cast<float>(s);
  return {value,
          {std::lerp(below.color.r, above->color.r, t), std::lerp(below.color.g, above->color.g, t),
           std::lerp(below.color.b, above->color.b, t)},
          std::lerp(below.extinction, above->extinction, s)};
}

Color color_at(const TransferFunction& function, double value) {
  return point_at(function, value).color;
}

}  // namespace motes
