// Warnings about pictures that show little or nothing, and why.
#pragma once

#include "core/report.h"
#include "document/prepare.h"
#include "image/framebuffer.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace motes {

/// Where steps (in depth) are longer than the largest kernel: most kernels fall between samples.
/// Grids have no such limit.
/// Whether that is so.
bool warn_of_large_steps(const Renderer& renderer, double step_size, Warnings& warnings);

/// Where nothing in the picture is as opaque as the least level of a screen: whether the kernels
/// are out of view, too transparent, or do not reach the levels of isosurfaces. `between_samples`:
/// warn_of_large_steps() has said why those in view are not seen. Levels that grids do not reach
/// are named in any case.
void warn_of_empty_picture(const Framebuffer& image, const Renderer& renderer,
                           const ResolvedScene& scene, const DataExtent& data, bool between_samples,
                           Warnings& warnings);

}  // namespace motes
