// All kernels of all fields with their tree, ready to be sampled: what rendering keeps of the
// particles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bvh/bvh.h"
#include "core/aligned.h"
#include "field/per_kernel.h"
#include "field/radial_table.h"
#include "particles/particle_set.h"
#include "scene/scene.h"

namespace motes {

/// What the kernels of one field share.
struct FieldKernels {
  std::string name;
  Kernel kernel;
  RadialTable table;  ///< of tabulated kernels
  bool normalise = false;
  bool mixed_signs = false;  ///< kernels of both signs: sum |phi| is not |Phi|
  float min_radius = 0;      ///< internal length
  double max_radius = 0;     ///< file's length
  double value_scale = 1;    ///< internal weight = weight * value_scale, a power of two

  /// Factor on an internal weight (already over radius^3 where normalised) that gives a kernel's
  /// peak: kappa, and with `normalise` one over the integral of the shape.
  double peak_factor() const;

  /// Of a shape with the same signs.
  void set_kernel(const Kernel& new_kernel);
};

/// Positions, radii and weights of all fields' kernels in leaf order of their one tree. A particle
/// that several fields take is there once a field. Arrays are padded to whole leaves with kernels
/// so far away that nothing meets them, whatever their radii.
///
/// Lengths are internal: file's length times length_scale, a power of two that brings the extent of
/// the data near 1, so that no square overflows and no digit is lost. Values are internal too
/// (FieldKernels::value_scale).
struct KernelSet {
  Point3d origin;  ///< of positions; file's lengths, world axes
  double length_scale = 1;
  UninitializedVector<float> x, y, z;
  PerKernel radius, weight;
  /// Index of each kernel's field; empty if there is only one field, or none. Particles that are
  /// only drawn have the number of the fields.
  UninitializedVector<std::uint8_t> field;
  std::vector<FieldKernels> fields;
  bool has_drawn_only = false;  ///< particles that no field has
  Bounds3d centers;             ///< of all fields' kernels; file's lengths, world axes
  Bvh bvh;

  std::size_t size() const { return bvh.num_particles; }
  std::size_t field_of(std::size_t i) const { return field.empty() ? 0 : field[i]; }
  /// Bytes of the per-particle arrays.
  std::size_t particle_bytes() const;
  /// The volume's box: centres extended by the largest support radius; file's lengths, world axes.
  Bounds3d box() const;
};

/// The power of two that brings `magnitude` into [1, 2); 1 for 0.
double unit_scale(double magnitude);

/// What it takes to fit a KernelSet to the next frame of its particles.
struct KernelOrder {
  /// Kernels in leaf order, counted through all fields' `index`, one field after another.
  UninitializedVector<std::uint32_t> kernels;
  std::vector<std::size_t> begins;  ///< where each field's begin in that count, and its end
  double leaf_area = 0;             ///< of the tree when it was built
};

/// Gathers the fields' particles, and those that are only drawn, and builds the tree; fields that
/// are grids are there without kernels, so that fields keep their numbers. Keeps what
/// refit_kernel_set() takes in `order` if that is not null. Throws Error for too many fields or
/// kernels.
KernelSet build_kernel_set(const ParticleSet& particles, const std::vector<FieldSource>& fields,
                           KernelOrder* order = nullptr);

/// Puts new positions, radii and weights into the order and the tree of `set`, which takes a
/// fraction of the time of a build. What is drawn is that of a new set, whatever has moved where.
/// False if a new one is due: the number of a field's kernels, the fields or the scale of the data
/// have changed, or the leaves have grown so much that frames lose more time than a build takes;
/// `set` is of no use then.
bool refit_kernel_set(const ParticleSet& particles, const std::vector<FieldSource>& fields,
                      const KernelOrder& order, KernelSet& set);

}  // namespace motes
