#include "field/kernel_set.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"

namespace motes {

double FieldKernels::peak_factor() const {
  if (!normalise) return kernel.kernel_scale;
  // Integral over |s| <= sigma of exp(-s^2/2) in three dimensions.
  const double sigma = kernel.support_factor;
  const double integral = std::pow(2 * std::numbers::pi, 1.5) *
                          (std::erf(sigma / std::numbers::sqrt2) -
                           std::sqrt(2 / std::numbers::pi) * sigma * std::exp(-sigma * sigma / 2));
  return kernel.kernel_scale / integral;
}

std::size_t KernelSet::particle_bytes() const {
  const std::size_t floats = x.size() + y.size() + z.size() + radius.size() + weight.size();
  return floats * sizeof(float) + field.size();
}

Bounds3d KernelSet::box() const {
  double max_support = 0;
  for (const FieldKernels& f : fields) {
    max_support = std::max(max_support, f.kernel.support_factor * f.max_radius);
  }
  return centers.extended(max_support);
}

namespace {

/// The power of two that brings `magnitude` into [1, 2); 1 for 0.
double unit_scale(double magnitude) {
  if (!(magnitude > 0)) return 1;
  // Kept where both the scale and its cube are normal numbers.
  return std::exp2(std::clamp(-std::floor(std::log2(magnitude)), -300.0, 300.0));
}

/// Weights as the kernels use them before kernel_scale: over radius^3 where the field is
/// normalised.
double effective_weight(const FieldSource& source, std::size_t i, double length_scale) {
  const double weight = source.weight_of(i);
  if (!source.normalise) return weight;
  // The radius in file's lengths; the internal one keeps the cube from overflowing on the way.
  const double radius = source.radius_of(i) * length_scale;
  return weight / (radius * radius * radius) * length_scale * length_scale * length_scale;
}

/// In file's lengths.
double max_radius_of(const FieldSource& source) {
  return source.radius.empty() ? 0 : *std::max_element(source.radius.begin(), source.radius.end());
}

FieldKernels summarise(const FieldSource& source, double length_scale) {
  FieldKernels field{.name = source.name, .kernel = source.kernel, .normalise = source.normalise};
  float min_radius = std::numeric_limits<float>::max();
  double max_weight = 0;
  bool positive = false, negative = false;
  for (std::size_t i = 0; i < source.index.size(); ++i) {
    min_radius = std::min(min_radius, source.radius_of(i));
    const double weight = effective_weight(source, i, length_scale);
    max_weight = std::max(max_weight, std::abs(weight));
    positive = positive || weight > 0;
    negative = negative || weight < 0;
  }
  field.min_radius = static_cast<float>(min_radius * length_scale);
  field.max_radius = max_radius_of(source);
  field.mixed_signs = positive && negative;
  field.value_scale = unit_scale(max_weight);
  return field;
}

/// Kernels in the order of the sources, before the tree orders them.
struct Unordered {
  std::vector<float> x, y, z;
  std::vector<std::uint32_t> source_index;  // into the field's FieldSource
  std::vector<std::uint8_t> field;
};

Unordered gather(const ParticleSet& particles, const std::vector<FieldSource>& fields,
                 double scale) {
  std::size_t total = 0;
  for (const FieldSource& source : fields) total += source.index.size();
  if (total >= std::numeric_limits<std::uint32_t>::max()) {
    throw Error(fmt::format("{} kernels in all fields, expected fewer than 2^32", total));
  }
  Unordered all;
  all.x.resize(total);
  all.y.resize(total);
  all.z.resize(total);
  all.source_index.resize(total);
  all.field.resize(total);
  const auto s = static_cast<float>(scale);  // a power of two: exact
  std::size_t begin = 0;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const auto& index = fields[f].index;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, index.size(), 1 << 14),
                      [&](const auto& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) {
                          all.x[begin + i] = particles.x[index[i]] * s;
                          all.y[begin + i] = particles.y[index[i]] * s;
                          all.z[begin + i] = particles.z[index[i]] * s;
                          all.source_index[begin + i] = static_cast<std::uint32_t>(i);
                          all.field[begin + i] = static_cast<std::uint8_t>(f);
                        }
                      });
    begin += index.size();
  }
  return all;
}

/// Far outside every data set (internal lengths are near 1), and its square is still finite.
constexpr float far_away = 1e15f;

}  // namespace

KernelSet build_kernel_set(const ParticleSet& particles, const std::vector<FieldSource>& fields) {
  if (fields.size() > max_fields) {
    throw Error(fmt::format("{} fields, expected at most {}", fields.size(), max_fields));
  }
  KernelSet set;
  set.origin = particles.origin;

  // The box of all centres, and the scale of lengths that follows from it.
  Bounds3f centers;
  double max_radius = 0;
  for (const FieldSource& source : fields) {
    max_radius = std::max(max_radius, max_radius_of(source));
    for (std::size_t i = 0; i < source.index.size(); ++i) {
      const std::uint32_t p = source.index[i];
      centers.add(Point3f{particles.x[p], particles.y[p], particles.z[p]});
    }
  }
  if (centers.empty()) return set;
  const Vector3d shift{set.origin.x, set.origin.y, set.origin.z};
  set.centers = {Point3d(centers.min) + shift, Point3d(centers.max) + shift};
  const Vector3d extent = set.centers.diagonal();
  set.length_scale = unit_scale(std::max({extent.x, extent.y, extent.z, max_radius}));
  for (const FieldSource& source : fields)
    set.fields.push_back(summarise(source, set.length_scale));

  // Kernels in leaf order, padded to whole leaves.
  const Unordered all = gather(particles, fields, set.length_scale);
  const std::vector<std::uint32_t> order = spatial_order(all.x, all.y, all.z);
  const std::size_t n = order.size();
  const std::size_t padded = (n + Bvh::leaf_size - 1) / Bvh::leaf_size * Bvh::leaf_size;
  for (auto* array : {&set.x, &set.y, &set.z}) array->assign(padded, far_away);
  set.radius.assign(padded, 0.0f);
  set.weight.assign(padded, 0.0f);
  if (fields.size() > 1) set.field.assign(padded, 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 1 << 14), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const std::uint32_t k = order[i];
      const std::uint8_t f = all.field[k];
      const FieldSource& source = fields[f];
      set.x[i] = all.x[k];
      set.y[i] = all.y[k];
      set.z[i] = all.z[k];
      set.radius[i] = static_cast<float>(source.radius_of(all.source_index[k]) * set.length_scale);
      set.weight[i] =
          static_cast<float>(effective_weight(source, all.source_index[k], set.length_scale) *
                             set.fields[f].value_scale);
      if (!set.field.empty()) set.field[i] = f;
    }
  });
  const auto kernels = [n](const AlignedVector<float>& v) { return std::span(v).first(n); };
  set.bvh = build_bvh(kernels(set.x), kernels(set.y), kernels(set.z), kernels(set.radius));
  return set;
}

}  // namespace motes
