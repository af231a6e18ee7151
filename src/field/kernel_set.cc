#include "field/kernel_set.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "core/error.h"

namespace motes {

double FieldKernels::peak_factor() const {
  return normalise ? kernel.kernel_scale / kernel.integral() : kernel.kernel_scale;
}

void FieldKernels::set_kernel(const Kernel& new_kernel) {
  kernel = new_kernel;
  table = kernel.shape.type == KernelType::tabulated ? make_radial_table(kernel) : RadialTable{};
}

std::size_t KernelSet::particle_bytes() const {
  const std::size_t coordinates = x.size() + y.size() + z.size();
  return coordinates * sizeof(float) + radius.bytes() + weight.bytes() + field.size();
}

Bounds3d KernelSet::box() const {
  double max_support = 0;
  for (const FieldKernels& f : fields) {
    max_support = std::max(max_support, f.kernel.support() * f.max_radius);
  }
  if (centers.empty()) return centers;
  return centers.extended(max_support);
}

double unit_scale(double magnitude) {
  if (!(magnitude > 0)) return 1;
  // Kept where both the scale and its cube are normal numbers.
  return std::exp2(std::clamp(-std::floor(std::log2(magnitude)), -300.0, 300.0));
}

namespace {

constexpr std::size_t grain = 1 << 14;

/// Weights as the kernels use them before kernel_scale: over radius^3 where the field is
/// normalised. `radius` is internal, which keeps the cube from overflowing on the way.
double effective_weight(const FieldSource& source, std::size_t i, double radius,
                        double length_scale) {
  const double weight = source.weight_of(i);
  if (!source.normalise) return weight;
  return weight / (radius * radius * radius) * length_scale * length_scale * length_scale;
}

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

/// Of the centres, relative to the origin.
Bounds3f bounds_of(const ParticleSet& particles, const FieldSource& source) {
  return reduce_all<Bounds3f>(source.index.size(), [&](std::size_t i, Bounds3f& box) {
    const std::uint32_t p = source.index[i];
    box.add(Point3f{particles.x[p], particles.y[p], particles.z[p]});
  });
}

/// File's lengths.
struct RadiusRange {
  float min = std::numeric_limits<float>::max(), max = 0;

  void add(const RadiusRange& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
  }
};

RadiusRange radius_range(const FieldSource& source) {
  return reduce_all<RadiusRange>(source.radius.size(), [&](std::size_t i, RadiusRange& range) {
    range.add({source.radius[i], source.radius[i]});
  });
}

struct WeightRange {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();

