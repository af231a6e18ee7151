// Counts what transfer functions are fitted to.
#include "document/histogram.h"

#include <algorithm>
#include <cmath>

#include "render/view_profile.h"

namespace motes {
namespace {

/// The bin of a value between two ends, both of which belong to bins.
std::size_t bin_of(double value, double low, double high) {
  const double place = (value - low) / (high - low) * Histogram::num_bins;
  return std::min(static_cast<std::size_t>(std::max(place, 0.0)), Histogram::num_bins - 1);
}

Histogram count(const std::vector<float>& values) {
  Histogram histogram;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    histogram.min = std::min<double>(histogram.min, value);
    histogram.max = std::max<double>(histogram.max, value);
    if (value > 0 && value < histogram.positive_min.value_or(INFINITY)) {
      histogram.positive_min = value;
    }
  }
  if (!(histogram.min < histogram.max)) return histogram;
  const double log_low = std::log10(histogram.positive_min.value_or(1));
  const double log_high = std::log10(std::max(histogram.max, 1e-300));
  for (const float value : values) {
    if (!std::isfinite(value) || value == 0) continue;
    ++histogram.counts[bin_of(value, histogram.min, histogram.max)];
    if (value > 0 && log_low < log_high) {
      ++histogram.log_counts[bin_of(std::log10(value), log_low, log_high)];
    }
  }
  return histogram;
}

}  // namespace

std::vector<Histogram> histograms(const Document& document, const Camera& camera, int width,
                                  int height) {
  const Renderer& renderer = document.renderer();
  std::vector<Histogram> out;
  if (document.gathered().sources.empty()) return out;
  for (const RayProfiles& profiles :
       sample_view(renderer.kernels(), camera, width, height, nullptr, renderer.grids())) {
    out.push_back(count(profiles.values));
  }
  return out;
}

}  // namespace motes
