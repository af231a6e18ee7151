#include "image/compare.h"

#include <cassert>
#include <cmath>
#include <limits>

namespace motes {

ImageDifference compare_images(const Framebuffer& a, const Framebuffer& b,
                               const std::vector<unsigned char>& skip) {
  assert(a.width == b.width && a.height == b.height);
  assert(skip.empty() || skip.size() == a.num_pixels());
  ImageDifference result;
  double sum_of_squares = 0;
  std::size_t worst = 0;
  for (std::size_t pixel = 0; pixel < a.num_pixels(); ++pixel) {
    if (!skip.empty() && skip[pixel] != 0) continue;
    ++result.compared;
    for (std::size_t i = 4 * pixel; i < 4 * pixel + 4; ++i) {
      double difference = std::abs(double{a.rgba[i]} - double{b.rgba[i]});
      if (std::isnan(difference)) difference = std::numeric_limits<double>::infinity();
      sum_of_squares += difference * difference;
      if (difference > result.max) {
        result.max = difference;
        worst = pixel;
      }
    }
  }
  if (result.compared == 0) return result;
  const auto width = static_cast<std::size_t>(a.width);
  result.worst_x = static_cast<int>(worst % width);
  result.worst_y = static_cast<int>(worst / width);
  result.rms = std::sqrt(sum_of_squares / (4 * static_cast<double>(result.compared)));
  return result;
}

double peak_signal_to_noise(const DisplayImage& a, const DisplayImage& b) {
  assert(a.width == b.width && a.height == b.height && !a.rgb.empty());
  double sum_of_squares = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double difference = static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i]);
    sum_of_squares += difference * difference;
  }
  return 10 * std::log10(255. * 255. * static_cast<double>(a.rgb.size()) / sum_of_squares);
}

}  // namespace motes
