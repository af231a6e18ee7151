// A field that is a grid along the rays of a packet, and around a point. Beyond the hull, where
// there is no field, it goes on as it is on the face: so there is nothing to cross but the face
// itself. Included once per instruction set.
#if defined(MOTES_ISOSURFACE_GRID_ALONG_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_ISOSURFACE_GRID_ALONG_RAYS_INL_H_
#undef MOTES_ISOSURFACE_GRID_ALONG_RAYS_INL_H_
#else
#define MOTES_ISOSURFACE_GRID_ALONG_RAYS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "grid/sample_grid-inl.h"
#include "isosurface/isosurface.h"
#include "isosurface/kernels_along_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Rays in index coordinates, one a lane: start + t along, between t = near and far within the
/// hull. Rays that miss it have near > far.
struct IndexRays {
  alignas(64) float start[3][max_lanes], along[3][max_lanes], near[max_lanes], far[max_lanes];
  std::uint8_t near_axis[max_lanes], far_axis[max_lanes];  ///< of the faces there

  void set(std::size_t lane, const GridView& grid, const double (&from)[3],
           const double (&direction)[3]) {
    double first = -std::numeric_limits<float>::max(), last = -first;
    near_axis[lane] = far_axis[lane] = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      start[i][lane] = static_cast<float>(from[i]);
      along[i][lane] = static_cast<float>(direction[i]);
      // (a ray along a face: depths become huge, and 0 on the face itself)
      const double inverse = 1 / (direction[i] == 0 ? 1e-290 : direction[i]);
      const double a = -from[i] * inverse, b = (grid.num_cells[i] - from[i]) * inverse;
      const auto axis = static_cast<std::uint8_t>(i);
      if (std::min(a, b) > first) {
        first = std::min(a, b);
        near_axis[lane] = axis;
      }
      if (std::max(a, b) < last) {
        last = std::max(a, b);
        far_axis[lane] = axis;
      }
    }
    const bool any = first <= last;
    near[lane] = any ? static_cast<float>(first) : 1;
    far[lane] = any ? static_cast<float>(last) : 0;
  }
  LaneMask meet() const {
    const LaneTag d;
    return hn::Le(hn::Load(d, near), hn::Load(d, far));
  }
  /// Places at t, or where the rays enter or leave the hull.
  GridPoints at(Lanes t) const {
    const LaneTag d;
    const Lanes within = hn::Min(hn::Max(t, hn::Load(d, near)), hn::Load(d, far));
    const auto place = [&](int i) HWY_ATTR {
      return hn::MulAdd(within, hn::Load(d, along[i]), hn::Load(d, start[i]));
    };
    return {place(0), place(1), place(2)};
  }
};

template <bool kGradient>
HWY_INLINE GridSamples sample_any_grid(const GridView& grid, const GridPoints& points) {
  const LaneTag d;
  return grid.cubic ? sample_grid<true, kGradient>(d, grid, points)
                    : sample_grid<false, kGradient>(d, grid, points);
}

/// Whether the field may take a level's value in a box of index coordinates.
inline bool may_take_level(const IsosurfaceGrid& grid, const double (&low)[3],
                           const double (&high)[3]) {
  int first[3], last[3];
  std::size_t count = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double end = grid.view.num_cells[i], slack = 1e-5 * end + 1e-4;
    const auto block = [&](double x) {
      return static_cast<int>(std::clamp(x, 0.0, end - 1)) / MacroCells::size;
    };
    if (low[i] > end + slack || high[i] < -slack) return false;
    first[i] = block(low[i] - slack);
    last[i] = block(high[i] + slack);
    count *= static_cast<std::size_t>(last[i] - first[i] + 1);
  }
  // Seen from afar: looking would take longer than it saves.
  if (count > 64) return true;
  for (int k = first[2]; k <= last[2]; ++k) {
    for (int j = first[1]; j <= last[1]; ++j) {
      const auto row = static_cast<std::size_t>(k) * static_cast<std::size_t>(grid.dims[1]) +
                       static_cast<std::size_t>(j);
      const std::uint8_t* const crosses =
          grid.crosses.data() + row * static_cast<std::size_t>(grid.dims[0]);
      if (std::any_of(crosses + first[0], crosses + last[0] + 1, [](auto c) { return c != 0; })) {
        return true;
      }
    }
  }
  return false;
}

