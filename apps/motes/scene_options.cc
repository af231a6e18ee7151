// Parses and checks the options; a bad value is a wrong command line.
#include "motes/scene_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "core/error.h"
#include "document/input.h"
#include "motes/option_values.h"
#include "scene/style.h"

namespace motes {
namespace {

/// Adds an option with one value; `read` makes a change of the scene out of its text.
void add_option(CLI::App& command, SceneChanges& changes, const std::string& name,
                const std::string& placeholder, const std::string& description,
                std::function<SceneChanges::Change(const std::string&)> read) {
  command
      .add_option_function<std::string>(
          name,
          [&changes, name, read = std::move(read)](const std::string& text) {
            changes.add(name, read(text));
          },
          description)
      ->type_name(placeholder);
}

/// Adds an option that may be given again; `read` makes a change of the scene out of all its texts.
CLI::Option* add_repeatable(CLI::App& command, SceneChanges& changes, const std::string& name,
                            const std::string& placeholder, const std::string& description,
                            SceneChanges::Change (*read)(const std::vector<std::string>&)) {
  return command
      .add_option_function<std::vector<std::string>>(
          name,
          [&changes, name, read](const std::vector<std::string>& texts) {
            changes.add(name, read(texts));
          },
          description + "; may be given again")
      ->type_name(placeholder)
      ->allow_extra_args(false);
}

constexpr double no_limit = -std::numeric_limits<double>::infinity();
constexpr NumberRange any_number{no_limit, -no_limit, true, "a number"};
constexpr NumberRange positive{0, -no_limit, true, "a number greater than 0"};
constexpr NumberRange opacity{0, 1, true, "a number greater than 0 and not more than 1"};
constexpr NumberRange ray_count{-1, 4096, true, "a whole number from 0 to 4096"};
constexpr double below_zero = -std::numeric_limits<double>::denorm_min();
constexpr NumberRange light_angle{below_zero, 90, true, "an angle from 0 to 90 degrees"};
constexpr NumberRange angle{0, 180, false, "an angle greater than 0 and less than 180 degrees"};

/// `range` outlives the command.
void add_number(CLI::App& command, SceneChanges& changes, const std::string& name,
                const std::string& placeholder, const std::string& description,
                const NumberRange& range, std::function<void(Scene&, double)> set) {
  add_option(command, changes, name, placeholder, description,
             [name, &range, set = std::move(set)](const std::string& text) {
               const auto value = number_in(text);
               if (!value || !range.contains(*value)) bad_value(name, range.expected, text);
               return [set, v = *value](Scene& scene) { set(scene, v); };
             });
}

void add_point(CLI::App& command, SceneChanges& changes, const std::string& name,
               const std::string& description, std::function<void(Scene&, const Point3d&)> set) {
  add_option(command, changes, name, "X,Y,Z", description,
             [name, set = std::move(set)](const std::string& text) {
               const auto p = triple_in(text);
               if (!p) bad_value(name, "three numbers such as 1,2.5,-3", text);
               return [set, point = Point3d{(*p)[0], (*p)[1], (*p)[2]}](Scene& scene) {
                 set(scene, point);
               };
             });
}

void add_direction(CLI::App& command, SceneChanges& changes, const std::string& name,
                   const std::string& description,
                   std::function<void(Scene&, const Vector3d&)> set) {
  add_option(command, changes, name, "X,Y,Z", description,
             [name, set = std::move(set)](const std::string& text) {
               const auto direction = direction_in(text);
               if (!direction) {
                 bad_value(name, "three numbers such as 1,2.5,-3, not all of them 0", text);
               }
               return [set, v = *direction](Scene& scene) { set(scene, v); };
             });
}

/// Plane after plane, in place of the scene's own.
SceneChanges::Change read_clip_planes(const std::vector<std::string>& texts) {
  std::vector<ClipPlane> planes;
  for (const std::string& text : texts) {
    const auto comma = text.rfind(',');
    const auto normal = direction_in(text.substr(0, comma));
    const auto distance = number_in(text.substr(std::min(comma, text.size() - 1) + 1));
    if (!normal || !distance || !std::isfinite(*distance)) {
      bad_value("--clip-plane",
                "a normal other than 0,0,0 and a distance from the origin such as 0,0,1,12.5",
                text);
    }
    planes.push_back({*normal, *distance});
  }
  return [planes](Scene& scene) { scene.render.clip_planes = planes; };
}

/// X,Y,Z or headlight, each with ,INTENSITY or without; nothing where text is none of these.
std::optional<LightSource> light_in(std::string_view text) {
  const bool headlight = text.starts_with("headlight");
  const bool has_intensity = std::ranges::count(text, ',') == (headlight ? 1 : 3);
  const std::size_t end = has_intensity ? text.rfind(',') : text.size();
  const std::string_view place = text.substr(0, end);
  LightSource light;
  if (headlight) {
    if (place != "headlight") return std::nullopt;
  } else {
    light.direction = direction_in(place);
    if (!light.direction) return std::nullopt;
  }
  if (!has_intensity) return light;
  const auto intensity = number_in(text.substr(end + 1));
  if (!intensity || !(*intensity >= 0 && *intensity <= max_intensity)) return std::nullopt;
  light.intensity = *intensity;
  return light;
}

/// Light after light, in place of the scene's own.
SceneChanges::Change read_lights(const std::vector<std::string>& texts) {
  std::vector<LightSource> lights;
  for (const std::string& text : texts) {
    const auto light = light_in(text);
    if (!light) {
      bad_value("--light",
                "a direction such as 1,2,1.5, not 0,0,0, or headlight, and perhaps an intensity "
                "from 0 to a million as in headlight,0.4",
                text);
    }
    lights.push_back(*light);
  }
  if (lights.size() > max_lights) {
    bad_value("--light", fmt::format("at most {} lights", max_lights),
              fmt::format("{}", lights.size()));
  }
  return [lights](Scene& scene) {
    scene.render.lighting.enabled = true;
    scene.render.lighting.lights = lights;
  };
}

/// Calls `change` for every field; a scene without any gets the one that it stands for. Throws
/// Error where it draws something else instead.
void for_each_field(Scene& scene, std::string_view option,
                    const std::function<void(Field&)>& change) {
  if (scene.fields.empty() && !scene.geometry.empty()) {
    throw Error(
        fmt::format("{}: is for fields, and the scene draws none, but balls or sticks", option));
  }
  if (scene.fields.empty()) scene.fields.emplace_back().name = "all";
  for (Field& field : scene.fields) change(field);
}

void add_number_or_property(CLI::App& command, SceneChanges& changes, const std::string& name,
                            const std::string& placeholder, const std::string& description,
                            const NumberRange& range,
                            std::optional<NumberOrProperty> Field::*member) {
  add_option(command, changes, name, placeholder, description,
             [name, &range, member](const std::string& text) -> SceneChanges::Change {
               const auto number = number_in(text);
               if (text.empty() || (number && !range.contains(*number))) {
                 bad_value(name, fmt::format("{} or the name of a property", range.expected), text);
               }
               const NumberOrProperty value =
                   number ? NumberOrProperty(*number) : NumberOrProperty(text);
               return [name, member, value](Scene& scene) {
                 bool any = false;
                 for_each_field(scene, name, [&](Field& field) {
                   if (field.grid) return;
                   field.*member = value;
                   any = true;
                 });
                 if (!any) {
                   throw Error(fmt::format(
                       "{}: is for fields of particles, and all of the scene's are grids", name));
                 }
               };
             });
}

SceneChanges::Change read_types(const std::string& text) {
  std::map<int, std::string> types;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::string_view item = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), item.size() + 1));
    int number = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), number);
    const auto equals = item.find('=');
    if (error != std::errc{} || number < 0 || equals == std::string_view::npos ||
        end != item.data() + equals || equals + 1 == item.size()) {
      bad_value("--types", "names of numeric types such as 1=Si,2=O", text);
    }
    types[number] = item.substr(equals + 1);
  }
  return [types](Scene& scene) {
    for (const auto& [number, name] : types) scene.types[number] = name;
  };
}

