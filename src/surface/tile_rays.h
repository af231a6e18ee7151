// A tile of camera rays as a small local coordinate system, set up in double precision.
//
// Distances of rays to centres must be exact to about 1e-6 of a radius, yet eye and particle may be
// thousands of radii apart. So each centre is placed, in double, relative to the ray through the
// middle of the tile: across it by its offset at its own depth, along it by its depth. What is left
// for float is as small as the tile.
#pragma once

#include <cstddef>

#include "core/vec.h"
#include "surface/trace.h"

namespace motes {

/// 16 x 16 rays in blocks of 4 x 4, as many as the widest vector has lanes. Axes are the camera's,
/// turned so that columns go along +x and rows along +y; arrays of two hold what goes for x and y.
struct TileRays {
  static constexpr int side = 16, block = 4;
  static constexpr int blocks_per_side = side / block;
  static constexpr int num_blocks = blocks_per_side * blocks_per_side;
  static constexpr int lanes = block * block;
  static constexpr float middle = 0.5f * (side - 1);  ///< column and row of the middle ray

  int begin[2], end[2];  ///< columns and rows that there are
  bool has(int x, int y) const {
    return x >= begin[0] && x < end[0] && y >= begin[1] && y < end[1];
  }
  /// Where a lane of a block is in the tile.
  static constexpr int column(std::size_t b, std::size_t lane) {
    return static_cast<int>(b % blocks_per_side * block + lane % block);
  }
  static constexpr int row(std::size_t b, std::size_t lane) {
    return static_cast<int>(b / blocks_per_side * block + lane / block);
  }

  bool orthographic;
  Vector3d axes[2], forward;
  Point3d eye;
  /// u and v of the first column and row, and the steps to the next, > 0.
  double first_place[2], place_step[2];

  // A centre C lies across the middle ray by dot(sheared, C - eye) - middle_place, along it by
  // dot(forward, C - eye) - depth.
  Vector3d sheared[2];
  double middle_place[2];  ///< 0 unless orthographic
  double depth;            ///< where the geometry begins

  // For boxes: a point lies at rows . (point - reference).
  float rows[3][3];  ///< both sheared axes, and forward
  float reference[3];
  float stretch[3];         ///< lengths of the rows
  float slack;              ///< bound of the rounding of a box's place
  float near;               ///< depth of the eye's plane: no hit is nearer
  float rays_per_place[2];  ///< rays in a row or column for each unit of u or v

  // A ray passes across a centre at distance z from the eye's plane (orthographic: z = 1) by
  // z * offset less the centre's place, with that slope. A lane's column in the block is lane % 4,
  // its row lane / 4.
  alignas(64) float offset_x[blocks_per_side][lanes], offset_y[blocks_per_side][lanes];
  alignas(64) float slope_x[blocks_per_side][lanes], slope_y[blocks_per_side][lanes];
  alignas(64) float inverse_square[num_blocks][lanes];  ///< of the ray's direction
  float step[2], middle_slope[2];
  float max_stretch[2];  ///< rays that meet a ball pass its centre's depth within so many radii
};

/// The rays of `grid` from (column, row) on, which need not all be there; `depth`: where the
/// geometry begins along the view.
TileRays make_tile_rays(const SurfaceView& view, const RayGrid& grid, int column, int row,
                        double depth);

/// Depth at which what is drawn begins, at least 0.
double first_depth(const Surface& surface, const SurfaceView& view);

}  // namespace motes
