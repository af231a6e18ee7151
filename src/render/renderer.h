// The renderer: fields of particles with their tree, ready to be looked at from anywhere.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/report.h"
#include "field/cell_grid.h"
#include "field/kernel_set.h"
#include "image/framebuffer.h"
#include "particles/particle_set.h"
#include "render/field_colors.h"
#include "render/grid_fields.h"
#include "render/stages.h"
#include "samples/layers.h"
#include "scene/scene.h"
#include "surface/surface.h"

namespace motes {

struct FrameContext;
struct TileCounts;

struct RenderOptions {
  int threads = 0;  ///< 0: all of the machine's
  /// Planes of samples of one pass over the tree (paper, section 4.2); 0: the whole ray in one
  /// pass; nullopt: 32 for one field, 64 / M for M fields. The sweep takes 16, if it is told so 8
  /// to 32, in whole eights.
  std::optional<int> samples_per_pass = std::nullopt;
  Progress* progress = nullptr;
  /// When it becomes true, render() soon throws Cancelled; the image is then undefined, but for
  /// the tiles that are done. May be null.
  const std::atomic<bool>* cancel = nullptr;
  /// One entry a tile, true: it is done, and left as it is in the image; render() marks those that
  /// it does, so that the same frame can go on after it was cancelled. Empty: none is. May be null.
  std::vector<std::uint8_t>* tiles_done = nullptr;
  /// Surfaces in the way of rays through fields, in place of the renderer's own geometry; empty:
  /// that.
  LayerSource layers = {};
  /// Fills RenderStatistics::evaluations_inside too, if the engine is the sweep. For a frame of its
  /// own, that is neither measured nor shown: counting takes time, and the picture is not lit.
  bool count_inside = false;
};

struct RenderStatistics {
  double frame_ms = 0;
  std::uint64_t samples = 0;             ///< inside the volume's box, up to each ray's end
  std::uint64_t kernel_evaluations = 0;  ///< carried out, those outside the support included
  StageTicks stages;                     ///< of all threads
  int threads = 0;
  std::string engine, instruction_set;
  /// Of the kernel evaluations those at samples inside the kernel's support; 0 unless
  /// RenderOptions::count_inside asks for it and the engine can tell.
  std::uint64_t evaluations_inside = 0;
};

/// How a Renderer took a new frame of its particles.
enum class TreeUpdate { refitted, rebuilt };

class Renderer {
 public:
  /// Gathers the fields' kernels and grids, and builds the tree; needs none of the arguments
  /// afterwards. Throws Error as GridSampler does.
  Renderer(const ParticleSet& particles, const std::vector<FieldSource>& fields);
  /// The same with what is drawn of `geometry`, whose bonds by distance are found through the tree
  /// and which is of no more use if this throws.
  Renderer(const ParticleSet& particles, const std::vector<FieldSource>& fields,
           GeometrySource& geometry);

  /// The picture: linear, premultiplied. The scene's transfer functions are one a field of the
  /// constructor's; its `fields` are not looked at, so kernel_scale and support_factor come from
  /// `kernels`. Throws Error for a camera without a view direction and for a step so small
  /// that the frame would never end.
  Framebuffer render(const ResolvedScene& scene, const RenderOptions& options,
                     RenderStatistics* statistics = nullptr) const;
  /// The same into `image`, whose memory is used again where its size is right: frame after frame.
  void render(const ResolvedScene& scene, const RenderOptions& options, Framebuffer& image,
              RenderStatistics* statistics = nullptr) const;

  /// Takes the next frame of moving particles, with the kernels of `fields`. Refits the tree as
  /// long as the fields keep their numbers of particles and the tree has not lost its worth; else,
  /// the first time and where there is geometry, builds it anew, which from then on keeps 4 more
  /// bytes a particle. Needs none of the arguments afterwards. Throws what the constructor throws.
  TreeUpdate set_particles(const ParticleSet& particles, const std::vector<FieldSource>& fields);
  /// The same with geometry, as in the constructor.
  TreeUpdate set_particles(const ParticleSet& particles, const std::vector<FieldSource>& fields,
                           GeometrySource& geometry);

  /// Throws what render() throws for a scene that it cannot render.
  void check(const ResolvedScene& scene) const;

  /// Makes ready what `engine` needs besides the tree. render() does so itself, for its frame
  /// alone.
  void prepare(Engine engine);

  /// Changes sigma and kappa of a field; the tree stays.
  void set_kernel(std::size_t field, const Kernel& kernel);

  const KernelSet& kernels() const { return *kernels_; }
  const GridFields& grids() const { return grids_; }
  /// Balls and sticks over kernels(), or null.
  const Surface* surface() const { return surface_ ? &*surface_ : nullptr; }
  /// Bytes of balls and sticks besides those of kernels().
  std::size_t surface_bytes() const {
    return surface_ ? surface_->bytes() + field_values_.bytes() : 0;
  }
  /// Time that the last build or refit took.
  double build_ms() const { return build_ms_; }

 private:
  void build(const ParticleSet& particles, const std::vector<FieldSource>& fields,
             GeometrySource& geometry);

  /// Samples the fields, cut by the context's layers.
  void render_volume(const ResolvedScene& scene, const RenderOptions& options,
                     FrameContext& context, Framebuffer& image, TileCounts& all) const;

  std::unique_ptr<KernelSet> kernels_ = std::make_unique<KernelSet>();  ///< stays where it is
  std::optional<Surface> surface_;
  FieldValues field_values_;
  std::vector<std::uint16_t> species_;  ///< of kernels, for isosurfaces that are coloured by it
  GridFields grids_;
  KernelOrder order_;  ///< empty until particles move
  std::optional<CellGrid> cells_;
  double build_ms_ = 0;
};

}  // namespace motes
