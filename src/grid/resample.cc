#include "grid/resample.h"

#include <cstdint>
#include <vector>

#include "grid/brick.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grid/resample.cc"
#include <hwy/foreach_target.h>
// Included again for each instruction set.
#include <hwy/highway.h>

#include "core/flush_tiny.h"
#include "field/sampling-inl.h"
#include "field/shapes-inl.h"
#include "grid/sum_brick-inl.h"
#include "samples/compress-inl.h"
#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Squared distance of a brick's box to boxes, one a lane.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V distance_sq(D d, const Bounds3f& brick, const float* const min[3],
                         const float* const max[3], std::size_t at) {
  V sum = hn::Zero(d);
  for (int a = 0; a < 3; ++a) {
    const V below = hn::Sub(hn::Load(d, min[a] + at), hn::Set(d, brick.max[a]));
    const V above = hn::Sub(hn::Set(d, brick.min[a]), hn::Load(d, max[a] + at));
    const V outside = hn::Max(hn::Max(below, above), hn::Zero(d));
    sum = hn::MulAdd(outside, outside, sum);
  }
  return sum;
}

/// Where something of that radius may reach in: a little farther than it does.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V reach_sq(D d, float support_factor, V radius) {
  const V reach = hn::Mul(hn::Set(d, support_factor * 1.0001f), radius);
  return hn::Mul(reach, reach);
}

/// Which children of a node may have a kernel that reaches the brick: bit c for child c.
HWY_INLINE unsigned children_near(const Bvh::Node& node, const Bounds3f& brick,
                                  float support_factor) {
  const hn::CappedTag<float, Bvh::width> d;
  const float* const min[3] = {node.min_x, node.min_y, node.min_z};
  const float* const max[3] = {node.max_x, node.max_y, node.max_z};
  unsigned hits = 0;
  for (std::size_t c = 0; c < Bvh::width; c += hn::Lanes(d)) {
    const auto reach = reach_sq(d, support_factor, hn::Load(d, node.max_radius + c));
    hits |= mask_bits(d, hn::Le(distance_sq(d, brick, min, max, c), reach)) << c;
  }
  return hits;
}

/// Numbers of the kernels that may reach a brick, in the tree's order.
struct NearKernels {
  std::vector<std::uint32_t> all;
  std::vector<std::vector<std::uint32_t>> of_field;  ///< if there are several

  void find(const KernelSet& kernels, const SamplingConstants& constants, const Brick& brick) {
    const LaneTag d;
    std::size_t size = 0;
    const auto visit = [&](std::size_t leaf) HWY_ATTR {
      if (all.size() < size + Bvh::leaf_size + max_lanes) {
        all.resize(2 * (size + Bvh::leaf_size + max_lanes));
      }
      const float* const centers[3] = {kernels.x.data(), kernels.y.data(), kernels.z.data()};
      for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::Lanes(d)) {
        const std::size_t at = leaf * Bvh::leaf_size + i;
        const Lanes reach =
            reach_sq(d, constants.max_support_factor, hn::Load(d, kernels.radius.from(at)));
        const Lanes distance = distance_sq(d, brick.box, centers, centers, at);
        const FrontLanes front(d, hn::Le(distance, reach));
        front.store(numbers_from(static_cast<std::uint32_t>(at)), all.data() + size);
        size += front.count();
      }
    };
    traverse(
        kernels.bvh,
        [&](const Bvh::Node& node)
            HWY_ATTR { return children_near(node, brick.box, constants.max_support_factor); },
        visit);
    all.resize(size);
    if (kernels.field.empty()) return;
    // (particles that are only drawn have the number behind those of the fields)
    of_field.resize(kernels.fields.size() + 1);
    for (auto& numbers : of_field) numbers.clear();
    for (const std::uint32_t i : all) of_field[kernels.field[i]].push_back(i);
  }

  const std::vector<std::uint32_t>& of(const KernelSet& kernels, std::size_t field) const {
    return kernels.field.empty() ? all : of_field[field];
  }
};

/// A brick's samples into their grid, times `factor`.
void store_samples(BrickSamples& samples, const Brick& brick, float factor, Grid& grid) {
  constexpr int side = BrickSamples::group_size;
  const hn::FixedTag<float, side> d;
  const auto unit = hn::Set(d, factor);
  for (int k = 0; k < brick.size[2]; ++k) {
    for (int j = 0; j < brick.size[1]; ++j) {
      float* const row = grid.values.data() +
                         grid.index(brick.first[0], brick.first[1] + static_cast<std::size_t>(j),
                                    brick.first[2] + static_cast<std::size_t>(k));
      for (int i = 0; i < brick.size[0]; i += side) {
        const float* const from =
            samples.at(i / side, j / side) + k * BrickSamples::group_samples + j % side * side;
        const auto four = hn::Mul(unit, hn::Load(d, from));
        const int count = std::min(side, brick.size[0] - i);
        if (count == side) {
          hn::StoreU(four, d, row + i);
        } else {
          alignas(16) float rest[side];
          hn::Store(four, d, rest);
          std::copy_n(rest, count, row + i);
        }
      }
    }
  }
}

