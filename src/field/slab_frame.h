// A packet's part of a slab as a small local coordinate system, set up in double precision.
//
// Distances of samples to particles must be exact to about 1e-6 of a radius, yet eye and particle
// may be thousands of radii away from each other. So all arithmetic in float is relative to a
// reference point in the middle of the packet's part of the slab; what is far away is subtracted in
// double, once.
#pragma once

#include <cmath>

#include "samples/samples.h"
#include "scene/camera.h"

namespace motes {

/// The camera in internal lengths, relative to the origin of the kernels' positions.
struct View {
  CameraAxes axes;
  Point3d eye;      ///< internal, relative to KernelSet::origin
  double step = 0;  ///< between planes of samples, internal
};

/// A plane of the frustum of a packet in a slab, normal outwards, |normal| = 1. A point lies
/// outside by normal . (p - reference) - offset, where positive.
struct FrustumPlane {
  float x, y, z;  ///< normal in camera axes
  float offset;
  float world[3];      ///< normal in world axes
  float world_offset;  ///< offset for points that are not relative to the reference
};

struct SlabFrame {
  Point3d reference;                          ///< internal
  float reference_high[3], reference_low[3];  ///< reference = high + low to 2^-48
  float axes[3][3];                           ///< rows X, Y, F: world to camera axes
  float slack = 0;  ///< bound of the rounding of world coordinates near the reference
  float step = 0, first_depth = 0;  ///< depth of the slab's plane 0, relative to the reference
  int count = 0;                    ///< planes
  /// Sides -x, +x, -y, +y, then near and far plane.
  FrustumPlane planes[6];
  /// A lane's sample at depth dz relative to the reference: (offset_x + dz direction_x, ..., dz).
  alignas(64) float offset_x[max_lanes], offset_y[max_lanes];
  alignas(64) float direction_x[max_lanes], direction_y[max_lanes];
  alignas(64) float inverse_length_sq[max_lanes];  ///< 1 / |D|^2
  int lanes = 0;
  /// Sines and cosines of the angles between the packet's rays and the view direction.
  float max_sine = 0, max_cosine = 1;
  /// 1 / (1 + |cosine|) of the most oblique pair of sides that meet in an edge.
  float corner_factor = 1;
};

/// Spans the frame of `packet` in `slab`.
SlabFrame make_slab_frame(const RayPacket& packet, const Slab& slab, const View& view);

}  // namespace motes
