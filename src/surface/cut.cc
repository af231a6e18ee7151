#include "surface/cut.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace motes {
namespace {

bool is_kept(const Vector3d& center, std::span<const ClipPlane> planes) {
  return std::none_of(planes.begin(), planes.end(), [&](const ClipPlane& plane) {
    return dot(plane.normal, center) > plane.distance;
  });
}

/// The sticks of particles that still have `kept`.
Sticks sticks_of(const Surface& surface, const UninitializedVector<std::uint8_t>& kept) {
  const Sticks& all = surface.sticks;
  Sticks left;
  if (all.begin.empty()) return left;
  left.begin.resize(all.begin.size());
  left.begin[0] = 0;
  for (std::size_t p = 0; p + 1 < all.begin.size(); ++p) {
    const bool stays = p < kept.size() && kept[p] != 0;
    left.begin[p + 1] = left.begin[p] + (stays ? all.begin[p + 1] - all.begin[p] : 0);
  }
  const bool one_radius = all.radius.size() == 1;
  left.resize(left.begin.back());
  left.radius.assign(all.radius.size(), one_radius ? all.radius[0] : 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, kept.size(), 1 << 14), [&](const auto& r) {
    for (std::size_t p = r.begin(); p != r.end(); ++p) {
      std::size_t from = all.begin[p];
      for (std::size_t to = left.begin[p]; to < left.begin[p + 1]; ++to, ++from) {
        left.x[to] = all.x[from];
        left.y[to] = all.y[from];
        left.z[to] = all.z[from];
        left.owner[to] = all.owner[from];
        if (!one_radius) left.radius[to] = all.radius[from];
      }
    }
  });
  return left;
}

}  // namespace

Surface cut(const Surface& surface, std::span<const ClipPlane> planes) {
  const KernelSet& kernels = *surface.kernels;
  UninitializedVector<std::uint8_t> kept(kernels.size());
  Surface left;
  left.kernels = surface.kernels;
  left.radius.allocate(kernels.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, kept.size(), 1 << 14), [&](const auto& r) {
    for (std::size_t p = r.begin(); p != r.end(); ++p) {
      kept[p] = is_kept({kernels.x[p], kernels.y[p], kernels.z[p]}, planes) ? 1 : 0;
      left.radius.at(p) = kept[p] != 0 ? surface.radius[p] : 0;
    }
  });
  left.sticks = sticks_of(surface, kept);
  fit_reach(left);
  return left;
}

}  // namespace motes
