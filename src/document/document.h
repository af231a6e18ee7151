// A scene with the data that it shows: opened, edited, rendered, picked, measured.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/report.h"
#include "document/data_info.h"
#include "document/frame_reader.h"
#include "document/input.h"
#include "document/prepare.h"
#include "image/framebuffer.h"
#include "particles/particle_set.h"
#include "render/renderer.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace motes {

/// What a change of the scene took, from the least work to the most.
enum class Change {
  view,       ///< fitting what the scene leaves open, and nothing else
  kernels,    ///< new sigma or kappa
  frame,      ///< another frame, in the tree as it was or in a new one
  particles,  ///< the fields gathered again, and a new tree
};

/// How good a frame is: previews take less than all that the scene asks for.
struct FrameQuality {
  double step_factor = 1;           ///< on the scene's step size
  std::optional<int> antialiasing;  ///< see SurfaceSettings; nullopt: the scene's
  std::optional<int> occlusion_samples;
  bool shadows = true;  ///< if the scene has them
  int threads = 0;      ///< 0: all of the machine's
};

/// What was drawn at a pixel: a particle, with all that is known of it.
struct Pick {
  std::size_t index = 0;  ///< into the ParticleSet
  std::optional<std::int64_t> id;
  std::string species;  ///< "" where there are none
  Point3d position;     ///< of the particle; file's lengths, world axes
  Point3d place;        ///< that was picked, on the ray
  double distance = 0;  ///< of `place` from the ray's origin; file's length
  std::vector<std::pair<std::string, double>> properties,
      values;  ///< values: of fields, at `place`
};

/// The values that a field takes in a view, places where it is 0 left out.
struct Histogram {
  static constexpr std::size_t num_bins = 128;
  std::string name;                       ///< of the field
  double min = 0, max = 0;                ///< of the values
  std::vector<std::uint64_t> counts;      ///< min to max; empty: the view shows no values
  std::optional<double> positive_min;     ///< nullopt: no value is positive
  std::vector<std::uint64_t> log_counts;  ///< log10, positive_min to max; or empty
};

struct MemoryUse {
  std::size_t particles = 0;       ///< kernels in the tree
  std::size_t particle_bytes = 0;  ///< of the kernels' arrays
  std::size_t tree_bytes = 0;
  std::size_t surface_bytes = 0;  ///< of balls and sticks besides
};

/// Not for use from two threads at once where one of them changes it; const functions may run at
/// the same time as each other.
class Document {
 public:
  /// Reads the particles and grids of `scene` (open_scene()), builds the tree and fits what the
  /// scene leaves open. Throws Error, which begins with the file at fault or `path`, and what
  /// `progress` throws: so is it cancelled.
  static Document open(const std::filesystem::path& path, Scene scene, Progress* progress,
                       Warnings& warnings);

  /// The file that was opened, data or scene.
  const std::filesystem::path& path() const { return path_; }
  /// Everything filled in: what gives this picture again (fill_in()).
  const Scene& scene() const { return scene_; }
  const DataInfo& info() const { return info_; }
  /// Number of frames, from then on in info(). Throws Error.
  std::size_t count_frames(Progress* progress);

  /// Whether `scene` shows data that are not those of this document, or of other types: it has to
  /// be opened.
  bool shows_other_data(const Scene& scene) const;
  /// Shows `scene`, with the least work that the difference from the current one needs. What it
  /// leaves open is fitted. Throws Error for what is not valid, with the scene's key where it is
  /// known, or what `progress` throws: then all is as before. Precondition: not
  /// shows_other_data(), or Error is thrown.
  Change set_scene(const Scene& scene, Progress* progress, Warnings& warnings);
  /// The same where scene.frame has been read by frame_reader().
  Change set_scene(const Scene& scene, ParticleSet&& frame, Progress* progress, Warnings& warnings);
  /// Shows the current scene with frame number `frame`, which has been read by frame_reader().
  Change set_frame(std::uint64_t frame, ParticleSet&& particles, Progress* progress,
                   Warnings& warnings);
  /// Reads frames ahead, on any thread. Precondition: info().path is not empty.
  FrameReader frame_reader() const;

  /// The camera that holds all of the data in a picture of `aspect` = width / height.
  Camera fit(double aspect) const;
  /// The current scene's.
  const Camera& camera() const { return resolved_.camera; }

  /// The picture from `camera`: linear, premultiplied, without the background. Throws Cancelled
  /// soon after `cancel`, which may be null, becomes true; Error for what cannot be rendered. The
  /// image is then undefined. Where `tiles_done` is given (RenderOptions), the same picture of the
  /// same scene goes on after it was cancelled.
  void render(const Camera& camera, int width, int height, const FrameQuality& quality,
              const std::atomic<bool>* cancel, Framebuffer& image,
              RenderStatistics* statistics = nullptr,
              std::vector<std::uint8_t>* tiles_done = nullptr) const;

  /// The particle that is seen at (x, y) of a picture, in pixels from the left top (the middle of
  /// the first is 0.5): along that ray, where half of its opacity lies in front. There it is the
  /// ball or stick that is hit, or of all fields' particles the one with the largest part in the
  /// extinction (of an isosurface, in its field's value). nullopt if the ray's opacity is below
  /// 1 %, or no particle is there.
  std::optional<Pick> pick(const Camera& camera, int width, int height, double x, double y) const;

  /// Of each field of scene(), in its order; of those that are not visible without values. Throws
  /// Cancelled soon after `cancel`, which may be null, becomes true.
  std::vector<Histogram> histogram(const Camera& camera, int width, int height,
                                   const std::atomic<bool>* cancel = nullptr) const;

  MemoryUse memory() const;
  const ParticleSet& particles() const { return particles_; }

 private:
  Document(std::filesystem::path path, const Scene& scene);

  struct Next;
  /// What all set_scene() and set_frame() come to; `frame` is there if it is another one.
  Change take(const Scene& scene, std::optional<ParticleSet> frame, Progress* progress,
              Warnings& warnings);
  void expand(Next& next) const;
  bool keeps_kernels(const Next& next) const;
  Change set_kernels(Next& next, Progress* progress);
  Change rebuild(Next& next, Progress* progress, Warnings& warnings);
  Change move(Next& next, Progress* progress, Warnings& warnings);
  ResolvedScene resolve_with(const Next& next, const ParticleSet& particles,
                             const std::vector<FieldSource>& sources,
                             const GeometrySource& geometry, const Renderer& renderer,
                             Progress* progress) const;
  void adopt(Next& next, ResolvedScene resolved, const std::vector<FieldSource>& sources);
  void describe_data();

  std::filesystem::path path_;
  std::filesystem::path data_path_;
  std::map<int, std::string> types_;
  FrameReader reader_;
  Scene scene_;                ///< filled in
  std::vector<Field> fields_;  ///< as they were before they were filled in
  ParticleSet particles_;
  std::vector<LoadedGrid> grids_;
  std::vector<FieldSource> sources_;
  GeometrySource geometry_;
  std::optional<Renderer> renderer_;
  ResolvedScene resolved_;
  DataInfo info_;
};

}  // namespace motes