SceneChanges::Change read_size(const std::string& text) {
  constexpr int max_side = 16384;
  int width = 0, height = 0;
  const char* const last = text.data() + text.size();
  const auto [middle, error] = std::from_chars(text.data(), last, width);
  bool good = error == std::errc{} && middle != last && (*middle == 'x' || *middle == 'X');
  if (good) {
    const auto [end, second_error] = std::from_chars(middle + 1, last, height);
    good = second_error == std::errc{} && end == last;
  }
  if (!good || width < 1 || height < 1 || width > max_side || height > max_side) {
    bad_value("--size", fmt::format("WIDTHxHEIGHT, each from 1 to {}", max_side), text);
  }
  return [width, height](Scene& scene) {
    scene.render.width = width;
    scene.render.height = height;
  };
}

SceneChanges::Change read_background(const std::string& text) {
  auto color = color_from_text(text);
  // A # begins a comment in the shell, so it may be left out.
  if (!color) color = color_from_text("#" + text);
  const auto linear = triple_in(text);
  if (linear && std::all_of(linear->begin(), linear->end(),
                            [](double channel) { return channel >= 0 && channel <= 1; })) {
    color = {static_cast<float>((*linear)[0]), static_cast<float>((*linear)[1]),
             static_cast<float>((*linear)[2])};
  }
  if (!color) {
    bad_value("--background", "black, white, '#rrggbb' (sRGB) or r,g,b (linear, each in [0, 1])",
              text);
  }
  return [color = *color](Scene& scene) { scene.render.background = color; };
}

