// The kernels that may reach some rays in a slab, found through the tree once for all of them.
// Included once per instruction set.
#if defined(MOTES_FIELD_GATHER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_GATHER_INL_H_
#undef MOTES_FIELD_GATHER_INL_H_
#else
#define MOTES_FIELD_GATHER_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/aligned.h"
#include "field/sampling-inl.h"
#include "samples/compress-inl.h"
#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Kernels of one shape that may reach some rays in a slab: placed in the slab's frame, in the
/// tree's order.
struct GatheredKernels {
  AlignedVector<float> x, y, z, radius, weight;
  AlignedVector<std::uint32_t> field;
  std::size_t size = 0;
  // What finish_kernels() adds.
  AlignedVector<float> support_sq;
  AlignedVector<float> minus_inverse_radius_sq;
  AlignedVector<float> peak;  ///< kappa * weight, of a normalised field over the kernel's integral
  AlignedVector<float> cut;   ///< a Gaussian is zero where its absolute value would be less

  // What find_thin_kernels() adds.
  AlignedVector<float> plane_support_sq, thin_support_sq;  ///< -1 for kernels of the other sort
  std::size_t num_thin = 0, num_others = 0;

  /// Makes room for `count` more and for what a vector writes beyond them.
  void reserve(std::size_t count) {
    if (size + count + max_lanes <= x.size()) return;
    const std::size_t room = 2 * (size + count + max_lanes);
    for (auto* array : {&x, &y, &z, &radius, &weight, &support_sq, &plane_support_sq,
                        &thin_support_sq, &minus_inverse_radius_sq, &peak, &cut}) {
      array->resize(room);
    }
    field.resize(room);
  }
};

/// Works out what the sweep needs of the kernels beside their places.
inline void finish_kernels(const SamplingConstants& constants, bool one_field,
                           GatheredKernels& out) {
  const LaneTag d;
  const hn::RebindToSigned<LaneTag> di;
  static_assert(sizeof(FieldConstants) == 4 * sizeof(float));
  for (std::size_t i = 0; i < out.size; i += hn::Lanes(d)) {
    const auto field = hn::BitCast(di, hn::Load(hn::RebindToUnsigned<LaneTag>(), &out.field[i]));
    const auto of_field = [&](const float& first_field) HWY_ATTR {
      if (one_field) return hn::Set(d, first_field);
      return hn::GatherIndex(d, &first_field, hn::ShiftLeft<2>(field));
    };
    const FieldConstants& first = constants.fields[0];
    const Lanes radius = hn::Load(d, &out.radius[i]);
    const Lanes support = hn::Mul(of_field(first.support_factor), radius);
    const Lanes peak = hn::Mul(of_field(first.peak_factor), hn::Load(d, &out.weight[i]));
    hn::Store(hn::Mul(support, support), d, &out.support_sq[i]);
    hn::Store(hn::Div(hn::Set(d, -1.0f), hn::Mul(radius, radius)), d,
              &out.minus_inverse_radius_sq[i]);
    hn::Store(peak, d, &out.peak[i]);
    hn::Store(hn::Mul(of_field(first.support_value), hn::Abs(peak)), d, &out.cut[i]);
  }
  // Fills the last vector with kernels that reach nothing.
  std::fill_n(out.support_sq.begin() + static_cast<std::ptrdiff_t>(out.size), max_lanes, -1.0f);
}

/// Finds the kernels of a group of fields that may reach `frustum`.
HWY_NOINLINE void gather_kernels(const KernelSet& kernels, const SamplingConstants& constants,
                                 std::uint32_t group, const SlabFrame& frame,
                                 const Frustum& frustum, GatheredKernels& out) {
  const LaneTag d;
  const hn::RebindToSigned<LaneTag> di;
  const hn::RebindToUnsigned<LaneTag> du;
  out.size = 0;
  const auto add_leaf = [&](std::size_t leaf) HWY_ATTR {
    out.reserve(Bvh::leaf_size);
    for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::Lanes(d)) {
      const std::size_t at = leaf * Bvh::leaf_size + i;
      const Centers<Lanes> centers = place_centers(d, kernels, at, frame);
      const Lanes radius = hn::Load(d, kernels.radius.from(at));
      const Lanes support = hn::Mul(radius, hn::Set(d, constants.max_support_factor));
      LaneMask reaches = may_reach(d, frame, frustum, centers, support);
      if (hn::AllFalse(d, reaches)) continue;
      auto field = hn::Zero(du);
      if (!kernels.field.empty()) {
        field =
            hn::PromoteTo(du, hn::LoadU(hn::Rebind<std::uint8_t, LaneTag>(), &kernels.field[at]));
      }
      if (HWY_UNLIKELY(constants.choose_group)) {
        const auto groups = hn::GatherIndex(du, constants.group, hn::BitCast(di, field));
        reaches = hn::And(reaches, hn::RebindMask(d, hn::Eq(groups, hn::Set(du, group))));
      }
      const Lanes weight = hn::Load(d, kernels.weight.from(at));
      const FrontLanes front(d, reaches);
      front.store(centers.x, out.x.data() + out.size);
      front.store(centers.y, out.y.data() + out.size);
      front.store(centers.z, out.z.data() + out.size);
      front.store(radius, out.radius.data() + out.size);
      front.store(weight, out.weight.data() + out.size);
      front.store(field, out.field.data() + out.size);
      out.size += front.count();
    }
  };
  // Leaves wait for some others while their positions are fetched: mostly from main memory, which
  // takes longer than all that is done with them.
  std::array<std::size_t, 32> waiting;
  std::size_t num_visited = 0;
  const auto visit = [&](std::size_t leaf) HWY_ATTR {
    for (const auto* array : {&kernels.x, &kernels.y, &kernels.z}) {
      hwy::Prefetch(array->data() + leaf * Bvh::leaf_size);
    }
    hwy::Prefetch(kernels.radius.from(leaf * Bvh::leaf_size));
    hwy::Prefetch(kernels.weight.from(leaf * Bvh::leaf_size));
    std::size_t& place = waiting[num_visited % waiting.size()];
    if (num_visited++ >= waiting.size()) add_leaf(place);
    place = leaf;
  };
  out.reserve(max_lanes);
  traverse(
      kernels.bvh,
      [&](const Bvh::Node& node) {
        return node_hits(node, frame, frustum, constants.max_support_factor);
      },
      visit);
  const std::size_t num_waiting = std::min(num_visited, waiting.size());
  for (std::size_t i = num_visited - num_waiting; i < num_visited; ++i) {
    add_leaf(waiting[i % waiting.size()]);
  }
  finish_kernels(constants, kernels.fields.size() == 1, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
