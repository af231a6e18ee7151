#include "render/renderer.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/stopwatch.h"
#include "render/balls_within.h"
#include "render/isosurface_frame.h"
#include "render/make_surface.h"
#include "render/render_tile.h"
#include "render/surface_layers.h"
#include "samples/area_buffer.h"
#include "surface/cut.h"

namespace motes {
namespace {

/// World to internal: relative to the kernels' origin, scaled.
Point3d to_internal(const KernelSet& kernels, const Point3d& p) {
  const Vector3d v = kernels.length_scale * (p - kernels.origin);
  return {v.x, v.y, v.z};
}

ClipPlane to_internal(const KernelSet& kernels, const ClipPlane& plane) {
  const Vector3d normal = normalize(plane.normal);
  const double distance = plane.distance - dot(normal, kernels.origin - Point3d{});
  return {normal, kernels.length_scale * distance};
}

std::vector<ClipPlane> clip_planes_of(const ResolvedScene& scene, const KernelSet& kernels) {
  std::vector<ClipPlane> planes;
  for (const ClipPlane& plane : scene.render.clip_planes) {
    planes.push_back(to_internal(kernels, plane));
  }
  return planes;
}

/// half_height() in internal lengths where it is a length.
double internal_half_height(const KernelSet& kernels, const Camera& camera) {
  return half_height(camera) * (camera.orthographic_height ? kernels.length_scale : 1);
}

ShadingConstants make_shading(const ResolvedScene& scene, const CameraAxes& axes,
                              const KernelSet& kernels) {
  const Lighting& lighting = scene.render.lighting;
  ShadingConstants shading;
  shading.termination_opacity = static_cast<float>(scene.render.termination_opacity);
  shading.ambient = static_cast<float>(lighting.ambient);
  shading.diffuse = static_cast<float>(lighting.diffuse);
  shading.specular = static_cast<float>(lighting.specular);
  shading.shininess = static_cast<float>(lighting.shininess);
  assert(lighting.lights.size() <= max_lights);
  for (const LightSource& light : lighting.lights) {
    LightConstants& constants = shading.lights.emplace_back();
    constants.intensity = static_cast<float>(light.intensity);
    constants.headlight = !light.direction.has_value();
    if (constants.headlight) continue;
    const Vector3d l = normalize(*light.direction);
    const Vector3d rows[3] = {axes.x, axes.y, axes.forward};
    for (int i = 0; i < 3; ++i) constants.direction[i] = static_cast<float>(dot(l, rows[i]));
  }
  for (const FieldKernels& field : kernels.fields) shading.min_radius.push_back(field.min_radius);
  return shading;
}

/// A single pass holds a whole ray, but no more than this: a buffer of 4 MiB a field and channel.
constexpr int max_single_pass = 1 << 16;

/// Refuses steps so small that a frame would never end.
void check_step(const Bounds3d& box, const ResolvedScene& scene) {
  constexpr double max_samples = 1e7;
  const double samples = length(box.diagonal()) / scene.step_size;
  if (samples > max_samples) {
    throw Error(fmt::format(
        "render.step_size: {:g} takes {:.3g} samples through the volume; expected {:g} or more",
        scene.step_size, samples, samples * scene.step_size / max_samples));
  }
  const double farthest = length(box.center() - scene.camera.eye);
  constexpr double max_index = 4503599627370496.0;  // 2^52: depths of planes are still exact
  if (farthest / scene.step_size > max_index) {
    throw Error(
        fmt::format("camera.eye: is {:g} away from the data; expected at most {:g} steps of {:g}",
                    farthest, max_index, scene.step_size));
  }
}

/// Planes are counted from the first that can meet the box.
View make_view(const CameraAxes& axes, const Point3d& eye, const Bounds3d& box, double step) {
  double nearest = std::numeric_limits<double>::max();
  for (int corner = 0; corner < 8; ++corner) {
    const Point3d p{(corner & 1 ? box.max : box.min).x, (corner & 2 ? box.max : box.min).y,
                    (corner & 4 ? box.max : box.min).z};
    nearest = std::min(nearest, dot(p - eye, axes.forward));
  }
  const double first = std::floor(std::max(nearest, 0.0) / step - 1);
  return {axes, eye, {static_cast<std::int64_t>(std::max(first, 0.0)), step}};
}

FrameContext make_context(const KernelSet& kernels, const GridFields& grids,
                          const ResolvedScene& scene, const RenderOptions& options) {
  const Bounds3d box = volume_box(kernels, grids);
  check_step(box, scene);
  const CameraAxes axes = camera_axes(scene.camera);
  FrameContext context;
  context.kernels = &kernels;
  context.width = scene.render.width;
  context.height = scene.render.height;
  context.orthographic = scene.camera.orthographic_height.has_value();
  context.half_height = internal_half_height(kernels, scene.camera);
  context.half_width = context.half_height * context.width / context.height;
  context.box = {to_internal(kernels, box.min), to_internal(kernels, box.max)};
  context.view = make_view(axes, to_internal(kernels, scene.camera.eye), context.box,
                           scene.step_size * kernels.length_scale);
  for (std::size_t f = 0; f < kernels.fields.size(); ++f) {
    context.classifiers.push_back(compile_transfer_function(
        scene.transfer_functions[f], kernels.fields[f].value_scale, scene.step_size));
    context.absolute = context.absolute || kernels.fields[f].mixed_signs;
  }
  context.grids =
      make_frame_grids(grids, kernels, context.view, scene.transfer_functions, context.classifiers);
  context.any_kernels = grids.size() < kernels.fields.size();
  context.shading = make_shading(scene, axes, kernels);
  if (!context.orthographic) {
    context.shading.max_ray_length =
        static_cast<float>(std::hypot(1, context.half_width, context.half_height));
  }
  // Without kernels engines are all the same.
  context.engine = context.any_kernels ? scene.render.engine : Engine::coherent;
  context.count_inside = options.count_inside && context.engine == Engine::sweep;
  context.gradients = scene.render.lighting.enabled && !context.count_inside;
  context.absolute = context.absolute && context.gradients;
  const int num_fields = static_cast<int>(kernels.fields.size());
  const int default_planes = context.engine == Engine::sweep ? 16
                             : num_fields == 1               ? 32
                                                             : 64 / num_fields;
  const int per_pass = options.samples_per_pass.value_or(default_planes);
  context.layers = options.layers;
  context.clip_planes = clip_planes_of(scene, kernels);
  context.shading.clipped = !context.clip_planes.empty();
  context.samples_per_pass = per_pass == 0 ? max_single_pass : per_pass;
  return context;
}

/// Pixels of a side of a tile: small ones share out well among threads; the sweep traverses the
/// tree once for all of a large one.
int tile_size_of(Engine engine) { return engine == Engine::sweep ? AreaBuffer::size : 32; }

/// Of a pixel's surfaces those within so many steps are one layer: less than the volume between
/// them shows.
constexpr double merged_steps = 0.1;

ImagePlane image_plane(const KernelSet& kernels, const ResolvedScene& scene) {
  ImagePlane plane;
  plane.half_height = internal_half_height(kernels, scene.camera);
  plane.width = scene.render.width;
  plane.height = scene.render.height;
  plane.half_width = plane.half_height * plane.width / plane.height;
  plane.samples = scene.render.surface.antialiasing;
  return plane;
}

SurfaceShading surface_shading(const KernelSet& kernels, const ResolvedScene& scene) {
  const SurfaceSettings& settings = scene.render.surface;
  SurfaceShading shading;
  shading.lighting = scene.render.lighting;
  shading.occlusion_samples = settings.occlusion_samples;
  if (settings.occlusion_distance) {
    shading.occlusion_distance = *settings.occlusion_distance * kernels.length_scale;
  }
  shading.shadows = settings.shadows;
  shading.seed = settings.seed;
  shading.light_radius = 0.5 * settings.light_angle * std::numbers::pi / 180;
  return shading;
}

SurfaceFrame frame_of(const Surface& surface, const ResolvedScene& scene) {
  const KernelSet& kernels = *surface.kernels;
  return make_surface_frame(surface,
                            {camera_axes(scene.camera), to_internal(kernels, scene.camera.eye),
                             scene.camera.orthographic_height.has_value()},
                            image_plane(kernels, scene), surface_shading(kernels, scene));
}

/// Whether ambient light is hidden from isosurfaces by what is farther away than their rays look.
/// What clip planes cut away hides none, and balls are not cut.
bool hides_far_light(const ResolvedScene& scene) {
  const SurfaceSettings& surface = scene.render.surface;
  return surface.occlusion_samples > 0 && !surface.occlusion_distance &&
         scene.render.clip_planes.empty();
}

/// Has isosurfaces hide light from themselves, and they and solids from each other; either of these
/// may be null. Where there are no solids, `within` stands for what is far. All outlive the frame.
void hide_light(ShadedIsosurfaces& isosurfaces, SurfaceFrame* solids, const Surface* within) {
  isosurfaces.light.prune = [&frame = isosurfaces.frame](const Point3d& place,
                                                         const Vector3d& normal, double length,
                                                         std::vector<Vector3f>& directions) {
    prune(frame, place, normal, length, directions);
  };
  isosurfaces.light.surface = within;
  if (solids == nullptr) return;
  isosurfaces.light.surface = solids->surface;
  solids->prune = isosurfaces.light.prune;
  solids->prune_distance = isosurfaces.light.prune_distance;
}

/// Whether nothing is seen of the fields but their isosurfaces.
bool draws_surfaces_only(const ResolvedScene& scene) {
  const auto invisible = [](const TransferFunction& function) {
    return std::all_of(function.points.begin(), function.points.end(),
                       [](const auto& point) { return point.extinction == 0; });
  };
  return !scene.isosurfaces.empty() &&
         std::all_of(scene.transfer_functions.begin(), scene.transfer_functions.end(), invisible);
}

void throw_if_cancelled(const RenderOptions& options) {
  if (options.cancel != nullptr && options.cancel->load(std::memory_order_relaxed)) {
    throw Cancelled();
  }
}

/// Calls work(tile) for all tiles of the image, in parallel, unless the frame is cancelled.
template <class Work>
void for_tiles(const ResolvedScene& scene, const RenderOptions& options, int tile_size,
               const Work& work) {
  const int width = scene.render.width, height = scene.render.height;
  const int columns = (width + tile_size - 1) / tile_size;
  const int rows = (height + tile_size - 1) / tile_size;
  const int machine = tbb::info::default_concurrency();
  const int threads = options.threads > 0 ? options.threads : machine;
  const int tiles = columns * rows;
  std::vector<std::uint8_t> own;
  std::vector<std::uint8_t>& tile_done = options.tiles_done != nullptr ? *options.tiles_done : own;
  if (tile_done.empty()) tile_done.assign(static_cast<std::size_t>(tiles), 0);
  assert(tile_done.size() == static_cast<std::size_t>(tiles));
  auto done = std::count(tile_done.begin(), tile_done.end(), 1);
  std::mutex mutex;
  // TBB starts no more threads than the machine has, unless it is told to.
  const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism,
                                        static_cast<std::size_t>(std::max(threads, machine)));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(0, tiles, [&](int i) {
      std::uint8_t& this_done = tile_done[static_cast<std::size_t>(i)];
      if (this_done != 0) return;
      throw_if_cancelled(options);
      const int x = i % columns * tile_size, y = i / columns * tile_size;
      work(Tile{x, y, std::min(tile_size, width - x), std::min(tile_size, height - y)});
      const std::lock_guard lock(mutex);
      this_done = 1;
      ++done;
      if (options.progress != nullptr) {
        options.progress->update("rendering", static_cast<double>(done) / tiles);
      }
    });
  });
}

