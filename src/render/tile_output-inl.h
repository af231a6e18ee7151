// What the engines share around their loops: the samples' layout, counts and pixels of a vector of
// rays. Included once per instruction set.
#if defined(MOTES_RENDER_TILE_OUTPUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_RENDER_TILE_OUTPUT_INL_H_
#undef MOTES_RENDER_TILE_OUTPUT_INL_H_
#else
#define MOTES_RENDER_TILE_OUTPUT_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>

#include "image/framebuffer.h"
#include "render/render_tile.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

inline SampleLayout make_layout(const FrameContext& context) {
  return {.num_fields = static_cast<int>(context.classifiers.size()),
          .gradients = context.gradients,
          .absolute = context.absolute,
          .lanes = num_lanes};
}

/// Samples of all rays, up to each ray's end.
inline std::uint64_t count_samples(const RayState& rays) {
  const LaneTag d;
  const hn::RebindToSigned<LaneTag> di;
  const Lanes count = hn::Sub(hn::Load(d, rays.last), hn::Load(d, rays.first));
  const auto counts = hn::Add(hn::ConvertTo(di, count), hn::Set(di, 1));
  return static_cast<std::uint64_t>(hn::GetLane(hn::SumOfLanes(di, counts)));
}

/// Writes the colours of the packet whose top left pixel is (px, py).
inline void store_pixels(const RayState& rays, int px, int py, int width, Framebuffer& image) {
  const LaneTag d;
  alignas(64) float rgba[4 * max_lanes];
  hn::StoreInterleaved4(hn::Load(d, rays.r), hn::Load(d, rays.g), hn::Load(d, rays.b),
                        hn::Load(d, rays.a), d, rgba);
  const int columns = std::min(width, image.width - px);
  const int rows = std::min(static_cast<int>(hn::Lanes(d)) / width, image.height - py);
  for (int row = 0; row < rows; ++row) {
    std::copy_n(rgba + 4 * width * row, 4 * std::max(columns, 0), image.pixel(px, py + row));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
