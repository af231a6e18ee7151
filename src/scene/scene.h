// The scene: everything that a picture needs besides the particles, as checked plain data.
//
// Scene is what a scene file says; what it leaves open is nullopt and is filled in from the data.
// ResolvedScene has nothing open: it is what the engines and the reference take.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/report.h"
#include "particles/grid.h"
#include "particles/particle_set.h"
#include "scene/camera.h"
#include "scene/clip_plane.h"
#include "scene/geometry.h"
#include "scene/isosurface.h"
#include "scene/kernel.h"
#include "scene/selection.h"
#include "scene/transfer_function.h"

namespace motes {

/// A number for all particles, or the name of a property.
using NumberOrProperty = std::variant<double, std::string>;

/// The name that is no colour map but stands for the display colours of species.
inline constexpr std::string_view species_colors = "species";

/// A built-in colour map, or species_colors, whose range, extinction and scale may be left to the
/// data.
struct NamedTransferFunction {
  std::string name;
  std::optional<std::pair<double, double>> range;
  std::optional<double> extinction;
  std::optional<bool> log_scale;
  bool operator==(const NamedTransferFunction&) const = default;
};

/// More than this no engine takes.
inline constexpr std::size_t max_fields = 64;
inline constexpr std::size_t max_clip_planes = 16;

/// What a field is that is a grid.
struct FieldGrid {
  std::filesystem::path path;  ///< empty: the scene's data
  std::string array;           ///< of the file's; empty: all of them, one field each
  Reconstruction interpolation = Reconstruction::trilinear;
  bool operator==(const FieldGrid&) const = default;
};
/// Throws Error for an unknown name.
Reconstruction interpolation_from_name(std::string_view name);
std::string_view name_of(Reconstruction interpolation);

/// A field of particles, or, with `grid`, of a grid, which has none of what concerns particles:
/// `select`, `radius`, `weight`, `normalise` and kernels.
struct Field {
  std::string name;
  /// False: neither drawn nor gathered, but there to be shown again.
  bool visible = true;
  std::optional<FieldGrid> grid;
  Selection select;
  std::optional<NumberOrProperty> radius;  ///< nullopt: particles' default radii
  std::optional<NumberOrProperty> weight;  ///< nullopt: 1, or what the data suggest
  /// Divide by the truncated kernel's integral; nullopt: as the data suggest.
  std::optional<bool> normalise;
  // nullopt: the scene's kernel.
  std::optional<double> support_factor, kernel_scale;
  std::optional<KernelShape> kernel_shape;
  std::variant<std::monostate, TransferFunction, NamedTransferFunction> transfer_function;
  std::vector<Isosurface> isosurfaces;
  /// Of a grid: its isosurfaces are those that its values suggest; see expand_fields().
  bool fitted_isosurfaces = false;
  bool operator==(const Field&) const = default;

  /// Where there are isosurfaces, only if a transfer function says how.
  bool draws_volume() const {
    const bool has_isosurfaces = !isosurfaces.empty() || fitted_isosurfaces;
    return !has_isosurfaces || !std::holds_alternative<std::monostate>(transfer_function);
  }
};

/// A light that is infinitely far away.
struct LightSource {
  std::optional<Vector3d> direction;  ///< towards the light, world axes; nullopt: headlight
  double intensity = 1;               ///< from 0 to max_intensity
  bool operator==(const LightSource&) const = default;
};

inline constexpr std::size_t max_lights = 8;
inline constexpr double max_intensity = 1e6;

struct Lighting {
  bool enabled = true;
  double ambient = 0.3, diffuse = 0.7, specular = 0.2, shininess = 32;
  std::vector<LightSource> lights = {{}};  ///< at most max_lights; their light adds up
  bool operator==(const Lighting&) const = default;
};

enum class Engine { sweep, coherent, direct, cells };
/// Throws Error for an unknown name.
Engine engine_from_name(std::string_view name);
std::string_view name_of(Engine engine);

/// How balls and sticks are lit and drawn besides the lighting of the scene (docs/surface.md).
struct SurfaceSettings {
  int antialiasing = 3;        ///< n x n rays a pixel
  int occlusion_samples = 16;  ///< rays a pixel; 0: no ambient occlusion
  std::optional<double>
      occlusion_distance;  ///< what is farther away occludes nothing; file's length
  bool shadows = true;     ///< of lights that have a direction
  double light_angle = 3;  ///< how large the light is seen, degrees; 0: hard shadows
  std::uint32_t seed = 0;  ///< of the directions in which light is looked for
  bool operator==(const SurfaceSettings&) const = default;
};

struct RenderSettings {
  int width = 1024, height = 1024;
  std::optional<double> step_size;  ///< length; nullopt: from the radii
  double termination_opacity = 0.97;
  Lighting lighting;
  SurfaceSettings surface;
  std::vector<ClipPlane> clip_planes;  ///< of the data what none of them cuts away is drawn
  Color background;
  Engine engine = Engine::sweep;
  bool operator==(const RenderSettings&) const = default;
};

struct Scene {
  std::filesystem::path data_path;  ///< empty: none, all fields are grids with files of their own
  std::uint64_t frame = 0;
  std::map<int, std::string> types;
  std::optional<Point3d> eye, target;  ///< nullopt: fitted to the data
  std::optional<Vector3d> up;
  std::optional<double> fov_degrees, orthographic_height;
  Kernel kernel;
  /// Empty: none if there is geometry, else one of all particles, or as the data suggest.
  std::vector<Field> fields;
  std::vector<Geometry> geometry;
  RenderSettings render;
  bool operator==(const Scene&) const = default;
};

/// A grid that has been read for a scene.
struct LoadedGrid {
  std::filesystem::path path;  ///< as in FieldGrid
  std::shared_ptr<const Grid> grid;
};

/// What a field is drawn in where the scene says no more.
struct FieldColors {
  /// Display colour of the species that most of the field's particles are; of a grid one of its
  /// own.
  Color own;
  /// Of values of both signs.
  Color positive, negative;
  /// Its own rather than a colour map, as the scene has several such fields to tell apart.
  bool prefers_own = false;
};
/// Of a scene's grid with that number; of number 0 what is for both signs is for particles too.
FieldColors colors_of_grid(std::size_t number);

/// The particles of one field with all that its kernels need, checked: positions are finite, radii
/// finite and > 0, weights finite. Particles that fail are left out, with a warning that counts
/// them. Or the field's grid, and no particles.
struct FieldSource {
  std::string name;
  std::shared_ptr<const Grid> grid;                          ///< null: a field of particles
  Reconstruction interpolation = Reconstruction::trilinear;  ///< of the grid
  Kernel kernel;
  bool normalise = false;
  std::vector<std::uint32_t> index;  ///< into the ParticleSet, increasing
  /// What the kernel's shape takes, of Gaussians standard deviations; file's length unit; one an
  /// index, or one for all.
  std::vector<float> radius;
  std::vector<float> weight;        ///< one an index, or one for all
  bool colored_by_species = false;  ///< isosurfaces ask for the kernels' species
  FieldColors colors = colors_of_grid(0);
  /// No field: particles that the tree has only since they are drawn. The last of the sources.
  bool drawn_only = false;

