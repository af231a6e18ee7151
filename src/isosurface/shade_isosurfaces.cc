#include "isosurface/shade_isosurfaces.h"

#include "surface/phong.h"

namespace motes {
namespace {

/// Unit vector along ray i of the grid.
Vector3d direction_of(const SurfaceView& view, const RayGrid& grid, std::uint32_t i) {
  if (view.orthographic) return view.axes.forward;
  const auto width = static_cast<std::uint32_t>(grid.width);
  const double u = grid.u + (grid.column + static_cast<int>(i % width)) * grid.du;
  const double v = grid.v + (grid.row + static_cast<int>(i / width)) * grid.dv;
  return unit(view.axes.forward + u * view.axes.x + v * view.axes.y);
}

}  // namespace

void shade_isosurfaces(const ShadedIsosurfaces& isosurfaces, const Tile& tile,
                       std::vector<IsosurfaceHit>& out) {
  const RayGrid grid = rays_of(isosurfaces.plane, tile, 0);
  trace_isosurfaces(isosurfaces.frame, grid, out);
  for (IsosurfaceHit& hit : out) {
    hit.color = phong(isosurfaces.shading.lighting, hit.color, Vector3d(hit.normal),
                      -direction_of(isosurfaces.frame.view, grid, hit.ray), {});
  }
}

}  // namespace motes
