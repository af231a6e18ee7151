// Times of frames that were rendered to measure them.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace motes {

/// Of at least one value; the mean of the middle two where their number is even.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

/// Of at least one value, the least that so large a part of them does not exceed. `part` in (0, 1].
inline double percentile(std::vector<double> values, double part) {
  const double rank = std::ceil(part * static_cast<double>(values.size()));
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace motes
