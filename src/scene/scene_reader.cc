// Scene files in: JSON -> Scene, every value checked (docs/scene.md).
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "core/error.h"
#include "scene/checked_json.h"
#include "scene/geometry_json.h"
#include "scene/isosurface_json.h"
#include "scene/lighting_json.h"
#include "scene/scene.h"
#include "scene/style.h"

namespace motes {
namespace {

using nlohmann::json;
using Value = CheckedJson;

constexpr int max_image_side = 16384;
constexpr std::size_t max_points = 65536;

/// "linear" or "log".
bool read_scale(const Value& value) {
  const std::string scale = value.text("\"linear\" or \"log\"");
  if (scale != "linear" && scale != "log") value.expected("\"linear\" or \"log\"");
  return scale == "log";
}

std::string read_map_name(const Value& value) {
  std::string name = value.text("the name of a colour map");
  std::vector<std::string> names = color_map_names();
  names.emplace_back(species_colors);
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    value.fail(unknown_name("colour map", name, names).what());
  }
  return name;
}

NamedTransferFunction read_named_transfer_function(const Value& value) {
  value.check_keys({"name", "range", "extinction", "scale"});
  NamedTransferFunction named;
  named.name = read_map_name(value.at("name"));
  value.with("scale", [&](const Value& v) { named.log_scale = read_scale(v); });
  value.with("extinction", [&](const Value& v) { named.extinction = v.number_from_zero(); });
  value.with("range", [&](const Value& v) {
    const auto ends = v.array_of(2, "an array of two numbers, low and high");
    named.range = {ends[0].number(), ends[1].number()};
    if (!(named.range->first < named.range->second)) v.fail("expected low < high");
    if (named.log_scale.value_or(false) && !(named.range->first > 0)) {
      ends[0].expected("a number greater than 0, as the scale is logarithmic");
    }
  });
  return named;
}

TransferFunction read_points(const Value& value) {
  value.check_keys({"points", "scale"});
  TransferFunction function;
  value.with("scale", [&](const Value& v) { function.log_scale = read_scale(v); });
  const Value points = value.at("points");
  const auto items = points.array("an array of points");
  if (items.empty() || items.size() > max_points) {
    points.expected(fmt::format("an array of 1 to {} points", max_points));
  }
  for (const Value& item : items) {
    item.check_keys({"value", "color", "extinction"});
    TransferFunction::Point point;
    point.value = item.at("value").number();
    point.color = item.at("color").color();
    point.extinction = item.at("extinction").number_from_zero();
    if (function.log_scale && !(point.value > 0)) {
      item.at("value").expected("a number greater than 0, as the scale is logarithmic");
    }
    if (!function.points.empty() && !(point.value > function.points.back().value)) {
      item.at("value").expected(fmt::format("a number greater than the point's before, {}",
                                            function.points.back().value));
    }
    function.points.push_back(point);
  }
  return function;
}

decltype(Field::transfer_function) read_transfer_function(const Value& value) {
  if (value.raw().is_string()) {
    NamedTransferFunction named;
    named.name = read_map_name(value);
    return named;
  }
  if (value.raw().is_object() && value.has("name")) return read_named_transfer_function(value);
  if (value.raw().is_object() && value.has("points")) return read_points(value);
  if (!value.raw().is_object()) {
    value.expected("an object with \"points\" or \"name\", or the name of a colour map");
  }
  value.check_keys({"points", "name", "range", "extinction", "scale"});
  value.expected("the key \"points\" or \"name\"");
}

NumberOrProperty read_number_or_property(const Value& value, bool positive) {
  const char* what = positive ? "a number greater than 0 or the name of a property"
                              : "a number or the name of a property";
  if (value.raw().is_string()) return value.text(what);
  if (!value.raw().is_number()) value.expected(what);
  const double number = value.number();
  // Kernels are evaluated in single precision, so it must be neither 0 nor infinite there.
  const float single = static_cast<float>(number);
  if (!std::isfinite(single) || (positive && !(single > 0))) value.expected(what);
  return number;
}

/// What a "kernel" says.
struct KernelChoice {
  std::optional<double> support_factor, kernel_scale;
  std::optional<KernelShape> shape;
};

KernelShape read_shape(const Value& value, const std::filesystem::path& directory) {
  KernelShape shape;
  const Value type = value.at("type");
  try {
    shape.type = kernel_type_from_name(type.text("the name of a kernel"));
  } catch (const Error& error) {
    type.fail(error.what());
  }
  if (shape.type != KernelType::tabulated) return shape;
  const Value path = value.at("path");
  try {
    shape.profile =
        read_radial_profile((directory / path.text("the path of a table")).lexically_normal());
  } catch (const Error& error) {
    path.fail(error.what());
  }
  return shape;
}

[[noreturn]] void fail_support_factor(const Value& kernel) {
  kernel.at("support_factor")
      .fail("only a gaussian has one: other kernels end where their definition says");
}

KernelChoice read_kernel(const Value& value, const std::filesystem::path& directory) {
  value.check_keys({"type", "support_factor", "kernel_scale", "path"});
  KernelChoice kernel;
  value.with("support_factor", [&](const Value& v) { kernel.support_factor = v.number_above(0); });
  value.with("kernel_scale", [&](const Value& v) { kernel.kernel_scale = v.number(); });
  if (value.has("type")) kernel.shape = read_shape(value, directory);
  const KernelType type = kernel.shape.value_or(KernelShape{}).type;
  if (kernel.support_factor && type != KernelType::gaussian) {
    fail_support_factor(value);
  }
  if (value.has("path") && type != KernelType::tabulated) {
    value.at("path").fail("expected none, or \"type\": \"tabulated\"");
  }
  return kernel;
}

FieldGrid read_grid(const Value& value, const std::filesystem::path& directory) {
  const auto path_in = [&](const Value& v) {
    return (directory / v.text("the path of a grid")).lexically_normal();
  };
  FieldGrid grid;
  if (value.raw().is_string()) {
    grid.path = path_in(value);
    return grid;
  }
  if (!value.raw().is_object()) {
    value.expected("the path of a grid, or an object with \"path\", \"array\", \"interpolation\"");
  }
  value.check_keys({"path", "array", "interpolation"});
  value.with("path", [&](const Value& v) { grid.path = path_in(v); });
  value.with("array", [&](const Value& v) { grid.array = v.text("the name of a grid"); });
  value.with("interpolation", [&](const Value& v) {
    try {
      grid.interpolation = interpolation_from_name(v.text("the name of an interpolation"));
    } catch (const Error& error) {
      v.fail(error.what());
    }
  });
  return grid;
}

Field read_field(const Value& value, const std::filesystem::path& directory) {
  value.check_keys({"name", "visible", "grid", "select", "radius", "weight", "normalise", "kernel",
                    "transfer_function", "isosurfaces"});
  Field field;
  value.with("grid", [&](const Value& grid) {
    field.grid = read_grid(grid, directory);
    for (const char* key : {"select", "radius", "weight", "normalise", "kernel"}) {
      value.with(key, [](const Value& v) {
        v.fail("is for fields of particles; expected none, as the field is a grid");
      });
    }
  });
  value.with("name", [&](const Value& v) { field.name = v.text("a name"); });
  value.with("visible", [&](const Value& v) { field.visible = v.boolean(); });
  value.with("select", [&](const Value& v) { field.select = read_selection(v); });
  value.with("radius", [&](const Value& v) { field.radius = read_number_or_property(v, true); });
  value.with("weight", [&](const Value& v) { field.weight = read_number_or_property(v, false); });
  value.with("normalise", [&](const Value& v) { field.normalise = v.boolean(); });
  value.with("kernel", [&](const Value& v) {
    const KernelChoice kernel = read_kernel(v, directory);
    field.support_factor = kernel.support_factor;
    field.kernel_scale = kernel.kernel_scale;
    field.kernel_shape = kernel.shape;
  });
  value.with("transfer_function",
             [&](const Value& v) { field.transfer_function = read_transfer_function(v); });
  value.with("isosurfaces", [&](const Value& v) {
    if (v.raw().is_string()) {
      if (v.raw() != fitted_isosurfaces) v.expected("\"fitted\" or an array of isosurfaces");
      if (!field.grid) v.fail("only those of grids are fitted; expected an array of isosurfaces");
      field.fitted_isosurfaces = true;
      return;
    }
    field.isosurfaces = read_isosurfaces(v);
    const auto is_by_particles = [](const Isosurface& isosurface) {
      return isosurface.color && std::holds_alternative<ColorBy>(*isosurface.color);
    };
    if (field.grid &&
        std::any_of(field.isosurfaces.begin(), field.isosurfaces.end(), is_by_particles)) {
      v.fail("has a colour by particles; expected a colour of its own, as the field is a grid");
    }
  });
  return field;
}

void read_fields(const Value& value, const std::filesystem::path& directory, Scene& scene) {
  const auto items = value.array("an array of fields");
  if (items.size() > max_fields) {
    value.expected(fmt::format("an array of at most {} fields", max_fields));
  }
  std::set<std::string> names;
  for (const Value& item : items) {
    scene.fields.push_back(read_field(item, directory));
    const std::string& name = scene.fields.back().name;
    if (!name.empty() && !names.insert(name).second) {
      item.at("name").expected("a name that no other field has");
    }
  }
}

void read_data(const Value& value, const std::filesystem::path& directory, Scene& scene) {
  value.check_keys({"path", "frame", "types"});
  value.with("path", [&](const Value& v) {
    scene.data_path = (directory / v.text("the path of a file")).lexically_normal();
  });
  value.with("frame", [&](const Value& v) {
    scene.frame = v.integer(0, std::numeric_limits<std::uint64_t>::max());
  });
  value.with("types", [&](const Value& types) {
    if (!types.raw().is_object()) types.expected("an object such as {\"1\": \"Si\"}");
    for (const auto& item : types.raw().items()) {
      const std::string& number = item.key();
      int type = 0;
      const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), type);
      if (error != std::errc{} || end != number.data() + number.size() || type < 0 ||
          number != std::to_string(type)) {
        types.fail(fmt::format("expected whole numbers as keys, found '{}'", printable(number)));
      }
      const Value name(item.value(), fmt::format("{}.{}", types.key(), number));
      scene.types[type] = name.text("the name of a species");
    }
  });
}

