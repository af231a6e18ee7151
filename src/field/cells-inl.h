// Nanovol's way (Reda et al. 2013; Knoll et al. 2014, section 6.3): each ray walks through a
// uniform grid of cells, and the field at each of its samples is evaluated from the kernels of the
// cell that the sample lies in, a vector of them at a time. Included once per instruction set.
#if defined(MOTES_FIELD_CELLS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_CELLS_INL_H_
#undef MOTES_FIELD_CELLS_INL_H_
#else
#define MOTES_FIELD_CELLS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/aligned.h"
#include "field/cell_grid.h"
#include "field/sampling-inl.h"
#include "field/shapes-inl.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// A sample of a ray, in the frame's axes and relative to its reference.
struct SamplePlace {
  float x, y, z;
};

/// A field at a sample; as in the buffer.
struct SampleSums {
  float value = 0, gradient[3] = {}, absolute = 0;
};

/// The kernels of a cell, placed in the frame; the last vector is filled with ones that add
/// nothing.
struct CellKernels {
  AlignedVector<float> x, y, z, inverse_radius_sq, peak;
  AlignedVector<std::int32_t> field;
  std::size_t size = 0;  ///< whole vectors

  void load(const KernelSet& kernels, const SamplingConstants& constants, const SlabFrame& frame,
            std::span<const std::uint32_t> list) {
    const LaneTag d;
    size = (list.size() + hn::Lanes(d) - 1) / hn::Lanes(d) * hn::Lanes(d);
    for (auto* array : {&x, &y, &z, &inverse_radius_sq, &peak}) {
      if (array->size() < size) array->resize(2 * size);
    }
    if (field.size() < size) field.resize(2 * size);
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t k = list[std::min(i, list.size() - 1)];
      const std::size_t f = kernels.field_of(k);
      x[i] = kernels.x[k];
      y[i] = kernels.y[k];
      z[i] = kernels.z[k];
      field[i] = static_cast<std::int32_t>(f);
      inverse_radius_sq[i] = 1 / (kernels.radius[k] * kernels.radius[k]);
      peak[i] = i < list.size() ? kernels.weight[k] * constants.fields[f].peak_factor : 0;
    }
    for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
      const Centers<Lanes> centers =
          to_frame(d, frame, hn::Load(d, &x[i]), hn::Load(d, &y[i]), hn::Load(d, &z[i]));
      hn::Store(centers.x, d, &x[i]);
      hn::Store(centers.y, d, &y[i]);
      hn::Store(centers.z, d, &z[i]);
    }
  }
};

/// Adds field f's kernels of a cell to its sums at a sample.
template <bool kGradients, class Shape>
HWY_INLINE void add_kernels(const Shape& shape, const FieldConstants& field, int f, bool one_field,
                            const SamplePlace& sample, const CellKernels& kernels,
                            SampleSums& sums) {
  const LaneTag d;
  const hn::RebindToSigned<LaneTag> di;
  // Kernels that are far away are not for the shape, which takes no exponents below its least.
  const Lanes reach_sq = hn::Set(d, 1.01f * field.support_factor * field.support_factor);
  Lanes value = hn::Zero(d), absolute = value, gradient[3] = {value, value, value};
  for (std::size_t i = 0; i < kernels.size; i += hn::Lanes(d)) {
    const Lanes x = hn::Sub(hn::Set(d, sample.x), hn::Load(d, &kernels.x[i]));
    const Lanes y = hn::Sub(hn::Set(d, sample.y), hn::Load(d, &kernels.y[i]));
    const Lanes z = hn::Sub(hn::Set(d, sample.z), hn::Load(d, &kernels.z[i]));
    const Lanes inverse_radius_sq = hn::Load(d, &kernels.inverse_radius_sq[i]);
    const Lanes q_sq =
        hn::Mul(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))), inverse_radius_sq);
    LaneMask near = hn::Le(q_sq, reach_sq);
    if (!one_field) {
      const auto fields = hn::Load(di, &kernels.field[i]);
      near = hn::And(near, hn::RebindMask(d, hn::Eq(fields, hn::Set(di, f))));
    }
    if (hn::AllFalse(d, near)) continue;
    const Lanes distance_sq = hn::Mul(q_sq, hn::Set(d, Shape::distance_scale));
    const auto radial = shape.template at<kGradients>(d, hn::IfThenElseZero(near, distance_sq));
    const Lanes peak = hn::IfThenElseZero(near, hn::Load(d, &kernels.peak[i]));
    const Lanes phi = hn::Mul(peak, radial.value);
    value = hn::Add(value, phi);
    absolute = hn::Add(absolute, hn::Abs(phi));
    if constexpr (kGradients) {
      const Lanes slope = hn::Mul(hn::Mul(peak, radial.steepness), inverse_radius_sq);
      gradient[0] = hn::NegMulAdd(slope, x, gradient[0]);
      gradient[1] = hn::NegMulAdd(slope, y, gradient[1]);
      gradient[2] = hn::NegMulAdd(slope, z, gradient[2]);
    }
  }
  const auto sum_of = [&](Lanes v) HWY_ATTR { return hn::GetLane(hn::SumOfLanes(d, v)); };
  sums.value = sum_of(value);
  sums.absolute = sum_of(absolute);
  if constexpr (kGradients) {
    for (std::size_t i = 0; i < 3; ++i) sums.gradient[i] = sum_of(gradient[i]);
  }
}

