// Warnings about pictures that show little or nothing, and why.
#pragma once

#include "core/report.h"
#include "field/kernel_set.h"
#include "image/framebuffer.h"
#include "particles/particle_set.h"
#include "scene/camera.h"

namespace motes {

/// Where steps (in depth) are longer than the largest kernel: most kernels fall between samples.
/// Whether that is so.
bool warn_of_large_steps(const KernelSet& kernels, double step_size, Warnings& warnings);

/// What a message says of where the particles are.
struct DataExtent {
  Bounds3d bounds;
  std::string length_unit;
};

/// Where nothing in the picture is as opaque as the least level of a screen: whether the kernels
/// are out of view, or too transparent. `between_samples`: warn_of_large_steps() has said why those
/// in view are not seen.
void warn_of_empty_picture(const Framebuffer& image, const KernelSet& kernels, const Camera& camera,
                           const DataExtent& data, bool between_samples, Warnings& warnings);

}  // namespace motes
