// Phong's model for surfaces.
#pragma once

#include "core/color.h"
#include "core/vec.h"
#include "scene/scene.h"
#include "surface/spots.h"

namespace motes {

/// The colour of a lit surface (docs/surface.md, "Light"), `base` its own. `view`: unit vector from
/// the surface to the eye; the directions of lights are unit vectors.
Color phong(const Lighting& lighting, const Color& base, const Vector3d& normal,
            const Vector3d& view, const Light& light);

/// v with length 1; without std::hypot()'s care for lengths that no vector has here.
Vector3d unit(const Vector3d& v);

}  // namespace motes
