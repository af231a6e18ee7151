#include "field/kernel_set.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

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

constexpr std::size_t grain = 1 << 14;

/// Weights as the kernels use them before kernel_scale: over radius^3 where the field is
/// normalised. `radius` is internal, which keeps the cube from overflowing on the way.
double effective_weight(const FieldSource& source, std::size_t i, double radius,
                        double length_scale) {
  const double weight = source.weight_of(i);
  if (!source.normalise) return weight;
  return weight / (radius * radius * radius) * length_scale * length_scale * length_scale;
}

/// What has to be known of all kernels of a field, or of all fields, before they can be scaled.
struct Extremes {
  Bounds3f centers;  ///< relative to the origin
  float min_radius = std::numeric_limits<float>::max(), max_radius = 0;

  void add(const Extremes& other) {
    centers.add(other.centers);
    min_radius = std::min(min_radius, other.min_radius);
    max_radius = std::max(max_radius, other.max_radius);
  }
};

/// reduce(i, T& result) for all i < n, in parallel; T::add joins results in any order.
template <class T, class Reduce>
T reduce_all(std::size_t n, Reduce&& reduce) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, n, grain), T{},
      [&](const auto& range, T result) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) reduce(i, result);
        return result;
      },
      [](T a, const T& b) {
        a.add(b);
        return a;
      });
}

Extremes extremes_of(const ParticleSet& particles, const FieldSource& source) {
  return reduce_all<Extremes>(source.index.size(), [&](std::size_t i, Extremes& e) {
    const std::uint32_t p = source.index[i];
    e.centers.add(Point3f{particles.x[p], particles.y[p], particles.z[p]});
    const float radius = source.radius_of(i);
    e.min_radius = std::min(e.min_radius, radius);
    e.max_radius = std::max(e.max_radius, radius);
  });
}

struct Weights {
  double max = 0;  ///< magnitude
  bool positive = false, negative = false;

  void add(const Weights& other) {
    max = std::max(max, other.max);
    positive = positive || other.positive;
    negative = negative || other.negative;
  }
};

FieldKernels summarise(const FieldSource& source, const Extremes& extremes, double length_scale) {
  const auto weights = reduce_all<Weights>(source.index.size(), [&](std::size_t i, Weights& w) {
    const double radius = source.radius_of(i) * length_scale;
    const double weight = effective_weight(source, i, radius, length_scale);
    w.add({std::abs(weight), weight > 0, weight < 0});
  });
  FieldKernels field{.name = source.name, .kernel = source.kernel, .normalise = source.normalise};
  field.min_radius = static_cast<float>(extremes.min_radius * length_scale);
  field.max_radius = extremes.max_radius;
  field.mixed_signs = weights.positive && weights.negative;
  field.value_scale = unit_scale(weights.max);
  return field;
}

/// Where each field's kernels begin in the order of the sources, one field after another, and at
/// the end their number.
std::vector<std::size_t> begins_of(const std::vector<FieldSource>& fields) {
  std::vector<std::size_t> begins{0};
  for (const FieldSource& source : fields) begins.push_back(begins.back() + source.index.size());
  if (begins.back() >= std::numeric_limits<std::uint32_t>::max()) {
    throw Error(fmt::format("{} kernels in all fields, expected fewer than 2^32", begins.back()));
  }
  return begins;
}

/// All kernels in the order of the sources: one read from memory each where the tree's order, which
/// is another one, asks for them.
UninitializedVector<Sphere> gather(const ParticleSet& particles,
                                   const std::vector<FieldSource>& fields, double length_scale) {
  const std::vector<std::size_t> begins = begins_of(fields);
  UninitializedVector<Sphere> spheres(begins.back());
  const auto s = static_cast<float>(length_scale);  // a power of two: exact
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const FieldSource& source = fields[f];
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, source.index.size(), grain), [&](const auto& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const std::uint32_t p = source.index[i];
            spheres[begins[f] + i] = {particles.x[p] * s, particles.y[p] * s, particles.z[p] * s,
                                      static_cast<float>(source.radius_of(i) * length_scale)};
          }
        });
  }
  return spheres;
}

