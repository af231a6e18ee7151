// Balls and sticks over the particles of a KernelSet: what is drawn of each, in the order of the
// one tree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bvh/bvh.h"
#include "core/aligned.h"
#include "core/color.h"
#include "field/kernel_set.h"
#include "field/per_kernel.h"

namespace motes {

/// Halves of bonds, each owned by the particle at its beginning: solid cylinders with flat ends,
/// from the particle's centre to the middle of the bond. Internal lengths, world axes.
struct Sticks {
  /// Particle i owns sticks begin[i] to begin[i + 1] - 1; the particles that pad the last leaf own
  /// none. Empty where nobody does.
  UninitializedVector<std::uint32_t> begin;
  // What follows is padded by zeros, so that whole vectors are read.
  UninitializedVector<float> x, y, z;       ///< from the particle's centre to the bond's middle
  UninitializedVector<std::uint8_t> owner;  ///< number of the particle within its leaf
  UninitializedVector<float> radius;        ///< one a stick, or one for all

  std::size_t size() const { return begin.empty() ? 0 : begin.back(); }
  float radius_of(std::size_t stick) const { return radius[radius.size() == 1 ? 0 : stick]; }
  std::size_t bytes() const;
  /// Makes room for n sticks, to be written.
  void resize(std::size_t n);
};

/// How far what is drawn of particles reaches beyond their centres, for each child of each node of
/// the tree: traversal extends bounds by it, as the field does by the kernels' supports.
class NodeReach {
 public:
  /// Of a node's eight children, in the order of Bvh::nodes; negative where nothing is drawn.
  const float* of(std::size_t node) const { return values_[node & mask_].data(); }
  std::size_t bytes() const { return values_.size() * sizeof(values_[0]); }

  /// The same for all that is drawn.
  void share(float reach);
  /// One for each child; values are to be written to what at() gives.
  void allocate(std::size_t num_nodes);
  std::array<float, Bvh::width>& at(std::size_t node) { return values_[node]; }

 private:
  UninitializedVector<std::array<float, Bvh::width>> values_;
  std::size_t mask_ = 0;
};

/// Colours of particles, linear. Sticks have their owner's.
struct SurfaceColors {
  /// Up to 256; where there is no index, the first is everybody's.
  std::vector<Color> palette{{0.8F, 0.8F, 0.8F}};
  /// Into the palette, one a particle in leaf order, or empty.
  UninitializedVector<std::uint8_t> index;
  /// Instead of a palette: sRGB-encoded red, green and blue from the low byte up, one a particle in
  /// leaf order.
  UninitializedVector<std::uint32_t> srgb;

  Color of(std::size_t particle) const;
  /// Sets a particle's in `srgb`, to 0xrrggbb.
  void set_srgb(std::size_t particle, std::uint32_t rrggbb) {
    srgb[particle] = (rrggbb & 0xff) << 16 | (rrggbb & 0xff00) | (rrggbb >> 16 & 0xff);
  }
  std::size_t bytes() const { return index.size() + srgb.size() * sizeof(std::uint32_t); }
};

/// Opaque geometry. With one radius and one colour it takes nothing a particle beyond the
/// KernelSet.
struct Surface {
  const KernelSet* kernels = nullptr;  ///< centres and tree; outlives the surface
  /// Of balls, internal lengths, in leaf order; 0 or less, or NaN: no ball.
  PerKernel radius;
  Sticks sticks;
  SurfaceColors colors;
  NodeReach reach;  ///< what fit_reach() finds

  /// Bytes besides those of the KernelSet.
  std::size_t bytes() const {
    return radius.bytes() + sticks.bytes() + colors.bytes() + reach.bytes();
  }
};

/// Works out surface.reach, in parallel. To be called once the particles, radii and sticks are
/// there, and again when they change.
void fit_reach(Surface& surface);

}  // namespace motes
