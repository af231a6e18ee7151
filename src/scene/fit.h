// What a scene leaves open, fitted to the data: the camera, the step size, the transfer functions.
#pragma once

#include <cstddef>
#include <vector>

#include "core/vec.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace motes {

/// The scene's camera; what it leaves open is fitted so that the whole of `box` is in an image of
/// `aspect` = width / height. The view is oblique, mostly along the box's thinnest axis, so that
/// its largest face is seen; y is up, or z where the view is mostly along y or x. Precondition:
/// `box` is not empty. Throws Error as camera_axes() does.
Camera fit_camera(const Scene& scene, const Bounds3d& box, double aspect);

/// The box that a camera should show: that of the particles' centres with a typical support around
/// it (the volume's own is drawn out by the single largest one).
Bounds3d visible_box(const std::vector<FieldSource>& fields, const Bounds3d& centers);

/// Half of a small radius (the 5 % quantile over all fields' particles), which samples the
/// Gaussians of nearly all particles well; but at most 2048 samples along the diagonal of `box`.
double default_step_size(const std::vector<FieldSource>& fields, const Bounds3d& box);

/// Values of a field along rays of the view, at equal distances on each ray.
struct RayProfiles {
  std::vector<float> values;           ///< ray after ray
  std::vector<std::size_t> ray_begin;  ///< into `values`; one a ray and one past the last
  std::vector<double> spacing;         ///< length between two values of a ray; one a ray
};

/// The transfer function that `wish` (or nothing: a default) comes to in this view. What it leaves
/// open:
/// - the range spans from the median of the values that are not 0 to nearly the largest, on a
///   logarithmic scale from their 70 % quantile where they span decades; for values of both signs
///   it is symmetric about 0;
/// - the extinction rises linearly over the range so that rays through matter are on average half
/// to
///   three quarters opaque: neither fog nor a solid block.
/// `species_color` is the colour of species_colors. `num_fields` is how many fields share the
/// picture. Throws Error for a range that cannot be.
TransferFunction fit_transfer_function(const decltype(Field::transfer_function)& wish,
                                       const Color& species_color, const RayProfiles& profiles,
                                       std::size_t num_fields);

}  // namespace motes
