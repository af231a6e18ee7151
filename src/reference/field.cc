#include "reference/field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace motes::reference {

double truncated_gaussian_integral(double radius, double support_factor) {
  // 4 pi int_0^(sigma r) d^2 exp(-d^2 / 2 r^2) dd, by parts.
  const double s = support_factor;
  const double inside = std::erf(s / std::numbers::sqrt2) -
                        std::sqrt(2 / std::numbers::pi) * s * std::exp(-s * s / 2);
  return std::pow(2 * std::numbers::pi, 1.5) * radius * radius * radius * inside;
}

std::vector<ParticleKernel> particle_kernels(const ParticleSet& particles,
                                             const FieldSource& source) {
  std::vector<ParticleKernel> kernels;
  kernels.reserve(source.index.size());
  for (std::size_t i = 0; i < source.index.size(); ++i) {
    ParticleKernel kernel;
    kernel.center = particles.position(source.index[i]);
    kernel.radius = source.radius_of(i);
    kernel.support_radius = source.kernel.support_factor * kernel.radius;
    kernel.amplitude = source.kernel.kernel_scale * source.weight_of(i);
    if (source.normalise) {
      kernel.amplitude /= truncated_gaussian_integral(kernel.radius, source.kernel.support_factor);
    }
    kernels.push_back(kernel);
  }
  return kernels;
}

FieldValue evaluate_field(const std::vector<ParticleKernel>& kernels, const Point3d& x) {
  FieldValue field;
  for (const ParticleKernel& kernel : kernels) {
    const Vector3d offset = x - kernel.center;
    const double distance = length(offset);
    const double to_boundary = std::abs(distance - kernel.support_radius);
    field.boundary_distance = std::min(field.boundary_distance, to_boundary);
    if (distance > kernel.support_radius) continue;
    const double r2 = kernel.radius * kernel.radius;
    const double phi = kernel.amplitude * std::exp(-distance * distance / (2 * r2));
    field.value += phi;
    field.gradient = field.gradient - (phi / r2) * offset;
    field.absolute += std::abs(phi);
    ++field.num_kernels;
  }
  return field;
}

}  // namespace motes::reference