SceneChanges::Change read_transfer_function_option(const std::string& text) {
  std::vector<std::string> names = color_map_names();
  names.emplace_back(species_colors);
  if (std::find(names.begin(), names.end(), text) != names.end()) {
    return [text](Scene& scene) {
      for_each_field(scene, "--transfer-function", [&](Field& field) {
        field.transfer_function = NamedTransferFunction{text, {}, {}, {}};
      });
    };
  }
  if (std::filesystem::path(text).extension() != ".json") {
    throw CLI::ValidationError(
        fmt::format("--transfer-function: {}", unknown_name("colour map", text, names).what()),
        CLI::ExitCodes::ValidationError);
  }
  return [text](Scene& scene) {
    const auto function = read_transfer_function(text);
    for_each_field(scene, "--transfer-function",
                   [&](Field& field) { field.transfer_function = function; });
  };
}

SceneChanges::Change read_style(const std::string& text) {
  try {
    check_fields_of_style(text, {});
  } catch (const Error& error) {
    throw CLI::ValidationError(fmt::format("--style: {}", error.what()),
                               CLI::ExitCodes::ValidationError);
  }
  return [text](Scene& scene) { apply_style(text, scene, look_at_data(scene.data_path)); };
}

SceneChanges::Change read_interpolation(const std::string& text) {
  try {
    return [interpolation = interpolation_from_name(text)](Scene& scene) {
      bool any = false;
      for (Field& field : scene.fields) {
        if (!field.grid) continue;
        field.grid->interpolation = interpolation;
        any = true;
      }
      if (!any) throw Error("--interpolation: is for grids, and none of the fields is one");
    };
  } catch (const Error& error) {
    throw CLI::ValidationError(fmt::format("--interpolation: {}", error.what()),
                               CLI::ExitCodes::ValidationError);
  }
}

SceneChanges::Change read_engine(const std::string& text) {
  try {
    return [engine = engine_from_name(text)](Scene& scene) { scene.render.engine = engine; };
  } catch (const Error& error) {
    throw CLI::ValidationError(fmt::format("--engine: {}", error.what()),
                               CLI::ExitCodes::ValidationError);
  }
}

