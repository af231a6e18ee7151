#include "document/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "io/grid_reader.h"
#include "render/resolve.h"
#include "render/view_profile.h"
#include "scene/fill_in.h"
#include "scene/fit.h"

namespace motes {
namespace {

/// Whether the particles and weights of a field are the same; radii and weights that were left open
/// count as equal to what they came to.
bool gathers_same(const Field& a, const Field& b) {
  return a.grid == b.grid && a.select == b.select && a.radius == b.radius && a.weight == b.weight &&
         a.normalise == b.normalise;
}

bool asks_for_species(const Field& field) {
  return std::any_of(field.isosurfaces.begin(), field.isosurfaces.end(), [](const auto& surface) {
    return surface.color && std::holds_alternative<ColorBy>(*surface.color);
  });
}

/// Does `work`; Errors that name no file get the one at `path`.
template <class Work>
auto with_path(const std::filesystem::path& path, Work&& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(path, error.what());
  }
}

/// Ends work that reports progress.
class Cancellation : public Progress {
 public:
  explicit Cancellation(const std::atomic<bool>* cancel) : cancel_(cancel) {}

  void update(std::string_view /*activity*/, double /*fraction*/) override {
    if (cancel_ != nullptr && *cancel_) throw Cancelled();
  }

 private:
  const std::atomic<bool>* cancel_;
};

/// Bins of equal width from low to high.
std::vector<std::uint64_t> count_values(const std::vector<float>& values, double low, double high,
                                        bool logarithmic) {
  const auto place = [&](double v) { return logarithmic ? std::log10(v) : v; };
  std::vector<std::uint64_t> counts(Histogram::num_bins);
  const double begin = place(low), width = place(high) - begin;
  for (const float value : values) {
    if (!(value >= low && value <= high) || value == 0) continue;
    const double t = width > 0 ? (place(value) - begin) / width : 0;
    const auto bin = static_cast<std::size_t>(std::max(t, 0.0) * Histogram::num_bins);
    ++counts[std::min(bin, Histogram::num_bins - 1)];
  }
  return counts;
}

Histogram histogram_of(const std::string& name, const std::vector<float>& values) {
  Histogram histogram;
  histogram.name = name;
  bool any = false;
  for (const float value : values) {
    if (value == 0 || !std::isfinite(value)) continue;
    histogram.min = any ? std::min(histogram.min, double{value}) : value;
    histogram.max = any ? std::max(histogram.max, double{value}) : value;
    any = true;
    if (value > 0) {
      histogram.positive_min = std::min(histogram.positive_min.value_or(value), double{value});
    }
  }
  if (!any) return histogram;
  histogram.counts = count_values(values, histogram.min, histogram.max, false);
  if (histogram.positive_min) {
    histogram.log_counts = count_values(values, *histogram.positive_min, histogram.max, true);
  }
  return histogram;
}

}  // namespace

struct Document::Next {
  Scene scene;
  std::vector<LoadedGrid> grids;
  std::optional<ParticleSet> frame;  ///< of a frame that is not the current one
  std::vector<Field> fields;         ///< all that the scene comes to
  std::vector<Field> visible;
};

Document::Document(std::filesystem::path path, const Scene& scene)
    : path_(std::move(path)),
      data_path_(scene.data_path),
      types_(scene.types),
      reader_(data_path_, types_) {}

Document Document::open(const std::filesystem::path& path, Scene scene, Progress* progress,
                        Warnings& warnings) {
  Document document(path, scene);
  Next next;
  next.scene = std::move(scene);
  if (shows_particles(next.scene)) {
    document.particles_ = document.reader_.read_frame(next.scene.frame, progress, warnings);
  }
  next.grids = read_grids_of(next.scene, {}, progress, warnings);
  with_path(path, [&] {
    document.expand(next);
    document.rebuild(next, progress, warnings);
  });
  document.describe_data();
  return document;
}

std::size_t Document::count_frames(Progress* progress) {
  if (!info_.frames) info_.frames = data_path_.empty() ? 0 : reader_.count_frames(progress);
  return *info_.frames;
}

bool Document::shows_other_data(const Scene& scene) const {
  return scene.data_path != data_path_ || scene.types != types_;
}

FrameReader Document::frame_reader() const { return {data_path_, types_}; }

Change Document::set_scene(const Scene& scene, Progress* progress, Warnings& warnings) {
  const bool other_frame = scene.frame != scene_.frame || particles_.size() == 0;
  if (shows_other_data(scene) || !shows_particles(scene) || !other_frame) {
    return take(scene, std::nullopt, progress, warnings);
  }
  return take(scene, reader_.read_frame(scene.frame, progress, warnings), progress, warnings);
}

