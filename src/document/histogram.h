// How often a field takes which values in a view.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "document/document.h"

namespace motes {

struct Histogram {
  static constexpr std::size_t num_bins = 128;
  using Counts = std::array<std::uint32_t, num_bins>;

  double min = 0, max = 0;  ///< of the values, 0 included
  Counts counts{};          ///< of even bins from min to max; values that are 0 are not counted
  /// The least positive value, and counts of even bins of the logarithm from there to max; nullopt
  /// where there is none.
  std::optional<double> positive_min;
  Counts log_counts{};
};

/// One a visible field, from rays through a picture of that size, evenly apart.
std::vector<Histogram> histograms(const Document& document, const Camera& camera, int width,
                                  int height);

}  // namespace motes
