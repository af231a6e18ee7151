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
  const double integral = kernel_integral(source.kernel);
  for (std::size_t i = 0; i < source.index.size(); ++i) {
    ParticleKernel kernel;
    kernel.center = particles.position(source.index[i]);
    kernel.radius = source.radius_of(i);
    kernel.support_radius = support_of(source.kernel) * kernel.radius;
    kernel.shape = &source.kernel.shape;
    kernel.amplitude = source.kernel.kernel_scale * source.weight_of(i);
    if (source.normalise) {
      kernel.amplitude /= integral * std::pow(kernel.radius, 3);
    }
    kernels.push_back(kernel);
  }
  return kernels;
}

namespace {

/// Whether there is a step where the kernel ends.
bool jumps(const ParticleKernel& kernel) {
  if (kernel.shape->type == KernelType::gaussian) return true;
  return kernel.shape->type == KernelType::tabulated && kernel.shape->profile.values.back() != 0;
}

}  // namespace

FieldValue evaluate_field(const std::vector<ParticleKernel>& kernels, const Point3d& x) {
  FieldValue field;
  for (const ParticleKernel& kernel : kernels) {
    const Vector3d offset = x - kernel.center;
    const double distance = length(offset);
    if (jumps(kernel)) {
      const double to_boundary = std::abs(distance - kernel.support_radius);
      field.boundary_distance = std::min(field.boundary_distance, to_boundary);
    }
    if (distance > kernel.support_radius) continue;
    const ShapeValue shape = evaluate_shape(*kernel.shape, distance / kernel.radius);
    const double phi = kernel.amplitude * shape.value;
    field.value += phi;
    if (distance > 0) {
      const double slope = kernel.amplitude * shape.derivative / kernel.radius;
      field.gradient = field.gradient + (slope / distance) * offset;
    }
    field.absolute += std::abs(phi);
    ++field.num_kernels;
  }
  return field;
}

}  // namespace motes::reference
