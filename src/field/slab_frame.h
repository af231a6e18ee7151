// A part of a slab as a small local coordinate system, set up in double precision, and the frusta
// of rays in it.
//
// Distances of samples to particles must be exact to about 1e-6 of a radius, yet eye and particle
// may be thousands of radii away from each other. So all arithmetic in float is relative to a
// reference point in the middle of the rays' part of the slab; what is far away is subtracted in
// double, once.
#pragma once

#include "samples/samples.h"
#include "scene/camera.h"

namespace motes {

/// The camera in internal lengths, relative to the origin of the kernels' positions.
struct View {
  CameraAxes axes;
  Point3d eye;  ///< internal, relative to KernelSet::origin
  SamplePlanes planes;
};

/// Bounds of a coordinate over some rays.
struct Range {
  double low = 0, high = 0;
  double middle() const { return 0.5 * (low + high); }
};

/// Bounds of rays, in camera axes: origins and directions as in RayPacket.
struct RayBounds {
  Range origin_x, origin_y, direction_x, direction_y;
};

RayBounds bounds_of(const RayPacket& packet);

/// Planes of one frame: few enough that all of them lie near its reference point.
inline constexpr int max_frame_planes = 32;

/// Coordinates in camera axes relative to a reference point.
struct SlabFrame {
  double reference_x = 0, reference_y = 0, reference_depth = 0;  ///< camera axes, eye at 0
  Point3d reference;                                             ///< world axes, internal
  float reference_high[3], reference_low[3];  ///< reference = high + low to 2^-48
  float axes[3][3];                           ///< rows X, Y, F: world to camera axes
  float slack = 0;  ///< bound of the rounding of world coordinates near the reference
  float step = 0, first_depth = 0;  ///< depth of the slab's plane 0, relative to the reference
  int count = 0;                    ///< planes
};

/// The frame whose reference is in the middle of the rays' part of the slab.
SlabFrame make_slab_frame(const RayBounds& rays, const Slab& slab, const View& view);

/// A plane of a frustum, normal outwards, |normal| = 1. A point lies outside by
/// normal . (p - reference) - offset, where positive.
struct FrustumPlane {
  float x, y, z;  ///< normal in camera axes
  float offset;
  float world[3];      ///< normal in world axes
  float world_offset;  ///< offset for points that are not relative to the reference
};

/// What some rays cover of a slab.
struct Frustum {
  /// Sides -x, +x, -y, +y, then near and far plane.
  FrustumPlane planes[6];
  /// Sines and cosines of the angles between the rays and the view direction.
  float max_sine = 0, max_cosine = 1;
  /// 1 / (1 + |cosine|) of the most oblique pair of sides that meet in an edge.
  float corner_factor = 1;
};

/// The part of the frame's slab that `rays` cover.
Frustum make_frustum(const RayBounds& rays, const SlabFrame& frame, const View& view);

/// A packet's rays in a frame of their own.
struct PacketFrame {
  SlabFrame slab;
  Frustum frustum;
  /// A lane's sample at depth dz relative to the reference: (offset_x + dz direction_x, ..., dz).
  alignas(64) float offset_x[max_lanes], offset_y[max_lanes];
  alignas(64) float direction_x[max_lanes], direction_y[max_lanes];
  alignas(64) float inverse_length_sq[max_lanes];  ///< 1 / |D|^2
  int lanes = 0;
};

PacketFrame make_packet_frame(const RayPacket& packet, const Slab& slab, const View& view);

}  // namespace motes