  void add(const WeightRange& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
  }
  double magnitude() const { return std::max({-min, max, 0.0}); }
};

/// Of effective weights.
WeightRange weight_range(const FieldSource& source, double length_scale) {
  const std::size_t different =
      source.index.empty() ? 0 : std::max(source.radius.size(), source.weight.size());
  return reduce_all<WeightRange>(different, [&](std::size_t i, WeightRange& range) {
    const float radius = source.radius_of(i) * static_cast<float>(length_scale);
    const double weight = effective_weight(source, i, radius, length_scale);
    range.add({weight, weight});
  });
}

FieldKernels summarise(const FieldSource& source, const RadiusRange& radii,
                       const WeightRange& weights, double length_scale) {
  FieldKernels field;
  field.name = source.name;
  field.set_kernel(source.kernel);
  field.normalise = source.normalise;
  field.min_radius = static_cast<float>(radii.min * length_scale);
  field.max_radius = radii.max;
  const auto& profile = source.kernel.shape.profile.values;
  const bool negative = std::any_of(profile.begin(), profile.end(), [](double v) { return v < 0; });
  field.mixed_signs = negative || (weights.min < 0 && weights.max > 0);
  field.value_scale = unit_scale(weights.magnitude());
  return field;
}

std::vector<RadiusRange> radius_ranges(const std::vector<FieldSource>& fields) {
  std::vector<RadiusRange> ranges;
  std::transform(fields.begin(), fields.end(), std::back_inserter(ranges), radius_range);
  return ranges;
}

/// What the scale of lengths goes by; file's lengths.
double largest_length(const Bounds3d& centers, const std::vector<RadiusRange>& ranges) {
  const Vector3d extent = centers.diagonal();
  double largest = std::max({extent.x, extent.y, extent.z});
  for (const RadiusRange& range : ranges) {
    largest = std::max(largest, static_cast<double>(range.max));
  }
  return largest;
}

/// `box` is relative to the particles' origin.
void set_centers(const ParticleSet& particles, const Bounds3d& box, KernelSet& set) {
  set.origin = particles.origin;
  const Vector3d shift{set.origin.x, set.origin.y, set.origin.z};
  set.centers = {box.min + shift, box.max + shift};
}

/// The internal radius and weight that all kernels of all fields have, where they have the same.
struct CommonValues {
  std::optional<float> radius, weight;
};

/// Describes the fields in `set`, and finds what their kernels have in common.
CommonValues set_fields(const std::vector<FieldSource>& fields,
                        const std::vector<RadiusRange>& ranges, KernelSet& set) {
  const auto scale = static_cast<float>(set.length_scale);
  RadiusRange radius;
  WeightRange weight;
  bool any_kernels = false;
  set.fields.clear();
  for (std::size_t f = 0; f < fields.size() && !fields[f].drawn_only; ++f) {
    const WeightRange weights = weight_range(fields[f], set.length_scale);
    set.fields.push_back(summarise(fields[f], ranges[f], weights, set.length_scale));
    if (fields[f].index.empty()) continue;
    any_kernels = true;
    // Rounded as place_kernels() rounds each kernel's: ends that are equal leave nothing between.
    const double unit = set.fields[f].value_scale;
    radius.add({ranges[f].min * scale, ranges[f].max * scale});
    weight.add({static_cast<float>(weights.min * unit), static_cast<float>(weights.max * unit)});
  }
  CommonValues common;
  if (!any_kernels) common = {0.0f, 0.0f};
  if (radius.min == radius.max) common.radius = radius.min;
  if (weight.min == weight.max) common.weight = static_cast<float>(weight.min);
  return common;
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

/// Element j of a field's source; `scale` is the set's length_scale, a power of two: exact.
Sphere sphere_at(const ParticleSet& particles, const FieldSource& source, std::size_t j,
                 float scale) {
  const std::uint32_t p = source.index[j];
  return {particles.x[p] * scale, particles.y[p] * scale, particles.z[p] * scale,
          source.radius_of(j) * scale};
}

/// All kernels in the order of the sources: one read from memory each where the tree's order, which
/// is another one, asks for them.
UninitializedVector<Sphere> gather(const ParticleSet& particles,
                                   const std::vector<FieldSource>& fields,
                                   const std::vector<std::size_t>& begins, float scale) {
  UninitializedVector<Sphere> spheres(begins.back());
  for (std::size_t f = 0; f < fields.size(); ++f) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, fields[f].index.size(), grain),
                      [&](const auto& range) {
                        for (std::size_t j = range.begin(); j != range.end(); ++j) {
                          spheres[begins[f] + j] = sphere_at(particles, fields[f], j, scale);
                        }
                      });
  }
  return spheres;
}

/// Far outside every data set (internal lengths are near 1), and its square is still finite.
constexpr float far_away = 1e15f;

/// Room for the radii and weights of n kernels, as far as they differ.
void allocate_values(std::size_t n, const CommonValues& common, KernelSet& set) {
  const auto allocate = [n](PerKernel& values, const std::optional<float>& one) {
    if (one) {
      values.share(*one);
    } else {
      values.allocate(n);
    }
  };
  allocate(set.radius, common.radius);
  allocate(set.weight, common.weight);
}

/// Sizes the other arrays for n kernels, and pads them.
void allocate_kernels(std::size_t n, KernelSet& set) {
  const std::size_t padded = (n + Bvh::leaf_size - 1) / Bvh::leaf_size * Bvh::leaf_size;
  const auto allocate = [&](auto& array, auto padding) {
    array.resize(padded);
    std::fill(array.begin() + static_cast<std::ptrdiff_t>(n), array.end(), padding);
  };
  for (auto* array : {&set.x, &set.y, &set.z}) allocate(*array, far_away);
  // (without any field all are only drawn: field_of() is the number of the fields then, 0)
  const bool mixed = set.fields.size() + (set.has_drawn_only ? 1 : 0) > 1;
  if (mixed) allocate(set.field, std::uint8_t{0});
}

