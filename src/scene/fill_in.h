// A scene with nothing left open, to be written to a file and changed from there.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace motes {

/// `scene` with what it was resolved to in place of what it left open, so that it gives the same
/// picture: the camera, the step size, `fields` (expand_fields()) with their transfer functions,
/// weights, and radii where all are one number; of fields that are not visible nothing is filled
/// in. `sources` and the transfer functions of `resolved` are one a visible field.
Scene fill_in(const Scene& scene, const std::vector<Field>& fields,
              const std::vector<FieldSource>& sources, const ResolvedScene& resolved);

}  // namespace motes