Change Document::set_scene(const Scene& scene, ParticleSet&& frame, Progress* progress,
                           Warnings& warnings) {
  return take(scene, std::move(frame), progress, warnings);
}

Change Document::set_frame(std::uint64_t frame, ParticleSet&& particles, Progress* progress,
                           Warnings& warnings) {
  Scene scene = scene_;
  scene.frame = frame;
  return take(scene, std::move(particles), progress, warnings);
}

Change Document::take(const Scene& scene, std::optional<ParticleSet> frame, Progress* progress,
                      Warnings& warnings) {
  if (shows_other_data(scene)) {
    throw Error("data.path: is not what is shown; expected that it is opened");
  }
  Next next;
  next.scene = scene;
  next.frame = std::move(frame);
  next.grids = read_grids_of(scene, grids_, progress, warnings);
  expand(next);
  if (next.frame) return move(next, progress, warnings);
  if (keeps_kernels(next)) return set_kernels(next, progress);
  return rebuild(next, progress, warnings);
}

void Document::expand(Next& next) const {
  const ParticleSet& particles = next.frame ? *next.frame : particles_;
  color_by_species(next.scene, particles);
  next.fields = expand_fields(next.scene, particles, next.grids);
  next.visible = visible_fields(next.fields);
}

bool Document::keeps_kernels(const Next& next) const {
  if (next.scene.geometry != scene_.geometry) return false;
  const std::vector<Field> given = visible_fields(fields_), filled = visible_fields(scene_.fields);
  if (next.visible.size() != given.size()) return false;
  for (std::size_t f = 0; f < given.size(); ++f) {
    const Field& field = next.visible[f];
    if (!gathers_same(field, given[f]) && !gathers_same(field, filled[f])) return false;
    if (field.grid) continue;
    if (kernel_of(field, next.scene.kernel).shape != sources_[f].kernel.shape) return false;
    if (asks_for_species(field) && !sources_[f].colored_by_species) return false;
  }
  return true;
}

Change Document::set_kernels(Next& next, Progress* progress) {
  std::vector<FieldSource>& sources = sources_;
  std::vector<Kernel> old;
  old.reserve(sources.size());
  for (const FieldSource& source : sources) old.push_back(source.kernel);
  const auto set = [&](std::size_t f, const Kernel& kernel) {
    if (sources[f].grid || kernel == sources[f].kernel) return false;
    renderer_->set_kernel(f, kernel);
    sources[f].kernel = kernel;
    return true;
  };
  Change change = Change::view;
  try {
    for (std::size_t f = 0; f < sources.size(); ++f) {
      if (set(f, kernel_of(next.visible[f], next.scene.kernel))) change = Change::kernels;
    }
    adopt(next, resolve_with(next, particles_, sources, geometry_, *renderer_, progress), sources);
  } catch (...) {
    for (std::size_t f = 0; f < sources.size(); ++f) set(f, old[f]);
    throw;
  }
  renderer_->prepare(resolved_.render.engine);
  return change;
}

Change Document::rebuild(Next& next, Progress* progress, Warnings& warnings) {
  GatheredScene gathered =
      gather_scene(next.scene, next.fields, particles_, next.grids, progress, warnings);
  if (progress != nullptr) progress->update("building the tree", 0);
  Renderer renderer(particles_, gathered.sources, gathered.geometry);
  warn_of_what_is_missing(particles_, gathered.sources, gathered.geometry, renderer, warnings);
  ResolvedScene resolved =
      resolve_with(next, particles_, gathered.sources, gathered.geometry, renderer, progress);
  renderer.prepare(resolved.render.engine);
  adopt(next, std::move(resolved), gathered.sources);
  sources_ = std::move(gathered.sources);
  geometry_ = std::move(gathered.geometry);
  renderer_ = std::move(renderer);
  return Change::particles;
}

Change Document::move(Next& next, Progress* progress, Warnings& warnings) {
  const ParticleSet& frame = *next.frame;
  GatheredScene gathered =
      gather_scene(next.scene, next.fields, frame, next.grids, progress, warnings);
  if (progress != nullptr) progress->update("moving the particles", 0);
  try {
    renderer_->set_particles(frame, gathered.sources, gathered.geometry);
    warn_of_what_is_missing(frame, gathered.sources, gathered.geometry, *renderer_, warnings);
    ResolvedScene resolved =
        resolve_with(next, frame, gathered.sources, gathered.geometry, *renderer_, progress);
    renderer_->prepare(resolved.render.engine);
    adopt(next, std::move(resolved), gathered.sources);
  } catch (...) {
    renderer_.emplace(particles_, sources_, geometry_);
    renderer_->prepare(resolved_.render.engine);
    throw;
  }
  sources_ = std::move(gathered.sources);
  geometry_ = std::move(gathered.geometry);
  particles_ = std::move(*next.frame);
  describe_data();
  return Change::frame;
}

