// The field at a point, in double precision, straight from docs/field.md: every particle, one after
// the other. Shares no numerics with what it checks.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/vec.h"
#include "particles/particle_set.h"
#include "scene/scene.h"

namespace motes::reference {

/// Field and gradient at a point x, with what tells how far they can be trusted.
struct FieldValue {
  double value = 0;     ///< Phi(x) = sum_i phi_i(x)
  Vector3d gradient;    ///< grad Phi(x) = -sum_i phi_i(x) (x - x_i) / r_i^2
  double absolute = 0;  ///< sum_i |phi_i(x)|
  /// Distance from x to the nearest sphere |x - x_i| = support_radius where a kernel jumps.
  double boundary_distance = std::numeric_limits<double>::infinity();
  std::size_t num_kernels = 0;  ///< how many particles have x in their support
};

inline const KernelShape gaussian{};

/// phi(x) = amplitude * shape(|x - center| / radius) where |x - center| <= support_radius, else 0.
struct ParticleKernel {
  Point3d center;
  double radius = 0;
  double support_radius = 0;
  double amplitude = 0;  ///< kappa k_i, divided by the truncated kernel's integral if normalised
  const KernelShape* shape = &gaussian;
};

/// A shape and its derivative, both by q = distance / radius, up to where it ends.
struct ShapeValue {
  double value = 0, derivative = 0;
};
ShapeValue evaluate_shape(const KernelShape& shape, double q);

/// Where a kernel ends, in radii.
double support_of(const Kernel& kernel);

/// Integral over space of exp(-|x|^2 / (2 r^2)) where |x| <= sigma r, else 0, for r = `radius`,
/// sigma = `support_factor`; in the cube of radius's unit.
double truncated_gaussian_integral(double radius, double support_factor);

/// The same of any kernel of radius 1, of peak 1 or as the table has it: Simpson's rule for all but
/// Gaussians.
double kernel_integral(const Kernel& kernel);

/// The kernels of a field's particles, in their order; `source` must outlive them.
std::vector<ParticleKernel> particle_kernels(const ParticleSet& particles,
                                             const FieldSource& source);

/// The sum of `kernels` at `x`.
FieldValue evaluate_field(const std::vector<ParticleKernel>& kernels, const Point3d& x);

}  // namespace motes::reference