/// Far outside every data set (internal lengths are near 1), and its square is still finite.
constexpr float far_away = 1e15f;

/// Sizes the arrays for n kernels, and pads them.
void allocate_kernels(std::size_t n, KernelSet& set) {
  const std::size_t padded = (n + Bvh::leaf_size - 1) / Bvh::leaf_size * Bvh::leaf_size;
  const auto allocate = [&](auto& array, auto padding) {
    array.resize(padded);
    std::fill(array.begin() + static_cast<std::ptrdiff_t>(n), array.end(), padding);
  };
  for (auto* array : {&set.x, &set.y, &set.z}) allocate(*array, far_away);
  for (auto* array : {&set.radius, &set.weight}) allocate(*array, 0.0f);
  if (set.fields.size() > 1) allocate(set.field, std::uint8_t{0});
}

/// Puts the kernels into the tree's order.
void place_kernels(std::span<const Sphere> spheres, std::span<const std::uint32_t> order,
                   const std::vector<FieldSource>& fields, KernelSet& set) {
  const std::vector<std::size_t> begins = begins_of(fields);
  constexpr std::size_t ahead = 32;  // a sphere is asked for so many kernels before it is used
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, order.size(), grain), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          if (i + ahead < order.size()) __builtin_prefetch(&spheres[order[i + ahead]]);
          const std::uint32_t k = order[i];
          const auto f = static_cast<std::size_t>(
              std::upper_bound(begins.begin() + 1, begins.end() - 1, k) - (begins.begin() + 1));
          const Sphere& sphere = spheres[k];
          set.x[i] = sphere.x;
          set.y[i] = sphere.y;
          set.z[i] = sphere.z;
          set.radius[i] = sphere.radius;
          set.weight[i] = static_cast<float>(
              effective_weight(fields[f], k - begins[f], sphere.radius, set.length_scale) *
              set.fields[f].value_scale);
          if (!set.field.empty()) set.field[i] = static_cast<std::uint8_t>(f);
        }
      });
}

}  // namespace

KernelSet build_kernel_set(const ParticleSet& particles, const std::vector<FieldSource>& fields) {
  if (fields.size() > max_fields) {
    throw Error(fmt::format("{} fields, expected at most {}", fields.size(), max_fields));
  }
  KernelSet set;
  set.origin = particles.origin;

  // The box of all centres, and the scale of lengths that follows from it.
  std::vector<Extremes> extremes;
  Extremes all;
  for (const FieldSource& source : fields) {
    extremes.push_back(extremes_of(particles, source));
    all.add(extremes.back());
  }
  if (all.centers.empty()) return set;
  const Vector3d shift{set.origin.x, set.origin.y, set.origin.z};
  set.centers = {Point3d(all.centers.min) + shift, Point3d(all.centers.max) + shift};
  const Vector3d extent = set.centers.diagonal();
  set.length_scale =
      unit_scale(std::max({extent.x, extent.y, extent.z, static_cast<double>(all.max_radius)}));
  for (std::size_t f = 0; f < fields.size(); ++f) {
    set.fields.push_back(summarise(fields[f], extremes[f], set.length_scale));
  }

  // Kernels in leaf order, padded to whole leaves.
  {
    const UninitializedVector<Sphere> spheres = gather(particles, fields, set.length_scale);
    const UninitializedVector<std::uint32_t> order = spatial_order(spheres);
    allocate_kernels(order.size(), set);
    place_kernels(spheres, order, fields, set);
    set.bvh.num_particles = order.size();
  }
  const auto kernels = [&](const auto& v) { return std::span(v).first(set.size()); };
  set.bvh = build_bvh(kernels(set.x), kernels(set.y), kernels(set.z), kernels(set.radius));
  return set;
}

}  // namespace motes
