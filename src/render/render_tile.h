// A tile of the image, rendered by the code for the instruction set in use: the one SIMD dispatch.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "field/cell_grid.h"
#include "field/kernel_set.h"
#include "field/slab_frame.h"
#include "image/framebuffer.h"
#include "integrate/classifier.h"
#include "integrate/shading.h"
#include "render/frame_grids.h"
#include "render/stages.h"
#include "samples/layers.h"
#include "samples/samples.h"
#include "scene/scene.h"

namespace motes {

/// Everything that a frame's tiles share; made once a frame, then only read.
struct FrameContext {
  const KernelSet* kernels = nullptr;
  const CellGrid* cells = nullptr;  ///< of the engine `cells`
  View view;
  bool orthographic = false;
  double half_width = 0,
         half_height = 0;     ///< of the image: tangents, or internal lengths if orthographic
  int width = 0, height = 0;  ///< pixels
  Bounds3d box;               ///< of the volume; internal lengths relative to kernels->origin
  std::vector<Classifier> classifiers;  ///< one a field
  ShadingConstants shading;
  Engine engine = Engine::coherent;
  bool gradients = false, absolute = false;  ///< channels of the samples
  int samples_per_pass = 32;                 ///< planes of a slab
  bool count_inside = false;                 ///< see TileCounts; the sweep alone, without gradients
  bool any_kernels = true;                   ///< else all fields are grids
  std::vector<FrameGrid> grids;              ///< of the fields those that are grids
  LayerSource layers;                        ///< of surfaces; empty: there are none
  std::vector<ClipPlane> clip_planes;  ///< unit normals; internal lengths from kernels->origin

  /// Whether rays' steps may be cut, by surfaces or clip planes.
  bool has_cuts() const { return layers || !clip_planes.empty(); }
};

struct TileCounts {
  std::uint64_t samples = 0;             ///< inside the volume's box, up to each ray's end
  std::uint64_t kernel_evaluations = 0;  ///< carried out, those outside the support included
  std::uint64_t evaluations_inside = 0;  ///< of the support, if FrameContext::count_inside
  StageTicks stages;

  void add(const TileCounts& other) {
    samples += other.samples;
    kernel_evaluations += other.kernel_evaluations;
    evaluations_inside += other.evaluations_inside;
    stages.add(other.stages);
  }
};

/// Renders `tile` into `image`. Hot: nothing is checked.
TileCounts render_tile(const FrameContext& context, const Tile& tile, Framebuffer& image);

/// Name of the instruction set that render_tile() uses: "AVX-512", "AVX2", "SSE4". The environment
/// variable MOTES_TARGET forces one. Throws Error if it names none that this machine has.
std::string instruction_set();
/// Names that MOTES_TARGET can take on this machine, best first.
std::vector<std::string> instruction_sets();
/// Forces the instruction set of that name from now on, as MOTES_TARGET does ("" for the best).
/// Throws Error.
void force_instruction_set(const std::string& name);

}  // namespace motes