bool any_colored(const std::vector<FieldSource>& fields) {
  return std::any_of(fields.begin(), fields.end(),
                     [](const FieldSource& field) { return field.colored_by_species; });
}

/// A picture of surfaces alone, or of nothing.
void draw_surfaces(const FrameSurfaces& surfaces, const ResolvedScene& scene,
                   const RenderOptions& options, Framebuffer& image, StageTicks& stages) {
  const bool goes_on = options.tiles_done != nullptr && !options.tiles_done->empty();
  if (!goes_on) std::fill(image.rgba.begin(), image.rgba.end(), 0.0f);
  if (!surfaces.any()) return;
  StageClock clock(stages);
  for_tiles(scene, options, AreaBuffer::size, [&](const Tile& tile) {
    static thread_local TileLayers layers;
    find_layers(surfaces, 0, tile, layers);
    composite_layers(layers, tile, image);
  });
  clock.lap(Stage::setup);
}

}  // namespace

Renderer::Renderer(const ParticleSet& particles, const std::vector<FieldSource>& fields) {
  GeometrySource nothing;
  *this = Renderer(particles, fields, nothing);
}

Renderer::Renderer(const ParticleSet& particles, const std::vector<FieldSource>& fields,
                   GeometrySource& geometry) {
  const Stopwatch stopwatch;
  if (geometry.empty() && !any_colored(fields)) {
    grids_ = make_grid_fields(fields);
    *kernels_ = build_kernel_set(particles, fields);
    set_units(grids_, *kernels_);
  } else {
    build(particles, fields, geometry);
    order_ = {};
  }
  build_ms_ = stopwatch.milliseconds();
}