void read_camera(const Value& value, Scene& scene) {
  value.check_keys({"eye", "target", "up", "fov", "orthographic"});
  value.with("eye", [&](const Value& v) { scene.eye = Point3d(v.vector()); });
  value.with("target", [&](const Value& v) { scene.target = Point3d(v.vector()); });
  value.with("up", [&](const Value& v) {
    scene.up = v.vector();
    if (!(length(*scene.up) > 0)) v.fail("a direction must not be zero");
  });
  value.with("fov", [&](const Value& v) {
    constexpr const char* what = "an angle in degrees greater than 0 and less than 180";
    if (!v.raw().is_number() || !(v.number() > 0 && v.number() < 180)) v.expected(what);
    scene.fov_degrees = v.number();
  });
  value.with("orthographic",
             [&](const Value& v) { scene.orthographic_height = v.number_above(0); });
  if (scene.fov_degrees && scene.orthographic_height) {
    value.fail("expected either fov or orthographic, found both");
  }
  if (scene.eye && scene.target && *scene.eye == *scene.target) {
    value.fail("expected two different points as eye and target");
  }
}

ClipPlane read_clip_plane(const Value& value) {
  value.check_keys({"normal", "distance"});
  ClipPlane plane;
  const Value normal = value.at("normal");
  plane.normal = normal.vector();
  if (!(length(plane.normal) > 0)) normal.fail("a direction must not be zero");
  value.with("distance", [&](const Value& v) { plane.distance = v.number(); });
  return plane;
}

