// Particles at given places, and a field that takes all of them.
#pragma once

#include <numeric>
#include <vector>

#include "core/vec.h"
#include "particles/particle_set.h"
#include "scene/scene.h"

namespace motes {

inline ParticleSet particles_at(const std::vector<Point3d>& points) {
  std::vector<double> x, y, z;
  for (const Point3d& p : points) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  ParticleSet particles;
  set_positions(particles, x, y, z);
  return particles;
}

/// All particles with the same radius and weight.
inline FieldSource field_of_all(const ParticleSet& particles, float radius, float weight,
                                const Kernel& kernel) {
  FieldSource field;
  field.name = "all";
  field.kernel = kernel;
  field.index.resize(particles.size());
  std::iota(field.index.begin(), field.index.end(), 0u);
  field.radius = {radius};
  field.weight = {weight};
  return field;
}

}  // namespace motes
