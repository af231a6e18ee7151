#include "render/balls_within.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace motes {
namespace {

/// The distance, in radii, up to which a kernel exceeds `ratio` of its peak; 0: nowhere.
double reach_of(const Kernel& kernel, double ratio) {
  if (ratio >= 1 || kernel.shape.type == KernelType::tabulated) return 0;
  if (kernel.shape.type == KernelType::gaussian) {
    return std::min(std::sqrt(-2 * std::log(ratio)), kernel.support());
  }
  double low = 0, high = kernel.support();
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    (evaluate(kernel, middle).value > ratio ? low : high) = middle;
  }
  return low;
}

/// The highest opaque level of each field, internal; infinity where there is none above 0.
std::vector<double> highest_levels(const KernelSet& kernels,
                                   const std::vector<ResolvedIsosurface>& isosurfaces) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  std::vector<double> levels(kernels.fields.size(), none);
  for (const ResolvedIsosurface& isosurface : isosurfaces) {
    const FieldKernels& field = kernels.fields[isosurface.field];
    if (isosurface.opacity < 1 || isosurface.value <= 0 || field.mixed_signs) continue;
    levels[isosurface.field] =
        std::max(levels[isosurface.field], isosurface.value * field.value_scale);
  }
  std::replace(levels.begin(), levels.end(), none, -none);
  return levels;
}

}  // namespace

std::optional<Surface> balls_within(const KernelSet& kernels,
                                    const std::vector<ResolvedIsosurface>& isosurfaces) {
  // An atom by itself touches its isosurface all around: none of that is to hide itself.
  constexpr double smaller = 0.97;
  const std::vector<double> levels = highest_levels(kernels, isosurfaces);
  Surface surface;
  surface.kernels = &kernels;
  surface.radius.allocate(kernels.size());
  std::atomic<bool> any = false;
  const tbb::blocked_range<std::size_t> all(0, kernels.size(), 4096);
  tbb::parallel_for(all, [&](const tbb::blocked_range<std::size_t>& range) {
    // Neighbours are often alike.
    std::size_t last_field = 0;
    double last_ratio = -1, last_reach = 0;
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const std::size_t f = kernels.field_of(i);
      surface.radius.at(i) = 0;
      if (f >= levels.size() || std::isinf(levels[f])) continue;
      const FieldKernels& field = kernels.fields[f];
      const double peak = field.peak_factor() * static_cast<double>(kernels.weight[i]);
      if (!(peak > 0)) continue;
      const double ratio = levels[f] / peak;
      if (f != last_field || ratio != last_ratio) {
        last_field = f;
        last_ratio = ratio;
        last_reach = reach_of(field.kernel, ratio);
      }
      surface.radius.at(i) =
          static_cast<float>(smaller * last_reach * static_cast<double>(kernels.radius[i]));
      if (last_reach > 0) any = true;
    }
  });
  if (!any) return std::nullopt;
  fit_reach(surface);
  return surface;
}

}  // namespace motes
