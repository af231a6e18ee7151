#include "surface/trace.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/trace.cc"
#include <hwy/foreach_target.h>
// Included again for each instruction set.
#include <hwy/highway.h>

#include "surface/finish-inl.h"
#include "surface/primary-inl.h"
#include "surface/single_ray-inl.h"
#include "surface/tile_rays.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

void trace_grid(const Surface& surface, const SurfaceView& view, const RayGrid& grid,
                SurfaceHits& hits) {
  // Tiles begin at multiples of their size, wherever the grid does.
  const auto tile_begin = [](int i) { return i & -TileRays::side; };
  const double depth = first_depth(surface, view);
  TileHits tile;
  for (int row = tile_begin(grid.row); row < grid.row + grid.height; row += TileRays::side) {
    for (int column = tile_begin(grid.column); column < grid.column + grid.width;
         column += TileRays::side) {
      const TileRays rays = make_tile_rays(view, grid, column, row, depth);
      TileTracer(surface, rays, tile).run();
      finish_tile(surface, rays, tile, column, row, grid, hits);
    }
  }
}

SurfaceHit trace_ray(const Surface& surface, const Point3d& origin, const Vector3d& direction) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Ray ray = make_ray({origin}, normalize(direction), infinity, 0);
  const NearestHit hit = RayTracer(surface).nearest(ray);
  if (hit.particle == no_particle) return {};
  return finish_hit(surface, origin, direction, hit.particle, hit.stick);
}

int count_unoccluded(const Surface& surface, const SurfacePoint& from,
                     std::span<const Vector3f> directions, double length) {
  constexpr float skip = 1e-3f;
  RayTracer tracer(surface);
  int count = 0;
  for (const Vector3f& direction : directions) {
    if (!tracer.occluded(make_ray(from, Vector3d(direction), length, skip))) ++count;
  }
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace motes {
namespace {

HWY_EXPORT(trace_grid);
HWY_EXPORT(trace_ray);
HWY_EXPORT(count_unoccluded);

}  // namespace

void SurfaceHits::resize(std::size_t n) {
  depth.resize(n);
  for (auto* array : {&particle, &stick}) array->resize(n);
  for (auto* array : {&normal_x, &normal_y, &normal_z}) array->resize(n);
}

void trace(const Surface& surface, const SurfaceView& view, const RayGrid& grid,
           SurfaceHits& hits) {
  hits.resize(grid.size());
  HWY_DYNAMIC_DISPATCH(trace_grid)(surface, view, grid, hits);
}

SurfaceHit trace(const Surface& surface, const Point3d& origin, const Vector3d& direction) {
  return HWY_DYNAMIC_DISPATCH(trace_ray)(surface, origin, direction);
}

int num_unoccluded(const Surface& surface, const SurfacePoint& from,
                   std::span<const Vector3f> directions, double length) {
  return HWY_DYNAMIC_DISPATCH(count_unoccluded)(surface, from, directions, length);
}

}  // namespace motes
#endif
