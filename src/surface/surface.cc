#include "surface/surface.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "samples/samples.h"

namespace motes {
namespace {

constexpr float nothing = -1;

/// Of one particle; `nothing` if it has neither ball nor stick.
float reach_of(const Surface& surface, std::size_t particle) {
  const Sticks& sticks = surface.sticks;
  float reach = surface.radius[particle] > 0 ? surface.radius[particle] : nothing;
  if (sticks.begin.empty()) return reach;
  for (std::size_t s = sticks.begin[particle]; s < sticks.begin[particle + 1]; ++s) {
    // The far corner of the cylinder, and its rounding.
    const float end =
        std::hypot(std::hypot(sticks.x[s], sticks.y[s], sticks.z[s]), sticks.radius_of(s));
    reach = std::max(reach, end * 1.000001f);
  }
  return reach;
}

/// Sets the nodes of a level in parallel: set(node, index within the level).
template <class Set>
void fill_level(const Bvh& bvh, NodeReach& reach, std::size_t level, const Set& set) {
  const std::size_t begin = bvh.level_begin[level], count = bvh.level_end(level) - begin;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      reach.at(begin + i).fill(nothing);
      set(reach.at(begin + i), i);
    }
  });
}

}  // namespace

std::size_t Sticks::bytes() const {
  return begin.size() * sizeof(begin[0]) + (x.size() + y.size() + z.size()) * sizeof(x[0]) +
         owner.size() + radius.size() * sizeof(radius[0]);
}

void Sticks::resize(std::size_t n) {
  const auto allocate = [n](auto& array) {
    array.resize(n + max_lanes);
    std::fill_n(array.begin() + static_cast<std::ptrdiff_t>(n), max_lanes, 0);
  };
  for (auto* array : {&x, &y, &z}) allocate(*array);
  allocate(owner);
}

void NodeReach::share(float reach) {
  values_.resize(1);
  values_[0].fill(reach);
  mask_ = 0;
}

void NodeReach::allocate(std::size_t num_nodes) {
  values_.resize(num_nodes);
  mask_ = ~std::size_t{0};
}

Color SurfaceColors::of(std::size_t particle) const {
  if (srgb.empty()) return palette[index.empty() ? 0 : index[particle]];
  static const std::array<float, 256> linear = [] {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      table[i] = static_cast<float>(srgb_to_linear(static_cast<double>(i) / 255));
    }
    return table;
  }();
  const std::uint32_t c = srgb[particle];
  return {linear[c & 0xff], linear[c >> 8 & 0xff], linear[c >> 16 & 0xff]};
}

void fit_reach(Surface& surface) {
  const Bvh& bvh = surface.kernels->bvh;
  if (bvh.nodes.empty() || (surface.radius.is_shared() && surface.sticks.begin.empty())) {
    surface.reach.share(surface.radius[0] > 0 ? surface.radius[0] : nothing);
    return;
  }
  surface.reach.allocate(bvh.nodes.size());
  const std::size_t last_level = bvh.level_begin.size() - 1;
  fill_level(bvh, surface.reach, last_level, [&](auto& children, std::size_t i) {
    for (std::size_t c = 0; c < Bvh::width; ++c) {
      const std::size_t first = (i * Bvh::width + c) * Bvh::leaf_size;
      const std::size_t last = std::min(first + Bvh::leaf_size, bvh.num_particles);
      for (std::size_t p = first; p < last; ++p) {
        children[c] = std::max(children[c], reach_of(surface, p));
      }
    }
  });
  for (std::size_t level = last_level; level-- > 0;) {
    const std::size_t below = bvh.level_begin[level + 1];
    const std::size_t num_below = bvh.level_end(level + 1) - below;
    fill_level(bvh, surface.reach, level, [&](auto& children, std::size_t i) {
      for (std::size_t c = 0; c < Bvh::width && i * Bvh::width + c < num_below; ++c) {
        const auto& node = surface.reach.at(below + i * Bvh::width + c);
        children[c] = *std::max_element(node.begin(), node.end());
      }
    });
  }
}

}  // namespace motes
