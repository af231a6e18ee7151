// Times of frames that were rendered to measure them.
#pragma once

#include <algorithm>
#include <vector>

namespace motes {

/// Of at least one value; the mean of the middle two where their number is even.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

}  // namespace motes