void add_camera_options(CLI::App& command, SceneChanges& changes) {
  add_point(command, changes, "--eye", "where the camera is (default: all of the data in view)",
            [](Scene& s, const Point3d& p) { s.eye = p; });
  add_point(command, changes, "--target", "what it looks at (default: the middle of the data)",
            [](Scene& s, const Point3d& p) { s.target = p; });
  add_direction(command, changes, "--up",
                "what is up in the picture (default: y, or z for a side view)",
                [](Scene& s, const Vector3d& v) { s.up = v; });
  add_number(command, changes, "--fov", "DEGREES",
             "vertical field of view\n(default: 45, less in pictures wider than 16:9)", angle,
             [](Scene& s, double v) {
               s.fov_degrees = v;
               s.orthographic_height.reset();
             });
  add_number(command, changes, "--orthographic", "HEIGHT",
             "parallel projection; the height of the picture in the data's unit of length",
             positive, [](Scene& s, double v) {
               s.orthographic_height = v;
               s.fov_degrees.reset();
             });
  command.get_option("--fov")->excludes("--orthographic");
}

void add_lighting_options(CLI::App& command, SceneChanges& changes) {
  const auto add = [&](const std::string& name, bool enabled, const std::string& description) {
    return command
        .add_flag_callback(
            name,
            [&changes, name, enabled] {
              changes.add(name,
                          [enabled](Scene& scene) { scene.render.lighting.enabled = enabled; });
            },
            description)
        ->disable_flag_override();
  };
  CLI::Option* on = add("--lighting", true, "shade by the field's gradient (the default)");
  add("--no-lighting", false, "show colours as they are")->excludes(on);
  add_direction(command, changes, "--light-direction",
                "the light's direction, towards it, for shadows (default: from the camera, none)",
                [](Scene& s, const Vector3d& v) {
                  s.render.lighting.enabled = true;
                  s.render.lighting.lights = {{v, 1}};
                });
  command.get_option("--light-direction")->excludes("--no-lighting");
  add_repeatable(command, changes, "--light", "X,Y,Z[,INTENSITY]",
                 "a light: towards it, or headlight, and its intensity (default: 1)", read_lights)
      ->excludes("--light-direction")
      ->excludes("--no-lighting");
  add_number(command, changes, "--light-angle", "DEGREES",
             "how large lights are seen (default: 3); 0: hard shadows", light_angle,
             [](Scene& s, double v) { s.render.surface.light_angle = v; });
}

}  // namespace

bool SceneChanges::contains(const std::string& option) const {
  return std::any_of(changes_.begin(), changes_.end(),
                     [&option](const auto& change) { return change.first == option; });
}

void add_data_options(CLI::App& command, SceneChanges& changes) {
  add_option(command, changes, "--frame", "N", "frame of a trajectory, from 0 (default: 0)",
             [](const std::string& text) {
               std::uint64_t frame = 0;
               const char* const last = text.data() + text.size();
               const auto [end, error] = std::from_chars(text.data(), last, frame);
               if (error != std::errc{} || end != last) {
                 bad_value("--frame", "a whole number of 0 or more", text);
               }
               return [frame](Scene& scene) { scene.frame = frame; };
             });
  add_option(command, changes, "--types", "1=Si,2=O", "names of numeric types (LAMMPS)",
             read_types);
}

