// The values that a field takes along rays of a view: what transfer functions are fitted to.
#pragma once

#include <cstddef>
#include <vector>

namespace motes {

/// Values at even distances along a coarse grid of rays through the picture, front to back; rays
/// that miss the volume are left out.
struct ViewProfile {
  std::size_t samples_per_ray = 0;
  std::vector<float> values;          ///< [ray][sample], field's unit
  std::vector<double> sample_length;  ///< file's length that a sample stands for; one a ray

  std::size_t num_rays() const { return sample_length.size(); }
};

}  // namespace motes
