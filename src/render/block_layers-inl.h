// The layers of surfaces that are in the way of a block's rays. Included once per instruction set.
#if defined(MOTES_RENDER_BLOCK_LAYERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_RENDER_BLOCK_LAYERS_INL_H_
#undef MOTES_RENDER_BLOCK_LAYERS_INL_H_
#else
#define MOTES_RENDER_BLOCK_LAYERS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "render/render_tile.h"
#include "samples/lanes-inl.h"
#include "samples/layers.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Sets `out` to the layers of the rays of a block, `width` pixels wide with its top left pixel at
/// (px, py), and ends rays at layers that let nothing through. False if nothing cuts the rays'
/// steps: no layers, and no clip planes.
inline bool take_layers(const FrameContext& context, const TileLayers& layers, const Tile& tile,
                        int px, int py, int width, BlockLayers& out, RayState& rays) {
  const int columns = std::min(width, tile.x + tile.width - px);
  const int rows = std::min(num_lanes / width, tile.y + tile.height - py);
  const auto of = [&](int column, int row) {
    return layers.of(px - tile.x + column, py - tile.y + row);
  };
  std::size_t most = 0;
  if (context.layers) {
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column)
        most = std::max(most, of(column, row).size());
    }
  }
  out.clear(static_cast<int>(most));
  if (most == 0) return !context.clip_planes.empty();
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int lane = row * width + column;
      out.set(lane, of(column, row), context.view.planes);
      const float end = out.end_of(lane);
      if (end >= rays.last[lane]) continue;
      rays.last[lane] = end;
      rays.leaves[lane] = 1;  // the layer ends it
    }
  }
  const LaneTag d;
  const Lanes last = hn::Load(d, rays.last);
  const auto any = hn::Le(hn::Load(d, rays.first), last);
  const Lanes of_any = hn::IfThenElse(any, last, hn::Set(d, -1.0f));
  rays.end = static_cast<SampleIndex>(hn::GetLane(hn::MaxOfLanes(d, of_any)));
  // No samples are left where the layer is before the first.
  hn::Store(of_any, d, rays.last);
  hn::Store(hn::IfThenElseZero(any, hn::Load(d, rays.first)), d, rays.first);
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