/// Evaluates field f at a sample from the kernels of its cell.
template <bool kGradients>
HWY_NOINLINE SampleSums evaluate_cell(const SamplingConstants& constants, int f, bool one_field,
                                      const CellKernels& kernels, const SamplePlace& sample) {
  SampleSums sums;
  const FieldConstants& field = constants.fields[f];
  with_shape(constants, static_cast<std::size_t>(f), [&](const auto& shape) HWY_ATTR {
    add_kernels<kGradients>(shape, field, f, one_field, sample, kernels, sums);
  });
  return sums;
}

/// One ray through the planes of a frame, cell by cell. Returns kernel evaluations.
template <bool kGradients, bool kAbsolute>
std::uint64_t walk_ray(const KernelSet& kernels, const SamplingConstants& constants,
                       const CellGrid& grid, const View& view, const RayPacket& packet,
                       std::size_t lane, const PacketFrame& frame, const Slab& slab, int offset,
                       const RayState& rays, CellKernels& cell_kernels, SampleBuffer& buffer) {
  const std::size_t lanes = hn::Lanes(LaneTag());
  const int num_fields = static_cast<int>(kernels.fields.size());
  const int first = std::max(slab.first, static_cast<int>(rays.first[lane]));
  const int last = std::min(slab.first + slab.count - 1, static_cast<int>(rays.last[lane]));
  const Point3d origin =
      view.eye + packet.origin_x[lane] * view.axes.x + packet.origin_y[lane] * view.axes.y;
  const Vector3d direction = packet.direction_x[lane] * view.axes.x +
                             packet.direction_y[lane] * view.axes.y + view.axes.forward;
  std::uint64_t evaluations = 0;
  std::int64_t current = -1;  // whose kernels are loaded
  for (int k = first; k <= last; ++k) {
    const std::int64_t cell = grid.cell_of(origin + view.planes.depth(k) * direction);
    if (cell < 0 || grid.kernels_in(cell).empty()) continue;
    if (cell != current) {
      cell_kernels.load(kernels, constants, frame.slab, grid.kernels_in(cell));
      current = cell;
    }
    const float dz = frame.slab.first_depth + static_cast<float>(k - slab.first) * frame.slab.step;
    const SamplePlace place{frame.offset_x[lane] + dz * frame.direction_x[lane],
                            frame.offset_y[lane] + dz * frame.direction_y[lane], dz};
    const int sample = offset + k - slab.first;
    buffer.touch(sample, sample);
    for (int f = 0; f < num_fields; ++f) {
      const SampleSums sums =
          evaluate_cell<kGradients>(constants, f, num_fields == 1, cell_kernels, place);
      float* const channels = buffer.at(sample, f) + lane;
      channels[0] = sums.value;
      if constexpr (kGradients) {
        for (std::size_t i = 0; i < 3; ++i) channels[(1 + i) * lanes] = sums.gradient[i];
      }
      if constexpr (kAbsolute) channels[(kGradients ? 4 : 1) * lanes] = sums.absolute;
    }
    evaluations += cell_kernels.size;
  }
  return evaluations;
}

/// Fills `buffer` (all zero before) as sample_coherent() does, ray by ray and sample by sample.
/// Returns kernel evaluations.
template <bool kGradients, bool kAbsolute>
HWY_NOINLINE std::uint64_t sample_cells(const KernelSet& kernels,
                                        const SamplingConstants& constants, const CellGrid& grid,
                                        const View& view, const RayPacket& packet,
                                        const RayState& rays, const Slab& slab,
                                        SampleBuffer& buffer) {
  static thread_local CellKernels cell_kernels;
  std::uint64_t evaluations = 0;
  for (int begin = 0; begin < slab.count; begin += max_frame_planes) {
    const Slab piece{slab.first + begin, std::min(slab.count - begin, max_frame_planes)};
    const PacketFrame frame = make_packet_frame(packet, piece, view);
    for (std::size_t lane = 0; lane < hn::Lanes(LaneTag()); ++lane) {
      evaluations +=
          walk_ray<kGradients, kAbsolute>(kernels, constants, grid, view, packet, lane, frame,
                                          piece, begin, rays, cell_kernels, buffer);
    }
  }
  return evaluations;
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
