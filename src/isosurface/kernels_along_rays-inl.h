// A field of kernels along the rays of a packet, in a slab. Included once per instruction set.
#if defined(MOTES_ISOSURFACE_KERNELS_ALONG_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_ISOSURFACE_KERNELS_ALONG_RAYS_INL_H_
#undef MOTES_ISOSURFACE_KERNELS_ALONG_RAYS_INL_H_
#else
#define MOTES_ISOSURFACE_KERNELS_ALONG_RAYS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "isosurface/isosurface.h"
#include "isosurface/local_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// A field's gradient, camera axes, and its colour: the sum over kernels of |phi| times the
/// kernel's colour, and that of |phi|.
struct GradientAndColor {
  Lanes gradient[3], color[3], weight;
};

/// Depths of planes and of what is between them are relative to the slab's reference.
class KernelsAlongRays {
 public:
  /// The field is 0 where it cannot be crossed.
  static constexpr bool zero_elsewhere = true, has_faces = false;

  KernelsAlongRays(const IsosurfaceFrame& frame, const SamplingConstants& constants,
                   const FieldIsosurfaces& field)
      : frame_(frame), constants_(constants), field_(field.field) {}

  /// Finds the kernels that reach `rays` in `slab`; false if there are none.
  bool enter(const RayBounds& rays, const Slab& slab, const View& view) {
    slab_ = make_slab_frame(rays, slab, view);
    gather_field(*frame_.kernels, constants_, field_, slab_, make_frustum(rays, slab_, view),
                 kernels_);
    return kernels_.size != 0;
  }
  const SlabFrame& slab() const { return slab_; }