void Renderer::build(const ParticleSet& particles, const std::vector<FieldSource>& fields,
                     GeometrySource& geometry) {
  surface_.reset();
  field_values_ = {};
  *kernels_ = {};  // its memory is free before the new one needs it
  grids_ = make_grid_fields(fields);
  const auto build_from = [&](const std::vector<FieldSource>& sources) {
    const bool any_drawn = !geometry.empty();
    const std::vector<bool> is_drawn = pack_index(geometry, particles.size());
    *kernels_ = build_kernel_set(particles, sources, &order_);
    species_ = species_of_kernels(particles, sources, order_);
    set_units(grids_, *kernels_);
    if (!any_drawn) return;
    surface_ =
        make_surface(particles, geometry, is_drawn, sources, order_, *kernels_, field_values_);
    unpack_index(is_drawn, geometry);
  };
  std::optional<FieldSource> drawn_only = find_drawn_only(particles, geometry, fields);
  if (!drawn_only) return build_from(fields);
  std::vector<FieldSource> sources = fields;
  sources.push_back(std::move(*drawn_only));
  build_from(sources);
}

TreeUpdate Renderer::set_particles(const ParticleSet& particles,
                                   const std::vector<FieldSource>& fields) {
  GeometrySource nothing;
  return set_particles(particles, fields, nothing);
}