ResolvedScene Document::resolve_with(const Next& next, const ParticleSet& particles,
                                     const std::vector<FieldSource>& sources,
                                     const GeometrySource& geometry, const Renderer& renderer,
                                     Progress* progress) const {
  ResolvedScene resolved = resolve(next.scene, particles, next.visible, sources, geometry,
                                   renderer.kernels(), progress, renderer.grids());
  renderer.check(resolved);
  return resolved;
}

void Document::adopt(Next& next, ResolvedScene resolved, const std::vector<FieldSource>& sources) {
  Scene filled = fill_in(next.scene, next.fields, sources, resolved);
  fill_in_colors(next.frame ? *next.frame : particles_, filled.geometry);
  std::vector<FieldInfo> fields = field_info(next.fields, sources);
  scene_ = std::move(filled);
  resolved_ = std::move(resolved);
  fields_ = std::move(next.fields);
  grids_ = std::move(next.grids);
  info_.fields = std::move(fields);
  info_.grids.clear();
  for (const LoadedGrid& loaded : grids_) {
    info_.grids.push_back({loaded.grid->name, loaded.grid->dims});
  }
}

void Document::describe_data() {
  info_.path = data_path_;
  info_.format = particles_.size() != 0 ? reader_.format() : "";
  if (info_.format.empty() && !data_path_.empty()) info_.format = grid_format(data_path_);
  info_.particles = particles_.size();
  info_.time = particles_.time;
  info_.species = species_info(particles_);
  info_.properties = property_info(particles_);
  info_.cell = particles_.cell;
  const DataExtent extent = data_extent(particles_, *renderer_, sources_);
  info_.bounds = extent.bounds;
  info_.length_unit = extent.length_unit;
}

Camera Document::fit(double aspect) const {
  Scene open = scene_;
  open.eye.reset();
  open.target.reset();
  open.up.reset();
  const std::vector<VisibleSphere> spheres =
      spheres_of_view(particles_, sources_, geometry_, visible_fields(fields_),
                      renderer_->kernels(), scene_.render.clip_planes);
  Camera camera = fit_camera(open, spheres, aspect);
  if (camera.orthographic_height) {
    const CameraAxes axes = camera_axes(camera);
    double half = 0;
    for (const VisibleSphere& sphere : spheres) {
      const Vector3d v = sphere.center - camera.target;
      half = std::max({half, std::abs(dot(v, axes.y)) + sphere.radius,
                       (std::abs(dot(v, axes.x)) + sphere.radius) / aspect});
    }
    if (half > 0) camera.orthographic_height = 2 * half;
  }
  return camera;
}

void Document::render(const Camera& camera, int width, int height, const FrameQuality& quality,
                      const std::atomic<bool>* cancel, Framebuffer& image,
                      RenderStatistics* statistics, std::vector<std::uint8_t>* tiles_done) const {
  ResolvedScene scene = resolved_;
  scene.camera = camera;
  scene.step_size *= quality.step_factor;
  scene.render.width = width;
  scene.render.height = height;
  SurfaceSettings& surface = scene.render.surface;
  surface.antialiasing = quality.antialiasing.value_or(surface.antialiasing);
  surface.occlusion_samples = quality.occlusion_samples.value_or(surface.occlusion_samples);
  surface.shadows = surface.shadows && quality.shadows;
  RenderOptions options;
  options.threads = quality.threads;
  options.cancel = cancel;
  options.tiles_done = tiles_done;
  renderer_->render(scene, options, image, statistics);
}

std::vector<Histogram> Document::histogram(const Camera& camera, int width, int height,
                                           const std::atomic<bool>* cancel) const {
  Cancellation cancellation(cancel);
  std::vector<RayProfiles> profiles;
  if (!sources_.empty()) {
    profiles =
        sample_view(renderer_->kernels(), camera, width, height, &cancellation, renderer_->grids());
  }
  std::vector<Histogram> all;
  std::size_t number = 0;  // among the visible ones
  for (const Field& field : scene_.fields) {
    all.push_back(field.visible ? histogram_of(field.name, profiles[number++].values)
                                : histogram_of(field.name, {}));
  }
  return all;
}

MemoryUse Document::memory() const {
  const KernelSet& kernels = renderer_->kernels();
  return {kernels.size(), kernels.particle_bytes(), kernels.bvh.bytes(),
          renderer_->surface_bytes()};
}

}  // namespace motes
