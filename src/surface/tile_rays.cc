#include "surface/tile_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace motes {
namespace {

/// Where rays of the tile are, lane by lane.
void set_lanes(TileRays& rays, const double (&middle)[2]) {
  float steepest[2] = {0, 0};
  for (int b = 0; b < TileRays::blocks_per_side; ++b) {
    for (int l = 0; l < TileRays::lanes; ++l) {
      const auto set = [&](int axis, int i, float& offset, float& slope) {
        const double place = rays.first_place[axis] + i * rays.place_step[axis];
        offset = static_cast<float>(place - middle[axis]);
        slope = rays.orthographic ? 0 : static_cast<float>(place);
        steepest[axis] = std::max(steepest[axis], std::abs(slope));
      };
      set(0, b * TileRays::block + l % TileRays::block, rays.offset_x[b][l], rays.slope_x[b][l]);
      set(1, b * TileRays::block + l / TileRays::block, rays.offset_y[b][l], rays.slope_y[b][l]);
    }
  }
  for (int i = 0; i < TileRays::num_blocks; ++i) {
    for (int l = 0; l < TileRays::lanes; ++l) {
      const float x = rays.slope_x[i % TileRays::blocks_per_side][l];
      const float y = rays.slope_y[i / TileRays::blocks_per_side][l];
      rays.inverse_square[i][l] = 1 / (x * x + y * y + 1);
    }
  }
  for (int axis = 0; axis < 2; ++axis) {
    rays.max_stretch[axis] = std::hypot(1.0f, steepest[axis]) * 1.000001f;
  }
}

}  // namespace

TileRays make_tile_rays(const SurfaceView& view, const RayGrid& grid, int column, int row,
                        double depth) {
  TileRays rays;
  rays.begin[0] = std::max(grid.column - column, 0);
  rays.begin[1] = std::max(grid.row - row, 0);
  rays.end[0] = std::min(grid.column + grid.width - column, TileRays::side);
  rays.end[1] = std::min(grid.row + grid.height - row, TileRays::side);
  rays.orthographic = view.orthographic;
  rays.forward = view.axes.forward;
  rays.eye = view.eye;
  rays.depth = depth;
  rays.near = static_cast<float>(-depth);

  const Vector3d view_axes[2] = {view.axes.x, view.axes.y};
  const double first[2] = {grid.u + column * grid.du, grid.v + row * grid.dv};
  const double steps[2] = {grid.du, grid.dv};
  double middle[2];
  Point3d reference = rays.eye + depth * rays.forward;
  for (int i = 0; i < 2; ++i) {
    const double sign = steps[i] < 0 ? -1 : 1;
    rays.axes[i] = sign * view_axes[i];
    rays.first_place[i] = sign * first[i];
    rays.place_step[i] = sign * steps[i];
    middle[i] = rays.first_place[i] + static_cast<double>(TileRays::middle) * rays.place_step[i];
    rays.middle_place[i] = view.orthographic ? middle[i] : 0;
    const double slope = view.orthographic ? 0 : middle[i];
    rays.sheared[i] = rays.axes[i] - slope * rays.forward;
    rays.middle_slope[i] = static_cast<float>(slope);
    rays.step[i] = static_cast<float>(rays.place_step[i]);
    rays.rays_per_place[i] = static_cast<float>(1 / rays.place_step[i]);
    reference = reference + (view.orthographic ? 1 : depth) * middle[i] * rays.axes[i];
  }

  const Vector3d axes[3] = {rays.sheared[0], rays.sheared[1], rays.forward};
  double farthest = 0, longest = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rays.rows[i][j] = static_cast<float>(axes[i][j]);
    rays.reference[i] = static_cast<float>(reference[i]);
    rays.stretch[i] = static_cast<float>(length(axes[i]));
    farthest = std::max(farthest, std::abs(reference[i]));
    longest = std::max(longest, length(axes[i]));
  }
  // Coordinates are near 1; each is rounded a few times on its way, to 6e-8.
  rays.slack = static_cast<float>(2e-6 * (2 + farthest) * longest);
  set_lanes(rays, middle);
  return rays;
}

double first_depth(const Surface& surface, const SurfaceView& view) {
  const Bvh& bvh = surface.kernels->bvh;
  if (bvh.nodes.empty()) return 0;
  const Bounds3f centers = bounds_of(bvh);
  const float* reach = surface.reach.of(0);
  const double farthest = *std::max_element(reach, reach + Bvh::width);
  double nearest = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const Point3d p{(corner & 1 ? centers.max : centers.min).x,
                    (corner & 2 ? centers.max : centers.min).y,
                    (corner & 4 ? centers.max : centers.min).z};
    nearest = std::min(nearest, dot(p - view.eye, view.axes.forward));
  }
  return std::max(nearest - farthest, 0.0);
}

}  // namespace motes