void read_render(const Value& value, RenderSettings& render) {
  value.check_keys({"size", "step_size", "termination_opacity", "lighting", "surface",
                    "clip_planes", "background", "engine"});
  value.with("size", [&](const Value& v) {
    const auto sides = v.array_of(2, "an array of two whole numbers, width and height");
    render.width = static_cast<int>(sides[0].integer(1, max_image_side));
    render.height = static_cast<int>(sides[1].integer(1, max_image_side));
  });
  value.with("step_size", [&](const Value& v) { render.step_size = v.number_above(0); });
  value.with("termination_opacity", [&](const Value& v) {
    if (!v.raw().is_number() || !(v.number() > 0 && v.number() <= 1)) {
      v.expected("a number greater than 0 and not more than 1");
    }
    render.termination_opacity = v.number();
  });
  value.with("lighting", [&](const Value& v) { render.lighting = read_lighting(v); });
  value.with("surface", [&](const Value& v) { render.surface = read_surface_settings(v); });
  value.with("clip_planes", [&](const Value& v) {
    render.clip_planes = v.few<ClipPlane>("planes", max_clip_planes, read_clip_plane);
  });
  value.with("background", [&](const Value& v) {
    const Color color = render.background = v.color();
    if (std::max({color.r, color.g, color.b}) > 1) {
      v.expected("\"black\", \"white\", \"#rrggbb\" (sRGB) or [r, g, b] (linear, each in [0, 1])");
    }
  });
  value.with("engine", [&](const Value& v) {
    try {
      render.engine = engine_from_name(v.text("the name of an engine"));
    } catch (const Error& error) {
      v.fail(error.what());
    }
  });
}