TreeUpdate Renderer::set_particles(const ParticleSet& particles,
                                   const std::vector<FieldSource>& fields,
                                   GeometrySource& geometry) {
  const Stopwatch stopwatch;
  cells_.reset();
  TreeUpdate update = TreeUpdate::refitted;
  const bool any_grids = std::any_of(
      fields.begin(), fields.end(), [](const FieldSource& field) { return field.grid != nullptr; });
  if (!geometry.empty() || surface_ || any_grids || !grids_.empty() || any_colored(fields) ||
      !refit_kernel_set(particles, fields, order_, *kernels_)) {
    update = TreeUpdate::rebuilt;
    build(particles, fields, geometry);
  }
  build_ms_ = stopwatch.milliseconds();
  return update;
}

void Renderer::check(const ResolvedScene& scene) const {
  camera_axes(scene.camera);
  if (!kernels_->fields.empty()) check_step(volume_box(*kernels_, grids_), scene);
}

void Renderer::prepare(Engine engine) {
  if (engine == Engine::cells && !cells_ && kernels_->size() != 0) {
    cells_ = build_cell_grid(*kernels_);
  }
}

void Renderer::set_kernel(std::size_t field, const Kernel& kernel) {
  cells_.reset();
  assert(field < kernels_->fields.size());
  kernels_->fields[field].set_kernel(kernel);
}

