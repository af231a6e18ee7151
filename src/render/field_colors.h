// Balls and sticks in the colours of the fields that their particles belong to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/aligned.h"
#include "field/kernel_set.h"
#include "scene/geometry.h"
#include "scene/transfer_function.h"
#include "surface/surface.h"

namespace motes {

/// Which field the particles that are drawn belong to, and what it is at their centres.
struct FieldValues {
  static constexpr std::uint8_t none = 255;
  UninitializedVector<std::uint8_t> field;  ///< one a kernel in leaf order, or `none`
  UninitializedVector<float> value;         ///< in the field's unit

  bool empty() const { return field.empty(); }
  std::size_t bytes() const { return field.size() + value.size() * sizeof(float); }
};

/// The number of a particle that is not among those that are drawn.
inline constexpr std::uint32_t not_drawn = std::numeric_limits<std::uint32_t>::max();

/// Those of the particles whose colour is ColorBy::field: of several fields that have one, the
/// first. `particle_of` and `drawn` tell of each kernel, in leaf order, its particle and its number
/// in `geometry`, or not_drawn.
FieldValues find_field_values(const KernelSet& kernels, const GeometrySource& geometry,
                              const UninitializedVector<std::uint32_t>& particle_of,
                              const UninitializedVector<std::uint32_t>& drawn);

/// `colors`, and for particles that have a field that of its transfer function.
SurfaceColors color_by_fields(const SurfaceColors& colors, const FieldValues& values,
                              const std::vector<TransferFunction>& transfer_functions);

}  // namespace motes
