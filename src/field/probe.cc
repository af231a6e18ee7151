#include "field/probe.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace motes {
namespace {

/// Which children of a node may have a kernel that reaches the internal point p: extended bounds,
/// rounded up.
unsigned children_around(const Bvh::Node& node, const Point3d& p, double support_factor) {
  unsigned hits = 0;
  for (std::size_t c = 0; c < Bvh::width; ++c) {
    const double reach = node.max_radius[c] * support_factor;
    const Bounds3d box{{node.min_x[c], node.min_y[c], node.min_z[c]},
                       {node.max_x[c], node.max_y[c], node.max_z[c]}};
    if (box.extended(reach * (1 + 1e-12)).contains(p)) hits |= 1u << c;
  }
  return hits;
}

/// Adds the kernels of a leaf to `sums`, one FieldSample a field, internal units.
void add_leaf(const KernelSet& kernels, std::size_t leaf, const Point3d& p, FieldSample* sums) {
  const std::size_t begin = leaf * Bvh::leaf_size;
  const std::size_t end = std::min(begin + Bvh::leaf_size, kernels.size());
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t f = kernels.field_of(i);
    if (f == kernels.fields.size()) continue;  // only drawn
    const double radius = kernels.radius[i];
    const Vector3d d = p - Point3d{kernels.x[i], kernels.y[i], kernels.z[i]};
    const RadialValue phi = evaluate(kernels.fields[f].kernel, length(d) / radius);
    const double weight = kernels.weight[i];
    sums[f].value += weight * phi.value;
    sums[f].gradient = sums[f].gradient - (weight * phi.steepness / (radius * radius)) * d;
  }
}

double largest_support(const KernelSet& kernels) {
  double largest = 0;
  for (const FieldKernels& field : kernels.fields) {
    largest = std::max(largest, field.kernel.support());
  }
  return largest;
}

Point3d to_internal(const KernelSet& kernels, const Point3d& p) {
  return Point3d{} + kernels.length_scale * (p - kernels.origin);
}

}  // namespace

std::vector<FieldSample> probe(const KernelSet& kernels, std::span<const Point3d> points) {
  const std::size_t num_fields = kernels.fields.size();
  const double support_factor = largest_support(kernels);
  std::vector<double> unit;  // from internal values to the field's
  for (const FieldKernels& field : kernels.fields) {
    unit.push_back(field.peak_factor() / field.value_scale);
  }
  std::vector<FieldSample> samples(points.size() * num_fields);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      FieldSample* const sums = samples.data() + i * num_fields;
      const Point3d p = to_internal(kernels, points[i]);
      traverse(
          kernels.bvh,
          [&](const Bvh::Node& node) { return children_around(node, p, support_factor); },
          [&](std::size_t leaf) { add_leaf(kernels, leaf, p, sums); });
      const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
      for (std::size_t f = 0; f < num_fields; ++f) {
        const double factor = finite ? unit[f] : std::numeric_limits<double>::quiet_NaN();
        sums[f].value *= factor;
        sums[f].gradient = factor * kernels.length_scale * sums[f].gradient;
      }
    }
  });
  return samples;
}

double mean_kernels_tested(const KernelSet& kernels, std::span<const Point3d> points) {
  const double support_factor = largest_support(kernels);
  std::size_t leaves = 0;
  for (const Point3d& point : points) {
    const Point3d p = to_internal(kernels, point);
    traverse(
        kernels.bvh,
        [&](const Bvh::Node& node) { return children_around(node, p, support_factor); },
        [&](std::size_t) { ++leaves; });
  }
  return static_cast<double>(leaves * Bvh::leaf_size) / static_cast<double>(points.size());
}

}  // namespace motes
