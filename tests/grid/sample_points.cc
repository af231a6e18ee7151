#include "grid/sample_points.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grid/sample_points.cc"
#include <hwy/foreach_target.h>
// Included again for each instruction set.
#include <hwy/highway.h>

#include "grid/sample_grid-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Lanes from an array, from `at` on; beyond its end they are 0.
Lanes load_lanes(const std::vector<float>& values, std::size_t at) {
  alignas(64) float lanes[num_lanes] = {};
  for (std::size_t l = 0; l < num_lanes && at + l < values.size(); ++l) lanes[l] = values[at + l];
  return hn::Load(LaneTag(), lanes);
}

void store_lanes(Lanes v, std::size_t at, std::vector<float>& values) {
  alignas(64) float lanes[num_lanes];
  hn::Store(v, LaneTag(), lanes);
  for (std::size_t l = 0; l < num_lanes && at + l < values.size(); ++l) values[at + l] = lanes[l];
}

template <bool kCubic, bool kGradient>
void sample_all(const GridView& grid, PointSamples& p) {
  const LaneTag d;
  for (std::size_t at = 0; at < p.x.size(); at += num_lanes) {
    const GridPoints points{load_lanes(p.x, at), load_lanes(p.y, at), load_lanes(p.z, at)};
    const GridSamples samples = sample_grid<kCubic, kGradient>(d, grid, points);
    store_lanes(samples.value, at, p.value);
    store_lanes(samples.dx, at, p.dx);
    store_lanes(samples.dy, at, p.dy);
    store_lanes(samples.dz, at, p.dz);
    const unsigned inside = mask_bits(d, in_hull(d, grid, points));
    for (std::size_t l = 0; l < num_lanes && at + l < p.x.size(); ++l) {
      p.inside[at + l] = (inside >> l & 1) != 0;
    }
  }
}

void sample_points(const GridView& grid, bool gradients, PointSamples& p) {
  if (grid.cubic) {
    gradients ? sample_all<true, true>(grid, p) : sample_all<true, false>(grid, p);
  } else {
    gradients ? sample_all<false, true>(grid, p) : sample_all<false, false>(grid, p);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace motes {

HWY_EXPORT(sample_points);

void sample_points(const GridView& grid, bool gradients, PointSamples& p) {
  for (auto* out : {&p.value, &p.dx, &p.dy, &p.dz}) out->assign(p.x.size(), -1.0F);
  p.inside.assign(p.x.size(), false);
  HWY_DYNAMIC_DISPATCH(sample_points)(grid, gradients, p);
}

}  // namespace motes
#endif