  /// Places the packet's rays in the slab's frame, and finds the kernels that reach them.
  void place(const RayPacket& packet, const View& view) {
    const double depth = slab_.reference_depth;
    for (int l = 0; l < num_lanes; ++l) {
      const double x = packet.direction_x[l], y = packet.direction_y[l];
      offset_x_[l] = static_cast<float>(packet.origin_x[l] + depth * x - slab_.reference_x);
      offset_y_[l] = static_cast<float>(packet.origin_y[l] + depth * y - slab_.reference_y);
      direction_x_[l] = static_cast<float>(x);
      direction_y_[l] = static_cast<float>(y);
    }
    const Frustum frustum = make_frustum(bounds_of(packet), slab_, view);
    const LaneTag d;
    reaching_.clear();
    for (std::size_t i = 0; i < kernels_.size; i += hn::Lanes(d)) {
      const Centers<Lanes> centers{hn::Load(d, &kernels_.x[i]), hn::Load(d, &kernels_.y[i]),
                                   hn::Load(d, &kernels_.z[i])};
      const Lanes support = hn::Load(d, &kernels_.support[i]);
      const auto planes = enclosing_planes(d, slab_, frustum, centers, support);
      unsigned bits = mask_bits(d, hn::And(planes.any, hn::Ge(support, hn::Zero(d))));
      alignas(64) float first[max_lanes], last[max_lanes];
      hn::Store(planes.first, d, first);
      hn::Store(planes.last, d, last);
      for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
        reaching_.push_back({static_cast<std::uint32_t>(i + lane), static_cast<int>(first[lane]),
                             static_cast<int>(last[lane])});
      }
    }
  }

  /// False if the field is 0 on planes begin to end and between them.
  bool may_cross(int begin, int end) const {
    return std::any_of(reaching_.begin(), reaching_.end(), [&](const Reaching& kernel) {
      return kernel.first < end && kernel.last > begin;
    });
  }

  /// The field on planes begin to end.
  void sample_planes(int begin, int end, float (*values)[max_lanes],
                     float (*slopes)[max_lanes]) const {
    const LaneTag d;
    for (int k = begin; k <= end; ++k) {
      hn::Store(hn::Zero(d), d, values[k]);
      hn::Store(hn::Zero(d), d, slopes[k]);
    }
    with_shape(constants_, field_, [&](const auto& shape) HWY_ATTR {
      for (const Reaching& kernel : reaching_) {
        const int last = std::min(kernel.last, end);
        for (int k = std::max(kernel.first, begin); k <= last; ++k) {
          const AlongRays sums = add_kernel(shape, kernels_, kernel.index,
                                            points_at(hn::Set(d, plane_depth(slab_, k))),
                                            {hn::Load(d, values[k]), hn::Load(d, slopes[k])});
          hn::Store(sums.value, d, values[k]);
          hn::Store(sums.slope, d, slopes[k]);
        }
      }
    });
  }

  /// The field at depths z between planes k - 1 and k.
  HWY_NOINLINE AlongRays evaluate(int k, Lanes z) const {
    const LaneTag d;
    AlongRays sums{hn::Zero(d), hn::Zero(d)};
    const PacketPoints points = points_at(z);
    with_shape(constants_, field_, [&](const auto& shape) HWY_ATTR {
      for (const Reaching& kernel : reaching_) {
        if (kernel.first >= k || kernel.last < k) continue;
        sums = add_kernel(shape, kernels_, kernel.index, points, sums);
      }
    });
    return sums;
  }

  /// The same of its gradient and colour.
  HWY_NOINLINE GradientAndColor gradient_and_color(const IsosurfaceLevel& level, int k,
                                                   Lanes z) const {
    const LaneTag d;
    const Lanes zero = hn::Zero(d);
    GradientAndColor sums{{zero, zero, zero}, {zero, zero, zero}, zero};
    const PacketPoints points = points_at(z);
    with_shape(constants_, field_, [&](const auto& shape) HWY_ATTR {
      for (const Reaching& kernel : reaching_) {
        if (kernel.first >= k || kernel.last < k) continue;
        const std::size_t i = kernel.index;
        const KernelAtPoints at = kernel_at(shape, kernels_, i, points);
        const Lanes steepness = hn::Mul(hn::Set(d, kernels_.steep[i]), at.phi.steepness);
        sums.gradient[0] = hn::NegMulAdd(steepness, at.x, sums.gradient[0]);
        sums.gradient[1] = hn::NegMulAdd(steepness, at.y, sums.gradient[1]);
        sums.gradient[2] = hn::NegMulAdd(steepness, at.z, sums.gradient[2]);
        const Color& c =
            level.colors[level.colors.size() == 1 ? 0 : frame_.species[kernels_.kernel[i]]];
        const Lanes weight = hn::Abs(hn::Mul(hn::Set(d, kernels_.peak[i]), at.phi.value));
        sums.color[0] = hn::MulAdd(weight, hn::Set(d, c.r), sums.color[0]);
        sums.color[1] = hn::MulAdd(weight, hn::Set(d, c.g), sums.color[1]);
        sums.color[2] = hn::MulAdd(weight, hn::Set(d, c.b), sums.color[2]);
        sums.weight = hn::Add(sums.weight, weight);
      }
    });
    return sums;
  }

 private:
  PacketPoints points_at(Lanes z) const {
    const LaneTag d;
    const Lanes x = hn::Load(d, direction_x_), y = hn::Load(d, direction_y_);
    return {hn::MulAdd(z, x, hn::Load(d, offset_x_)), hn::MulAdd(z, y, hn::Load(d, offset_y_)), z,
            x, y};
  }
  /// A kernel that reaches the packet between planes first and last.
  struct Reaching {
    std::uint32_t index;
    int first, last;
  };

  const IsosurfaceFrame& frame_;
  const SamplingConstants& constants_;
  std::size_t field_;
  SlabFrame slab_;
  LocalKernels kernels_;
  std::vector<Reaching> reaching_;
  alignas(64) float offset_x_[max_lanes], offset_y_[max_lanes];
  alignas(64) float direction_x_[max_lanes], direction_y_[max_lanes];
};

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