/// Fields whose kernel is the scene's may say where it ends only if it is a Gaussian.
void check_support_factors(const Value& fields, const Scene& scene) {
  if (scene.kernel.shape.type == KernelType::gaussian) return;
  const auto items = fields.array("an array of fields");
  for (std::size_t f = 0; f < items.size(); ++f) {
    if (scene.fields[f].support_factor && !scene.fields[f].kernel_shape) {
      fail_support_factor(items[f].at("kernel"));
    }
  }
}

/// Scenes may do without data only where all that they show is grids in files of their own.
void check_data_path(const Value& root, const Scene& scene) {
  const bool needs_data =
      scene.fields.empty() || !scene.geometry.empty() ||
      std::any_of(scene.fields.begin(), scene.fields.end(),
                  [](const Field& field) { return !field.grid || field.grid->path.empty(); });
  if (needs_data && scene.data_path.empty()) root.at("data").at("path");
}

/// After fields and geometry.
void read_style(const Value& value, const LookAtData& look, Scene& scene) {
  const std::string name = value.text("the name of a style");
  if (!scene.geometry.empty()) value.fail("expected either a style or geometry, found both");
  try {
    check_fields_of_style(name, scene.fields);
  } catch (const Error& error) {
    value.fail(error.what());
  }
  apply_style(name, scene,
              look ? look(scene.data_path) : DataContents{.particles = !scene.data_path.empty()});
}

Scene read_root(const json& root, const std::filesystem::path& directory, const LookAtData& look) {
  const Value value(root, "");
  value.check_keys(
      {"version", "data", "camera", "kernel", "fields", "geometry", "style", "render"});
  const Value version = value.at("version");
  if (version.raw() != json(1)) version.expected("1, the only version there is");
  Scene scene;
  value.with("data", [&](const Value& v) { read_data(v, directory, scene); });
  value.with("camera", [&](const Value& v) { read_camera(v, scene); });
  value.with("kernel", [&](const Value& v) {
    KernelChoice kernel = read_kernel(v, directory);
    scene.kernel.support_factor = kernel.support_factor.value_or(scene.kernel.support_factor);
    scene.kernel.kernel_scale = kernel.kernel_scale.value_or(scene.kernel.kernel_scale);
    scene.kernel.shape = std::move(kernel.shape).value_or(KernelShape{});
  });
  value.with("fields", [&](const Value& v) {
    read_fields(v, directory, scene);
    check_support_factors(v, scene);
  });
  value.with("geometry", [&](const Value& v) { scene.geometry = read_geometry(v); });
  value.with("style", [&](const Value& v) { read_style(v, look, scene); });
  value.with("render", [&](const Value& v) { read_render(v, scene.render); });
  check_data_path(value, scene);
  return scene;
}

}  // namespace

Engine engine_from_name(std::string_view name) {
  if (name == "sweep") return Engine::sweep;
  if (name == "coherent") return Engine::coherent;
  if (name == "direct") return Engine::direct;
  if (name == "cells") return Engine::cells;
  throw unknown_name("engine", name, {"sweep", "coherent", "direct", "cells"});
}

Reconstruction interpolation_from_name(std::string_view name) {
  if (name == "trilinear") return Reconstruction::trilinear;
  if (name == "tricubic") return Reconstruction::tricubic;
  if (name == "tricubic_smoothing") return Reconstruction::tricubic_smoothing;
  throw unknown_name("interpolation", name, {"trilinear", "tricubic", "tricubic_smoothing"});
}

Scene parse_scene(std::string_view text, const std::filesystem::path& path,
                  const LookAtData& look) {
  const json root = parse_json(text, path);
  try {
    return read_root(root, path.parent_path(), look);
  } catch (const Error& error) {
    throw Error(path, error.what());
  }
}

Scene read_scene(const std::filesystem::path& path, const LookAtData& look) {
  return parse_scene(read_text(path), path, look);
}

decltype(Field::transfer_function) read_transfer_function(const std::filesystem::path& path) {
  const json root = parse_json(read_text(path), path);
  try {
    return read_transfer_function(Value(root, ""));
  } catch (const Error& error) {
    throw Error(path, error.what());
  }
}

bool is_scene_file(const std::filesystem::path& path) {
  if (path.extension() == ".json") return true;
  // Opening a pipe would wait for its writer.
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::ifstream stream(path, std::ios::binary);
  std::string head(65536, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  const auto start = head.find_first_not_of("\xef\xbb\xbf \t\r\n");
  return start != std::string::npos && head[start] == '{' &&
         head.find("\"version\"") != std::string::npos;
}

}  // namespace motes