/// What KernelsAlongRays is for kernels.
class GridAlongRays {
 public:
  static constexpr bool zero_elsewhere = false, has_faces = true;

  GridAlongRays(const IsosurfaceFrame& frame, const SamplingConstants& /*constants*/,
                const FieldIsosurfaces& field)
      : grid_(*field.grid) {
    const CameraAxes& axes = frame.view.axes;
    const Vector3d rows[3] = {axes.x, axes.y, axes.forward};
    for (int i = 0; i < 3; ++i) {
      eye_[i] = grid_.index_of(i, frame.view.eye);
      for (int a = 0; a < 3; ++a) axes_[i][a] = dot(grid_.axes[i], rows[a]);
    }
  }

  bool enter(const RayBounds& rays, const Slab& slab, const View& view) {
    slab_ = make_slab_frame(rays, slab, view);
    double low[3], high[3];
    for (int i = 0; i < 3; ++i) {
      low[i] = std::numeric_limits<double>::max();
      high[i] = -low[i];
      for (unsigned corner = 0; corner < 8; ++corner) {
        const double z =
            view.planes.depth((corner & 4) != 0 ? slab.first + slab.count - 1 : slab.first);
        const auto side = [&](unsigned bit, const Range& r) {
          return (corner & bit) != 0 ? r.high : r.low;
        };
        const double x = side(1, rays.origin_x) + z * side(1, rays.direction_x);
        const double y = side(2, rays.origin_y) + z * side(2, rays.direction_y);
        const double index = eye_[i] + axes_[i][0] * x + axes_[i][1] * y + axes_[i][2] * z;
        low[i] = std::min(low[i], index);
        high[i] = std::max(high[i], index);
      }
    }
    return may_take_level(grid_, low, high);
  }
  const SlabFrame& slab() const { return slab_; }

  void place(const RayPacket& packet, const View& /*view*/) {
    const double depth = slab_.reference_depth;
    for (std::size_t l = 0; l < num_lanes; ++l) {
      double from[3], direction[3];
      for (std::size_t i = 0; i < 3; ++i) {
        direction[i] =
            axes_[i][0] * packet.direction_x[l] + axes_[i][1] * packet.direction_y[l] + axes_[i][2];
        from[i] = eye_[i] + axes_[i][0] * packet.origin_x[l] + axes_[i][1] * packet.origin_y[l] +
                  depth * direction[i];
      }
      rays_.set(l, grid_.view, from, direction);
    }
  }