/// Puts gathered kernels into the tree's order.
void place_kernels(std::span<const Sphere> spheres, const KernelOrder& order,
                   const std::vector<FieldSource>& fields, KernelSet& set) {
  constexpr std::size_t ahead = 32;  // spheres are asked for so long before they are used
  const std::size_t n = order.kernels.size();
  const bool radii = !set.radius.is_shared(), weights = !set.weight.is_shared();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      if (i + ahead < n) __builtin_prefetch(&spheres[order.kernels[i + ahead]]);
      const std::uint32_t k = order.kernels[i];
      std::size_t f = 0;
      while (k >= order.begins[f + 1]) ++f;
      const Sphere& sphere = spheres[k];
      set.x[i] = sphere.x;
      set.y[i] = sphere.y;
      set.z[i] = sphere.z;
      if (radii) set.radius.at(i) = sphere.radius;
      if (weights && f < set.fields.size()) {
        const double weight =
            effective_weight(fields[f], k - order.begins[f], sphere.radius, set.length_scale);
        set.weight.at(i) = static_cast<float>(weight * set.fields[f].value_scale);
      } else if (weights) {
        set.weight.at(i) = 0;
      }
      if (!set.field.empty()) set.field[i] = static_cast<std::uint8_t>(f);
    }
  });
}

/// The kernels of an array, without its padding.
std::span<const float> kernels_of(const UninitializedVector<float>& array, std::size_t n) {
  return std::span(array).first(n);
}

/// A new tree is due when the leaves' area has grown by this factor (docs/performance.md, "The
/// tree").
constexpr double max_growth = 1.75;

}  // namespace

KernelSet build_kernel_set(const ParticleSet& particles, const std::vector<FieldSource>& fields,
                           KernelOrder* order) {
  if (std::count_if(fields.begin(), fields.end(), [](const FieldSource& source) {
        return !source.drawn_only;
      }) > static_cast<std::ptrdiff_t>(max_fields)) {
    throw Error(fmt::format("{} fields, expected at most {}", fields.size(), max_fields));
  }
  KernelSet set;
  set.origin = particles.origin;
  Bounds3f box, of_all;
  for (const FieldSource& source : fields) {
    const Bounds3f of_source = bounds_of(particles, source);
    of_all.add(of_source);
    if (!source.drawn_only) box.add(of_source);
    set.has_drawn_only |= source.drawn_only;
  }
  const std::vector<RadiusRange> ranges = radius_ranges(fields);
  if (of_all.empty()) {
    set_fields(fields, ranges, set);
    return set;
  }
  if (!box.empty()) set_centers(particles, {Point3d(box.min), Point3d(box.max)}, set);
  set.length_scale = unit_scale(largest_length({Point3d(of_all.min), Point3d(of_all.max)}, ranges));
  const CommonValues common = set_fields(fields, ranges, set);

  // Kernels in leaf order, padded to whole leaves.
  KernelOrder built;
  built.begins = begins_of(fields);
  const std::size_t n = built.begins.back();
  {
    const UninitializedVector<Sphere> spheres =
        gather(particles, fields, built.begins, static_cast<float>(set.length_scale));
    built.kernels = spatial_order(spheres);
    allocate_kernels(n, set);
    allocate_values(n, common, set);
    place_kernels(spheres, built, fields, set);
  }
  set.bvh = build_bvh(kernels_of(set.x, n), kernels_of(set.y, n), kernels_of(set.z, n),
                      set.radius.first(n));
  if (order != nullptr) {
    built.leaf_area = leaf_area(set.bvh);
    *order = std::move(built);
  }
  return set;
}

bool refit_kernel_set(const ParticleSet& particles, const std::vector<FieldSource>& fields,
                      const KernelOrder& order, KernelSet& set) {
  const std::size_t n = set.size();
  if (n == 0 || order.kernels.size() != n || begins_of(fields) != order.begins) return false;
  if (set.has_drawn_only || (!fields.empty() && fields.back().drawn_only)) return false;
  const std::vector<RadiusRange> ranges = radius_ranges(fields);
  allocate_values(n, set_fields(fields, ranges, set), set);
  place_kernels(gather(particles, fields, order.begins, static_cast<float>(set.length_scale)),
                order, fields, set);
  refit_bvh(set.bvh, kernels_of(set.x, n), kernels_of(set.y, n), kernels_of(set.z, n),
            set.radius.first(n));
  const Bounds3f box = bounds_of(set.bvh);  // internal lengths
  const double unit = 1 / set.length_scale;
  set_centers(particles,
              {{unit * box.min.x, unit * box.min.y, unit * box.min.z},
               {unit * box.max.x, unit * box.max.y, unit * box.max.z}},
              set);
  const double largest = largest_length(set.centers, ranges) * set.length_scale;
  return largest > 0.25 && largest < 8 && leaf_area(set.bvh) <= max_growth * order.leaf_area;
}

}  // namespace motes
