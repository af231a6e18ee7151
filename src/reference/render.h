// The picture, in double precision, one sample after the other, straight from docs/field.md. Every
// engine is held against it. Slow: for small pictures of few particles.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/color.h"
#include "core/vec.h"
#include "particles/particle_set.h"
#include "reference/field.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace motes::reference {

struct Image {
  int width = 0, height = 0;
  std::vector<double> rgba;  ///< linear, premultiplied, [height][width][4], rows from the top
  /// One flag a pixel, [height][width]: 1 where rounding may change the picture visibly, since a
  /// sample lies within 1e-5 of its distance from the eye to the support boundary of a selected
  /// particle or to a face of the volume, or an opacity lies within 1e-5 of termination,
  /// or it is faint; or since a ray runs along a face of a grid, or the rounding of a grid's value
  /// is seen.
  std::vector<unsigned char> unstable;
  /// 1 where a lit sample's field is less than 1e-20 of its kernels' peak: whether it has a normal
  /// depends on the smallest number.
  std::vector<unsigned char> faint;
  std::uint64_t samples = 0;  ///< classified, up to termination, whatever the number of fields
  std::uint64_t kernel_evaluations =
      0;  ///< pairs of such a sample and a particle whose support holds it
};

/// A piece of surface in the way of a ray.
struct Layer {
  double depth = 0;  ///< along the view, from the eye
  double opacity = 1;
  double red = 0, green = 0, blue = 0;  ///< linear, not premultiplied
};

/// `layers`: of each pixel, from the front, [height][width]; empty if there are none.
Image render(const ParticleSet& particles, const ResolvedScene& scene,
             const std::vector<std::vector<Layer>>& layers = {});

// What it is made of, apart so that each can be checked by itself:

/// x(z) = origin + z * direction, where z is the depth along the camera's view.
struct CameraRay {
  Point3d origin;
  Vector3d direction;  ///< not normalised: its component along the view is 1
};

/// The ray through the middle of the pixel in column px from the left and row py from the top.
CameraRay camera_ray(const Camera& camera, int width, int height, int px, int py);

/// The box of all particles' centres of all fields, extended by the largest support radius;
/// render() adds that of grids.
Bounds3d volume_box(const std::vector<std::vector<ParticleKernel>>& fields);

struct Classified {
  double red = 0, green = 0, blue = 0;  ///< linear, not premultiplied
  double extinction = 0;                ///< per unit length
};

Classified classify(const TransferFunction& transfer_function, double value);

/// Two-sided Phong. `view` is the unit vector from the sample towards the eye; no normal: n.l = n.h
/// = 0.
Classified shade(const Classified& sample, const Lighting& lighting,
                 const std::optional<Vector3d>& normal, const Vector3d& view);

/// Red, green, blue (premultiplied) and opacity of what a ray has met.
struct RayColor {
  double red = 0, green = 0, blue = 0, alpha = 0;
};

/// Listing 1 of Knoll et al. (2014): puts a sample that stands for `step_length` of the ray behind
/// `ray`.
void composite(RayColor& ray, const Classified& sample, double step_length);

}  // namespace motes::reference
