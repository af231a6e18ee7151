// Edits: what has to be done anew is found from what is different.
#include "document/document.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "core/error.h"
#include "render/grid_fields.h"
#include "scene/fit.h"

namespace motes {
namespace {

Kernel kernel_of(const Scene& scene, const Field& field) {
  Kernel kernel = scene.kernel;
  if (field.kernel_shape) kernel.shape = *field.kernel_shape;
  kernel.support_factor = field.support_factor.value_or(kernel.support_factor);
  kernel.kernel_scale = field.kernel_scale.value_or(kernel.kernel_scale);
  return kernel;
}

bool colored_by_species(const Field& field) {
  return std::any_of(field.isosurfaces.begin(), field.isosurfaces.end(), [](const Isosurface& s) {
    return s.color && std::holds_alternative<ColorBy>(*s.color);
  });
}

/// A scene without what is looked up frame by frame: two whose remainder is equal take the same of
/// the data, up to the scales of kernels.
Scene gathered_part(const Scene& scene) {
  Scene part;
  part.data_path = scene.data_path;
  part.types = scene.types;
  part.frame = scene.frame;
  part.geometry = scene.geometry;
  for (Field field : scene.fields) {
    if (!field.visible) continue;
    const bool by_species = colored_by_species(field);
    field.kernel_shape = kernel_of(scene, field).shape;
    field.support_factor.reset();
    field.kernel_scale.reset();
    field.transfer_function = {};
    field.isosurfaces.clear();
    if (by_species) field.isosurfaces.push_back({0, ColorBy::species, 1});
    part.fields.push_back(std::move(field));
  }
  return part;
}

std::vector<Kernel> kernels_of(const Scene& scene) {
  std::vector<Kernel> kernels;
  for (const Field& field : scene.fields) {
    if (field.visible) kernels.push_back(kernel_of(scene, field));
  }
  return kernels;
}

bool is_colored_by_fields(const Geometry& geometry) {
  const auto* by = std::get_if<ColorBy>(&geometry.color);
  return by != nullptr && *by == ColorBy::field;
}

std::set<std::filesystem::path> grid_files(const Scene& scene) {
  std::set<std::filesystem::path> files;
  for (const Field& field : scene.fields) {
    if (field.grid) files.insert(field.grid->path);
  }
  return files;
}

Renderer make_renderer(const ParticleSet& particles, const GatheredScene& gathered, Engine engine,
                       Progress* progress) {
  if (progress != nullptr) progress->update("building the tree", 0);
  Renderer renderer(particles, gathered.sources, gathered.geometry);
  renderer.prepare(engine);
  return renderer;
}

}  // namespace

Document::Document(Scene scene, Progress* progress, Warnings& warnings)
    : input_(read_input(scene, progress, warnings)),
      gathered_(gather(scene, input_.particles, input_.grids, progress, warnings)),
      renderer_(make_renderer(input_.particles, gathered_, scene.render.engine, progress)),
      resolved_(resolve(scene, gathered_, input_.particles, renderer_, progress)),
      scene_(fill_in(scene, gathered_, resolved_)) {}

Bounds3d Document::bounds() const {
  Bounds3d bounds = input_.particles.bounds();
  for (const GridField& grid : renderer_.grids()) bounds.add(grid.sampler->bounds());
  return bounds;
}

void Document::check_same_data(const Scene& next) const {
  if (next.data_path != scene_.data_path || next.types != scene_.types) {
    throw Error("data: expected the file that is open");
  }
}

Document::Work Document::work_for(const Scene& next) const {
  if (grid_files(next) != grid_files(scene_)) return Work::read_grids;
  Scene before = gathered_part(scene_), after = gathered_part(next);
  if (before.frame != after.frame) return Work::read_frame;
  if (!(before == after)) return Work::gather;
  if (kernels_of(scene_) == kernels_of(next)) return Work::resolve;
  // What balls take of their fields is gathered with them.
  return std::any_of(next.geometry.begin(), next.geometry.end(), is_colored_by_fields)
             ? Work::gather
             : Work::set_kernels;
}

void Document::set_scene(Scene next, Progress* progress, Warnings& warnings,
                         std::optional<ParticleSet> frame) {
  check_same_data(next);
  if (next.fields.empty() && next.geometry.empty()) show_grids(next);
  switch (work_for(next)) {
    case Work::resolve:
      return resolve_again(std::move(next), progress);
    case Work::set_kernels:
      return set_kernels(std::move(next), progress);
    case Work::gather:
      return gather_again(std::move(next), nullptr, progress, warnings);
    case Work::read_frame:
      if (!frame) frame = read_frame(next, next.frame, progress, warnings);
      return take_frame(std::move(next), std::move(*frame), progress, warnings);
    case Work::read_grids: {
      Input input = read_input(next, progress, warnings);
      return gather_again(std::move(next), &input, progress, warnings);
    }
  }
}

void Document::resolve_again(Scene next, Progress* progress) {
  GatheredScene gathered{expand_fields(next, input_.particles, input_.grids), {}, {}, {}};
  std::copy_if(gathered.all_fields.begin(), gathered.all_fields.end(),
               std::back_inserter(gathered.fields), [](const Field& f) { return f.visible; });
  // Colours may be asked for that make one field a species.
  if (gathered.fields.size() != gathered_.fields.size()) {
    Warnings none;
    return gather_again(std::move(next), nullptr, progress, none);
  }
  gathered.sources = std::move(gathered_.sources);
  gathered.geometry = std::move(gathered_.geometry);
  try {
    ResolvedScene resolved = resolve(next, gathered, input_.particles, renderer_, progress);
    renderer_.prepare(next.render.engine);
    scene_ = fill_in(next, gathered, resolved);
    resolved_ = std::move(resolved);
  } catch (...) {
    gathered_.sources = std::move(gathered.sources);
    gathered_.geometry = std::move(gathered.geometry);
    throw;
  }
  gathered_ = std::move(gathered);
}

void Document::set_kernels(Scene next, Progress* progress) {
  const std::vector<Kernel> before = kernels_of(scene_), after = kernels_of(next);
  const auto set = [this](const std::vector<Kernel>& kernels) {
    for (std::size_t f = 0; f < kernels.size(); ++f) {
      if (gathered_.sources[f].grid) continue;
      gathered_.sources[f].kernel = kernels[f];
      renderer_.set_kernel(f, kernels[f]);
    }
  };
  set(after);
  try {
    resolve_again(std::move(next), progress);
  } catch (...) {
    set(before);
    throw;
  }
}

void Document::gather_again(Scene next, Input* read, Progress* progress, Warnings& warnings) {
  const Input& input = read != nullptr ? *read : input_;
  GatheredScene gathered = gather(next, input.particles, input.grids, progress, warnings);
  Renderer renderer = make_renderer(input.particles, gathered, next.render.engine, progress);
  ResolvedScene resolved = resolve(next, gathered, input.particles, renderer, progress);
  scene_ = fill_in(next, gathered, resolved);
  gathered_ = std::move(gathered);
  renderer_ = std::move(renderer);
  resolved_ = std::move(resolved);
  if (read != nullptr) input_ = std::move(*read);
}

void Document::take_frame(Scene next, ParticleSet particles, Progress* progress,
                          Warnings& warnings) {
  if (particles.size() == 0) throw Error("data.frame: has no particles in this frame");
  GatheredScene gathered = gather(next, particles, input_.grids, progress, warnings);
  renderer_.set_particles(particles, gathered.sources, gathered.geometry);
  try {
    renderer_.prepare(next.render.engine);
    ResolvedScene resolved = resolve(next, gathered, particles, renderer_, progress);
    scene_ = fill_in(next, gathered, resolved);
    resolved_ = std::move(resolved);
  } catch (...) {
    renderer_.set_particles(input_.particles, gathered_.sources, gathered_.geometry);
    renderer_.prepare(scene_.render.engine);
    throw;
  }
  gathered_ = std::move(gathered);
  input_.particles = std::move(particles);
}

ParticleSet Document::read_frame(const Scene& scene, std::uint64_t frame, Progress* progress,
                                 Warnings& warnings) {
  Scene of_frame;
  of_frame.data_path = scene.data_path;
  of_frame.types = scene.types;
  of_frame.frame = frame;
  return read_particles(of_frame, progress, warnings).particles;
}

std::size_t Document::count_frames(const Scene& scene, Progress* progress) {
  if (scene.data_path.empty() || !has_particles(scene.data_path)) return 1;
  return open_trajectory(scene.data_path, {scene.types, progress, nullptr})->num_frames();
}

bool Document::render(const Camera& camera, int width, int height, Quality quality,
                      const std::atomic<bool>* cancel, Framebuffer& image,
                      RenderStatistics* statistics) const {
  ResolvedScene view;
  view.transfer_functions = resolved_.transfer_functions;
  view.isosurfaces = resolved_.isosurfaces;
  view.camera = camera;
  view.step_size = resolved_.step_size;
  view.render = resolved_.render;
  view.render.width = width;
  view.render.height = height;
  if (quality == Quality::preview) {
    constexpr int preview_occlusion = 4;
    view.render.surface.antialiasing = 1;
    view.render.surface.occlusion_samples =
        std::min(view.render.surface.occlusion_samples, preview_occlusion);
    view.render.surface.light_angle = 0;
  }
  RenderOptions options;
  options.cancel = cancel;
  return renderer_.render(view, options, image, statistics);
}

Camera Document::fit(double aspect) const {
  Scene open;
  open.fov_degrees = scene_.fov_degrees;
  open.orthographic_height = scene_.orthographic_height;
  if (open.orthographic_height) open.orthographic_height = length(bounds().diagonal());
  return fit_camera(
      open, visible_spheres(input_.particles, gathered_.sources, gathered_.geometry), aspect);
}

}  // namespace motes
