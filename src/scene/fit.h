// What a scene leaves open, fitted to the data: the camera, the step size, the transfer functions.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace motes {

/// A particle as a camera should show it; file's lengths, world axes.
struct VisibleSphere {
  Point3d center;
  double radius = 0;
};

/// A field's values at points; file's lengths, world axes.
using FieldValuesAt =
    std::function<std::vector<double>(std::size_t field, std::span<const Point3d>)>;

/// The particles of fields that draw a volume, or some of them where there are very many, each as
/// large as its Gaussian is easily seen; those that are far larger than is typical (in the voids of
/// a cosmological box) are taken for smaller.
/// Of fields with isosurfaces the particles, each as large as the surface of the level that lies
/// farthest out may be there: with `values_at`, where phi, as high at the centre as the field and a
/// quarter more, falls to the level; without it, and where kernels are of both signs, the support.
/// With them the balls of `geometry`, whole, the ends of sticks that leave a periodic cell, and
/// points around what grids have to be seen, as spheres of radius 0: magnitudes of three tenths of
/// the level that encloses most of a field (enclosing_level()), or of its isosurfaces in `fields`,
/// which are those of the sources. What `clip_planes` take away is not there, unless they leave
/// nothing.
std::vector<VisibleSphere> visible_spheres(const ParticleSet& particles,
                                           const std::vector<FieldSource>& sources,
                                           const GeometrySource& geometry = {},
                                           const std::vector<Field>& fields = {},
                                           const FieldValuesAt& values_at = {},
                                           const std::vector<ClipPlane>& clip_planes = {});

/// The scene's camera; what it leaves open is fitted so that the spheres just fill an image of
/// `aspect` = width / height. The view is oblique, mostly along their box's thinnest axis, so that
/// its largest face is seen; y is up, or z where the view is mostly along y or x. Strays do not
/// count: at most one sphere in a thousand, so far away that the others would be small for it.
/// In views so wide that all would fit from nearer, the eye keeps 5 % of the diagonal of the
/// spheres' box in front of the first of them.
/// Precondition: there are spheres, or eye, target and up are given. Throws Error as camera_axes()
/// does.
Camera fit_camera(const Scene& scene, const std::vector<VisibleSphere>& spheres, double aspect);

/// Half of a small radius: of what all fields' Gaussians cover in a picture (radius squared), 5 %
/// belongs to smaller ones. So it samples nearly all that is seen well, and a few tiny particles do
/// not make every picture slow. Or half of the shortest edge of grids' voxels, if that is less. But
/// at most 2048 samples along the diagonal of `box`.
double default_step_size(const std::vector<FieldSource>& fields, const Bounds3d& box);

/// Values of a field along rays of the view, at equal distances on each ray.
struct RayProfiles {
  std::vector<float> values;           ///< ray after ray
  std::vector<std::size_t> ray_begin;  ///< into `values`; one a ray and one past the last
  std::vector<double> spacing;         ///< length between two values of a ray; one a ray
};

/// How opaque each of several fields should make the rays that meet it, so that rays that meet
/// matter come to the opacity of a good picture: on average 0.7 over black and 0.9 over white,
/// which would bleach them; around balls or sticks, which are to be seen within, six tenths of
/// that. `profiles`: one a field, of the same rays.
double fit_opacity(const std::vector<RayProfiles>& profiles, const Color& background,
                   bool around_solids = false);

/// The transfer function that `wish` (or nothing: a default) comes to in this view. What it leaves
/// open:
/// - the range spans from the median of the values that are not 0 to nearly the largest, on a
///   logarithmic scale from their 70 % quantile where they span decades; for values of both signs
///   (signs_of()) it is symmetric about 0;
/// - the extinction rises over the range so that rays through matter get `opacity` on average:
///   linearly, or on a logarithmic scale with the power 1.5 of the place in it, and then less where
///   more than 40 % of the light of the rays' largest values would be lost in front of them, but
///   not below 3/7 of `opacity`; a given extinction rises linearly there too. Over a fitted range
///   of both signs it is 0 up to the magnitude beyond which 85 % of the values' squares lie
///   (enclosing_level()), has half of its height at 6 % of the way from there to the end, and rises
///   linearly from there.
/// - without a name the colours are those of viridis, or, for values of both signs, those of
///   `colors` for these, or the own one where that is preferred.
/// The own colour is that of species_colors too. Single colours are paler towards the ends of the
/// range. Throws Error for a range that cannot be.
TransferFunction fit_transfer_function(const decltype(Field::transfer_function)& wish,
                                       const FieldColors& colors, const RayProfiles& profiles,
                                       double opacity);

}  // namespace motes