  /// False if nothing is crossed between planes begin and end.
  bool may_cross(int begin, int end) const {
    const LaneTag d;
    // (before the hull and behind it there is nothing either)
    const Lanes first = hn::Set(d, plane_depth(slab_, begin)),
                last = hn::Set(d, plane_depth(slab_, end));
    const LaneMask meet = hn::And(rays_.meet(), hn::And(hn::Le(hn::Load(d, rays_.near), last),
                                                        hn::Ge(hn::Load(d, rays_.far), first)));
    if (hn::AllFalse(d, meet)) return false;
    const GridPoints a = rays_.at(first), b = rays_.at(last);
    const Lanes infinity = hn::Set(d, std::numeric_limits<float>::infinity());
    double low[3], high[3];
    const auto bound = [&](int i, Lanes p, Lanes q) HWY_ATTR {
      low[i] =
          double{hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(meet, hn::Min(p, q), infinity)))};
      high[i] = double{
          hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElse(meet, hn::Max(p, q), hn::Neg(infinity))))};
    };
    bound(0, a.x, b.x);
    bound(1, a.y, b.y);
    bound(2, a.z, b.z);
    return may_take_level(grid_, low, high);
  }

  void sample_planes(int begin, int end, float (*values)[max_lanes],
                     float (*slopes)[max_lanes]) const {
    const LaneTag d;
    for (int k = begin; k <= end; ++k) {
      const AlongRays at = evaluate(k, hn::Set(d, plane_depth(slab_, k)));
      hn::Store(at.value, d, values[k]);
      hn::Store(at.slope, d, slopes[k]);
    }
  }

  HWY_NOINLINE AlongRays evaluate(int /*k*/, Lanes z) const {
    const LaneTag d;
    const GridSamples s = sample_any_grid<true>(grid_.view, rays_.at(z));
    const Lanes scale = hn::Set(d, static_cast<float>(grid_.value_scale));
    const Lanes slope = hn::MulAdd(
        s.dx, hn::Load(d, rays_.along[0]),
        hn::MulAdd(s.dy, hn::Load(d, rays_.along[1]), hn::Mul(s.dz, hn::Load(d, rays_.along[2]))));
    const LaneMask meet = rays_.meet();
    return {hn::IfThenElseZero(meet, hn::Mul(s.value, scale)),
            hn::IfThenElseZero(meet, hn::Mul(slope, scale))};
  }

  HWY_NOINLINE GradientAndColor gradient_and_color(const IsosurfaceLevel& /*level*/, int /*k*/,
                                                   Lanes z) const {
    const LaneTag d;
    const GridSamples s = sample_any_grid<true>(grid_.view, rays_.at(z));
    const Lanes zero = hn::Zero(d);
    GradientAndColor sums{{zero, zero, zero}, {zero, zero, zero}, zero};
    for (int a = 0; a < 3; ++a) {
      const auto axis = [&](int i) { return hn::Set(d, static_cast<float>(axes_[i][a])); };
      sums.gradient[a] =
          hn::MulAdd(s.dx, axis(0), hn::MulAdd(s.dy, axis(1), hn::Mul(s.dz, axis(2))));
    }
    return sums;
  }

  /// Where the rays enter the hull or leave it.
  Lanes face_depths(bool entering) const {
    return hn::Load(LaneTag(), entering ? rays_.near : rays_.far);
  }
  /// Lanes that do so behind depth low, up to high.
  unsigned pass_face(bool entering, Lanes low, Lanes high) const {
    const LaneTag d;
    const Lanes z = face_depths(entering);
    return mask_bits(d, hn::And(rays_.meet(), hn::And(hn::Gt(z, low), hn::Le(z, high))));
  }
  /// At right angles to the face that a lane passes, to the side that its ray comes from; camera
  /// axes, of any length.
  Vector3d face_side(bool entering, std::size_t lane) const {
    const std::size_t i = (entering ? rays_.near_axis : rays_.far_axis)[lane];
    const Vector3d across{axes_[i][0], axes_[i][1], axes_[i][2]};
    return rays_.along[i][lane] > 0 ? -across : across;
  }

 private:
  const IsosurfaceGrid& grid_;
  double eye_[3], axes_[3][3];  ///< index coordinates; of their gradients, camera axes
  SlabFrame slab_;
  IndexRays rays_;
};

/// What Surroundings is for kernels.
class GridSurroundings {
 public:
  static constexpr bool has_faces = true;

  GridSurroundings(const IsosurfaceGrid& grid, const Point3d& p) : grid_(grid) {
    for (int i = 0; i < 3; ++i) start_[i] = grid.index_of(i, p);
  }

  void look_along(const float (&directions)[3][max_lanes], std::size_t /*count*/) {
    for (std::size_t l = 0; l < num_lanes; ++l) {
      const Vector3d world{directions[0][l], directions[1][l], directions[2][l]};
      double direction[3];
      for (int i = 0; i < 3; ++i) direction[i] = dot(grid_.axes[i], world);
      rays_.set(l, grid_.view, start_, direction);
    }
  }
  void enter(float /*near*/, float /*far*/) {}

  /// Lanes that enter the hull behind distance low, up to high; at which distances.
  unsigned pass_face(float low, float high) const {
    const LaneTag d;
    const Lanes t = face_distances();
    return mask_bits(
        d, hn::And(rays_.meet(), hn::And(hn::Gt(t, hn::Set(d, low)), hn::Le(t, hn::Set(d, high)))));
  }
  Lanes face_distances() const { return hn::Load(LaneTag(), rays_.near); }

  HWY_NOINLINE Lanes evaluate(float distance) const {
    const LaneTag d;
    const GridSamples s = sample_any_grid<false>(grid_.view, rays_.at(hn::Set(d, distance)));
    return hn::IfThenElseZero(rays_.meet(),
                              hn::Mul(s.value, hn::Set(d, static_cast<float>(grid_.value_scale))));
  }

 private:
  const IsosurfaceGrid& grid_;
  double start_[3];
  IndexRays rays_;
};

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