void resample_brick(const KernelSet& kernels, const Brick& brick, std::vector<Grid>& grids) {
  static thread_local NearKernels near;
  static thread_local BrickSamples samples;
  const FlushTinyToZero guard;
  const SamplingConstants constants = make_constants(kernels);
  near.find(kernels, constants, brick);
  for (std::size_t f = 0; f < grids.size(); ++f) {
    samples.clear(brick);
    const auto& numbers = near.of(kernels, f);
    with_shape(constants, f, [&](const auto& shape) HWY_ATTR {
      add_kernels(shape, kernels, constants.fields[f], numbers, brick, samples);
    });
    const FieldKernels& field = kernels.fields[f];
    const double unit = field.peak_factor() / field.value_scale;
    store_samples(samples, brick, static_cast<float>(unit), grids[f]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "core/error.h"

namespace motes {
namespace {

HWY_EXPORT(resample_brick);

/// A lattice divided into bricks.
class Bricks {
 public:
  Bricks(const KernelSet& kernels, const Lattice& lattice) : lattice_(lattice) {
    const double scale = kernels.length_scale;
    origin_ = Point3d{} + scale * (lattice.origin - kernels.origin);
    step_ = scale * lattice.step;
    double samples = 1;
    for (const std::size_t n : lattice.dims) samples *= static_cast<double>(n);
    // Large ones cut fewer kernels; of small ones there are enough for many threads.
    side_ = samples < 256. * 256 * 256 ? Brick::max_side / 2 : Brick::max_side;
    for (std::size_t a = 0; a < 3; ++a) counts_[a] = (lattice.dims[a] + side_ - 1) / side_;
  }

  std::size_t size() const { return counts_[0] * counts_[1] * counts_[2]; }

  Brick operator[](std::size_t n) const {
    const std::array<std::size_t, 3> at{n % counts_[0], n / counts_[0] % counts_[1],
                                        n / counts_[0] / counts_[1]};
    Brick brick;
    brick.step = step_;
    for (std::size_t a = 0; a < 3; ++a) {
      const int axis = static_cast<int>(a);
      brick.first[a] = at[a] * side_;
      brick.size[a] = static_cast<int>(std::min(side_, lattice_.dims[a] - brick.first[a]));
      const double begin = origin_[axis] + static_cast<double>(brick.first[a]) * step_[axis];
      const double end = begin + (brick.size[a] - 1) * step_[axis];
      brick.origin[axis] = begin;
      brick.inverse_step[axis] = 1 / step_[axis];
      // Internal coordinates of the data are near 1; those of a lattice may be anything.
      const auto rounding = [](double x) { return 1e-6 * std::max(1., std::abs(x)); };
      brick.box.min[axis] = static_cast<float>(begin - rounding(begin));
      brick.box.max[axis] = static_cast<float>(end + rounding(end));
    }
    return brick;
  }

 private:
  const Lattice& lattice_;
  Point3d origin_;  ///< internal, as step_
  Vector3d step_;
  std::size_t side_;
  std::array<std::size_t, 3> counts_{};
};

/// Refuses peaks whose sums floats would not hold, or only as zeros.
void expect_values_to_fit(const FieldKernels& field) {
  const double peak = std::abs(field.peak_factor() / field.value_scale);
  constexpr double room = 1e8;
  if (peak == 0 || (peak > room * std::numeric_limits<float>::min() &&
                    peak < std::numeric_limits<float>::max() / room)) {
    return;
  }
  throw Error(fmt::format(
      "field '{}' has values around {:.1e}, which a grid's single-precision numbers do not hold; "
      "expected a kernel_scale around {:.0e}",
      printable(field.name), peak, 1 / peak));
}

}  // namespace

std::vector<Grid> resample(const KernelSet& kernels, const Lattice& lattice, Progress* progress) {
  std::for_each(kernels.fields.begin(), kernels.fields.end(), expect_values_to_fit);
  std::vector<Grid> grids(kernels.fields.size());
  for (std::size_t f = 0; f < grids.size(); ++f) {
    grids[f].name = kernels.fields[f].name;
    grids[f].dims = lattice.dims;
    grids[f].origin = lattice.origin;
    for (int a = 0; a < 3; ++a) grids[f].steps[static_cast<std::size_t>(a)][a] = lattice.step[a];
    grids[f].values.resize(grids[f].size());
  }
  const Bricks bricks(kernels, lattice);
  std::mutex mutex;
  std::size_t done = 0;
  tbb::parallel_for(std::size_t{0}, bricks.size(), [&](std::size_t n) {
    HWY_DYNAMIC_DISPATCH(resample_brick)(kernels, bricks[n], grids);
    const std::lock_guard lock(mutex);
    ++done;
    if (progress != nullptr) {
      progress->update("resampling",
                       static_cast<double>(done) / static_cast<double>(bricks.size()));
    }
  });
  return grids;
}

}  // namespace motes
#endif
