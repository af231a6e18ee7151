// A document: a scene with the data that it shows, opened once, then edited and rendered.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/report.h"
#include "document/gather.h"
#include "document/input.h"
#include "image/framebuffer.h"
#include "io/reader.h"
#include "particles/particle_set.h"
#include "render/renderer.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace motes {

/// How much of the quality that the scene asks for is spent.
enum class Quality {
  full,
  preview,  ///< one ray a pixel meets balls, sticks and isosurfaces, and little light is traced
};

/// For one thread at a time, but for what says otherwise.
class Document {
 public:
  /// Reads the data of `scene`, builds the tree and fits what the scene leaves open. Throws Error,
  /// and what `progress` throws.
  Document(Scene scene, Progress* progress, Warnings& warnings);

  /// With nothing left open.
  const Scene& scene() const { return scene_; }
  /// The scene's own camera.
  const Camera& camera() const { return resolved_.camera; }
  const ParticleSet& particles() const { return input_.particles; }
  const std::vector<LoadedGrid>& grids() const { return input_.grids; }
  const std::string& format() const { return input_.format; }
  const Renderer& renderer() const { return renderer_; }
  const ResolvedScene& resolved() const { return resolved_; }
  const GatheredScene& gathered() const { return gathered_; }
  /// Everything in view, file's lengths.
  Bounds3d bounds() const;

  /// Changes the scene, with the least work that the difference takes; `frame`: the particles of
  /// its frame, if they have been read already. Where it throws, an Error that names the key or
  /// what `progress` throws, the document is as before. Throws Error for a scene of another file:
  /// that is another document.
  void set_scene(Scene scene, Progress* progress, Warnings& warnings,
                 std::optional<ParticleSet> frame = std::nullopt);

  /// Particles of a frame of the scene's file. From any thread, with a reader of its own.
  static ParticleSet read_frame(const Scene& scene, std::uint64_t frame, Progress* progress,
                                Warnings& warnings);
  /// Frames of the scene's file, which may have to be read through: from any thread, as read_frame().
  static std::size_t count_frames(const Scene& scene, Progress* progress);

  /// The picture from `camera`; false if `cancel` became true before it was done, then `image` is of
  /// no use. Throws Error as Renderer::render() does.
  bool render(const Camera& camera, int width, int height, Quality quality,
              const std::atomic<bool>* cancel, Framebuffer& image,
              RenderStatistics* statistics = nullptr) const;

  /// A camera that holds all that is seen in an image of `aspect` = width / height.
  Camera fit(double aspect) const;

 private:
  /// What it takes to get from the present scene to another one.
  enum class Work { resolve, set_kernels, gather, read_frame, read_grids };

  Work work_for(const Scene& next) const;
  void check_same_data(const Scene& next) const;
  void resolve_again(Scene next, Progress* progress);
  void set_kernels(Scene next, Progress* progress);
  /// `read`: what has been read anew, or null.
  void gather_again(Scene next, Input* read, Progress* progress, Warnings& warnings);
  void take_frame(Scene next, ParticleSet particles, Progress* progress, Warnings& warnings);

  // In the order in which one follows from the other.
  Input input_;
  GatheredScene gathered_;
  Renderer renderer_;
  ResolvedScene resolved_;
  Scene scene_;
};

}  // namespace motes