/// The name of a kernel, or a file with a table.
SceneChanges::Change read_kernel(const std::string& text) {
  const auto set = [](Scene& scene, const KernelShape& shape) {
    scene.kernel.shape = shape;
    for (Field& field : scene.fields) field.kernel_shape.reset();
  };
  if (text.find_first_of("./") != std::string::npos) {
    return [set, text](Scene& scene) {
      set(scene, {KernelType::tabulated, read_radial_profile(text)});
    };
  }
  try {
    const KernelType type = kernel_type_from_name(text);
    if (type == KernelType::tabulated) bad_value("--kernel", "the file of a table", text);
    return [set, type](Scene& scene) { set(scene, {type, {}}); };
  } catch (const Error& error) {
    throw CLI::ValidationError(fmt::format("--kernel: {}", error.what()),
                               CLI::ExitCodes::ValidationError);
  }
}

void add_field_options(CLI::App& command, SceneChanges& changes) {
  add_number_or_property(command, changes, "--radius", "R",
                         "standard deviation of the Gaussians or radius of other kernels,\n"
                         "a number or a property\n"
                         "(default: covalent radii, or from smoothing lengths)",
                         positive, &Field::radius);
  add_number_or_property(command, changes, "--weight", "W",
                         "weight of the particles, a number or a property (default: 1,\n"
                         "or mass as a density where the data have sizes and masses)",
                         any_number, &Field::weight);
  add_option(command, changes, "--kernel", "NAME|FILE",
             "gaussian, cubic_spline, quintic_spline, wendland_c2, wendland_c4, wendland_c6,\n"
             "or a file of two columns, distance and value (default: gaussian)",
             read_kernel);
  add_option(command, changes, "--interpolation", "NAME",
             "how grids are reconstructed: trilinear, tricubic (B-spline through the samples) or\n"
             "tricubic_smoothing (default: trilinear)",
             read_interpolation);
  add_number(command, changes, "--support-factor", "S",
             "the Gaussians end at S standard deviations (default: 2)", positive,
             [](Scene& scene, double v) {
               scene.kernel.support_factor = v;
               for (Field& field : scene.fields) field.support_factor.reset();
             });
  add_number(command, changes, "--kernel-scale", "K", "factor on all kernels (default: 1)",
             any_number, [](Scene& scene, double v) {
               scene.kernel.kernel_scale = v;
               for (Field& field : scene.fields) field.kernel_scale.reset();
             });
}

void add_size_option(CLI::App& command, SceneChanges& changes) {
  add_option(command, changes, "--size", "WxH",
             "size of the picture in pixels (default: 1024x1024)", read_size);
}

void add_picture_options(CLI::App& command, SceneChanges& changes) {
  add_size_option(command, changes);
  add_option(command, changes, "--style", "NAME",
             fmt::format("what is drawn: {}", fmt::join(style_names(), ", ")), read_style);
  add_camera_options(command, changes);
  add_option(
      command, changes, "--transfer-function", "NAME|FILE.json",
      fmt::format(
          "colours and opacity: {}, species,\nor a file with points; names are "
          "fitted to the values in view\n(default: species where they are elements, else viridis)",
          fmt::join(color_map_names(), ", ")),
      read_transfer_function_option);
  add_lighting_options(command, changes);
  add_option(command, changes, "--background", "COLOUR",
             "black, white, rrggbb or linear r,g,b (default: black)", read_background);
  add_number(command, changes, "--step-size", "S",
             "distance of samples (default: half of a small radius)", positive,
             [](Scene& scene, double v) { scene.render.step_size = v; });
  add_number(command, changes, "--termination-opacity", "A",
             "opacity at which a ray stops (default: 0.97)", opacity,
             [](Scene& scene, double v) { scene.render.termination_opacity = v; });
  add_repeatable(command, changes, "--clip-plane", "NX,NY,NZ,D",
                 "cuts away what lies farther than D along the normal", read_clip_planes);
  add_number(
      command, changes, "--ambient-occlusion", "N",
      "rays a pixel for the ambient occlusion of surfaces (default: 16)", ray_count,
      [](Scene& scene, double v) { scene.render.surface.occlusion_samples = static_cast<int>(v); });
  add_option(command, changes, "--engine", "NAME",
             "sweep, coherent, direct or cells (default: sweep)", read_engine);
}

}  // namespace motes