  float radius_of(std::size_t i) const { return radius[radius.size() == 1 ? 0 : i]; }
  /// Standard deviation of the kernel's shape: how wide the particle looks.
  double width_of(std::size_t i) const { return kernel.standard_deviation() * radius_of(i); }
  float weight_of(std::size_t i) const { return weight[weight.size() == 1 ? 0 : i]; }
};

struct ResolvedScene {
  std::vector<FieldSource> fields;
  std::vector<TransferFunction> transfer_functions;  ///< one a field
  std::vector<ResolvedIsosurface> isosurfaces;       ///< of all fields
  Camera camera;
  double step_size = 0;
  RenderSettings render;
};

/// What the file of a scene's data has.
struct DataContents {
  bool particles = true, grids = false;
};
/// Looks at the file of that path; a path may be empty.
using LookAtData = std::function<DataContents(const std::filesystem::path&)>;

/// Reads a scene file (docs/scene.md); relative paths are relative to it. Throws Error that names
/// the file, the line where JSON itself is broken or the key ("fields[0].radius"), and what was
/// expected; an unknown key names the nearest known one.
/// What a style comes to is up to what `look` says of the data, which is called for nothing else;
/// without it they are particles.
Scene read_scene(const std::filesystem::path& path, const LookAtData& look = {});
/// The same from text; `path` is for messages and for relative paths.
Scene parse_scene(std::string_view json, const std::filesystem::path& path,
                  const LookAtData& look = {});
/// Whether `path` is a scene file, by its content or its name, and not a file of particles.
bool is_scene_file(const std::filesystem::path& path);
/// Reads what a field's "transfer_function" may be from a file of its own. Throws Error.
std::variant<std::monostate, TransferFunction, NamedTransferFunction> read_transfer_function(
    const std::filesystem::path& path);
/// Scene as JSON that read_scene() reads back to an equal Scene; data_path relative to `directory`.
std::string scene_to_json(const Scene& scene, const std::filesystem::path& directory);

/// Gives a scene whose one field takes all particles and has no transfer function (or that has no
/// field) the species' colours, where all species are elements, two to eight different ones, and no
/// particle has a size of its own: for molecules and solids, not for densities.
void color_by_species(Scene& scene, const ParticleSet& particles);

/// The fields that a scene comes to with these particles and grids: one of all particles where it
/// has none; a field with species_colors and several species becomes one field a species, and one
/// of a file with several grids, if it does not say which, one field a grid, of which only the
/// first of both signs is visible; all have names. Fitted isosurfaces become those at the level
/// that encloses 85 % of what the grid stands for (enclosing_level()): opaque, one, or where values
/// are of both signs one of each sign. Throws Error, which names the key ("fields[1].radius: what")
/// where a field asks for species, properties or grids that the data do not have.
std::vector<Field> expand_fields(const Scene& scene, const ParticleSet& particles,
                                 const std::vector<LoadedGrid>& grids = {});

/// The kernel of a field of particles; `kernel` is the scene's.
Kernel kernel_of(const Field& field, const Kernel& kernel);

/// Those that are drawn.
std::vector<Field> visible_fields(const std::vector<Field>& fields);

/// The particles, radii and weights of each field. `kernel` is the scene's. Defaults: radius is
/// such that the kernel's standard deviation is the particles' own size (has_sizes()), else the
/// species' covalent radii, else half the mean distance of neighbours, but 1 for a table; weight 1.
/// Where the field gives neither and the particles have sizes of their own, `normalise` is on and
/// the weight is "mass" if there is one: a density of mass or number. Reports `progress` where
/// neighbours have to be found. Throws Error for unknown properties and where no particle is left.
/// Fields that are grids share those of `grids`.
std::vector<FieldSource> make_field_sources(const ParticleSet& particles,
                                            const std::vector<Field>& fields, const Kernel& kernel,
                                            Warnings& warnings, Progress* progress = nullptr,
                                            const std::vector<LoadedGrid>& grids = {});

}  // namespace motes
