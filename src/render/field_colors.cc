#include "render/field_colors.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include "field/probe.h"

namespace motes {
namespace {

/// The first field that has each particle; the number of the fields for those that none has.
std::vector<std::uint8_t> first_fields(const KernelSet& kernels,
                                       const UninitializedVector<std::uint32_t>& particle_of) {
  std::vector<std::uint8_t> first;
  for (std::size_t i = 0; i < particle_of.size(); ++i) {
    const std::uint32_t p = particle_of[i];
    if (p >= first.size()) first.resize(p + 1, static_cast<std::uint8_t>(kernels.fields.size()));
    first[p] = std::min(first[p], static_cast<std::uint8_t>(kernels.field_of(i)));
  }
  return first;
}

}  // namespace

FieldValues find_field_values(const KernelSet& kernels, const GeometrySource& geometry,
                              const UninitializedVector<std::uint32_t>& particle_of,
                              const UninitializedVector<std::uint32_t>& drawn) {
  FieldValues values;
  const bool any = std::any_of(geometry.srgb.begin(), geometry.srgb.end(), &by_field);
  if (!any || kernels.fields.empty()) return values;
  const std::vector<std::uint8_t> first = first_fields(kernels, particle_of);
  values.field.resize(drawn.size());
  values.value.resize(drawn.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, drawn.size(), 1024), [&](const auto& r) {
    std::vector<Point3d> points;
    for (std::size_t i = r.begin(); i != r.end(); ++i) {
      points.push_back(kernels.origin +
                       Vector3d{kernels.x[i], kernels.y[i], kernels.z[i]} / kernels.length_scale);
    }
    const std::vector<FieldSample> samples = probe(kernels, points);
    for (std::size_t i = r.begin(); i != r.end(); ++i) {
      const std::size_t f = first[particle_of[i]];
      const bool has = drawn[i] != not_drawn && by_field(geometry.srgb_of(drawn[i])) &&
                       f < kernels.fields.size();
      values.field[i] = has ? static_cast<std::uint8_t>(f) : FieldValues::none;
      values.value[i] =
          has ? static_cast<float>(samples[(i - r.begin()) * kernels.fields.size() + f].value) : 0;
    }
  });
  return values;
}

SurfaceColors color_by_fields(const SurfaceColors& colors, const FieldValues& values,
                              const std::vector<TransferFunction>& transfer_functions) {
  SurfaceColors out;
  out.srgb.resize(values.field.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, values.field.size(), 1 << 12),
                    [&](const auto& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        const Color color = values.field[i] == FieldValues::none
                                                ? colors.of(i)
                                                : color_at(transfer_functions[values.field[i]],
                                                           static_cast<double>(values.value[i]));
                        out.set_srgb(i, color_to_srgb(color));
                      }
                    });
  return out;
}

}  // namespace motes
