// Where the samples of an area of pixels lie in a slab.
#pragma once

#include "field/slab_frame.h"

namespace motes {

/// What grows evenly with depth, relative to a frame.
struct LinearInDepth {
  double at_zero = 0, per_depth = 0;
  double at(double z) const { return at_zero + z * per_depth; }
};

/// The area's columns of pixels, or its rows: the place of the first and the distance to the next,
/// which is negative for rows. `steepest`: the most that a ray of the image moves across them, per
/// depth.
struct PixelLines {
  LinearInDepth first, step;
  double steepest = 0;
};

struct AreaPixels {
  PixelLines columns, rows;
};

/// Those of an area bounded by `area`; `in_image` bounds those of its rays that are the image's.
AreaPixels place_pixels(const RayBounds& area, const RayBounds& in_image, const SlabFrame& frame);

/// The samples of an area on one plane, in the slab's frame: that of column i and row j lies at
/// (x + i dx, y + j dy, z).
struct AreaPlane {
  float x, dx, y, dy, z;
};

/// Plane `k` of the slab.
AreaPlane place_plane(const AreaPixels& pixels, const SlabFrame& frame, int k);

}  // namespace motes