void Renderer::render_volume(const ResolvedScene& scene, const RenderOptions& options,
                             FrameContext& context, Framebuffer& image, TileCounts& all) const {
  std::optional<CellGrid> own_cells;
  if (context.engine == Engine::cells) {
    if (!cells_) own_cells = build_cell_grid(*kernels_);
    context.cells = cells_ ? &*cells_ : &*own_cells;
  }
  std::mutex mutex;
  for_tiles(scene, options, tile_size_of(context.engine), [&](const Tile& tile) {
    const TileCounts counts = render_tile(context, tile, image);
    const std::lock_guard lock(mutex);
    all.add(counts);
  });
}

Framebuffer Renderer::render(const ResolvedScene& scene, const RenderOptions& options,
                             RenderStatistics* statistics) const {
  Framebuffer image;
  render(scene, options, image, statistics);
  return image;
}

void Renderer::render(const ResolvedScene& scene, const RenderOptions& options, Framebuffer& image,
                      RenderStatistics* statistics) const {
  assert(scene.transfer_functions.size() == kernels_->fields.size());
  assert(scene.step_size > 0);
  const std::string target = instruction_set();
  const Stopwatch stopwatch;
  if (image.width != scene.render.width || image.height != scene.render.height) {
    image = Framebuffer(scene.render.width, scene.render.height);
  }
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  TileCounts all;
  std::optional<Surface> cut_surface;
  if (surface_ && !scene.render.clip_planes.empty()) {
    cut_surface = cut(*surface_, clip_planes_of(scene, *kernels_));
  }
  std::optional<SurfaceColors> field_colors;
  if (!field_values_.empty()) {
    field_colors = color_by_fields(surface_->colors, field_values_, scene.transfer_functions);
  }
  std::optional<SurfaceFrame> solids;
  throw_if_cancelled(options);
  FrameSurfaces surfaces;
  if (surface_) {
    solids = frame_of(cut_surface ? *cut_surface : *surface_, scene);
    solids->colors = field_colors ? &*field_colors : &surface_->colors;
    surfaces.solids = &*solids;
  }
  if (kernels_->fields.empty() || (kernels_->size() == 0 && grids_.empty())) {
    draw_surfaces(surfaces, scene, options, image, all.stages);
  } else {
    FrameContext context = make_context(*kernels_, grids_, scene, options);
    std::optional<ShadedIsosurfaces> isosurfaces;
    std::optional<Surface> within;
    if (!scene.isosurfaces.empty()) {
      isosurfaces = make_isosurfaces(scene, context, grids_, image_plane(*kernels_, scene),
                                     surface_shading(*kernels_, scene), species_);
      surfaces.isosurfaces = &*isosurfaces;
      if (!solids && hides_far_light(scene)) within = balls_within(*kernels_, scene.isosurfaces);
      hide_light(*isosurfaces, solids ? &*solids : nullptr, within ? &*within : nullptr);
    }
    if (surfaces.any() && !context.layers) {
      const double thickness = merged_steps * context.view.planes.step;
      context.layers = [&surfaces, thickness](const Tile& tile, TileLayers& out) {
        find_layers(surfaces, thickness, tile, out);
      };
    }
    if (draws_surfaces_only(scene)) {
      draw_surfaces(surfaces, scene, options, image, all.stages);
    } else {
      render_volume(scene, options, context, image, all);
    }
  }
  if (statistics != nullptr) {
    *statistics = {stopwatch.milliseconds(),
                   all.samples,
                   all.kernel_evaluations,
                   all.stages,
                   threads,
                   std::string(name_of(scene.render.engine)),
                   target,
                   all.evaluations_inside};
  }
}

}  // namespace motes
