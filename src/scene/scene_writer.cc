// Scene files out: Scene -> JSON that reads back to an equal Scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "scene/geometry_json.h"
#include "scene/isosurface_json.h"
#include "scene/lighting_json.h"
#include "scene/scene.h"

namespace motes {
namespace {

using json = nlohmann::ordered_json;

json vector_to_json(double x, double y, double z) { return json::array({x, y, z}); }

json number_or_property_to_json(const NumberOrProperty& value) {
  return std::visit([](const auto& v) { return json(v); }, value);
}

json to_json(const std::monostate&) { return nullptr; }

json to_json(const TransferFunction& function) {
  json points = json::array();
  for (const TransferFunction::Point& point : function.points) {
    points.push_back({{"value", point.value},
                      {"color", color_to_json(point.color)},
                      {"extinction", point.extinction}});
  }
  json out;
  if (function.log_scale) out["scale"] = "log";
  out["points"] = std::move(points);
  return out;
}

json to_json(const NamedTransferFunction& named) {
  json out{{"name", named.name}};
  if (named.range) out["range"] = {named.range->first, named.range->second};
  if (named.extinction) out["extinction"] = *named.extinction;
  if (named.log_scale) out["scale"] = *named.log_scale ? "log" : "linear";
  return out;
}

/// `path` as it is found from `directory`.
std::string path_to_text(const std::filesystem::path& path,
                         const std::filesystem::path& directory) {
  const std::filesystem::path relative = path.lexically_relative(directory);
  return (relative.empty() ? std::filesystem::absolute(path) : relative).string();
}

json to_json(const KernelShape& shape, const std::filesystem::path& directory) {
  json out{{"type", name_of(shape.type)}};
  if (shape.type == KernelType::tabulated) {
    out["path"] = path_to_text(shape.profile.path, directory);
  }
  return out;
}

json to_json(const FieldGrid& grid, const std::filesystem::path& directory) {
  json out{{"interpolation", name_of(grid.interpolation)}};
  if (!grid.path.empty()) out["path"] = path_to_text(grid.path, directory);
  if (!grid.array.empty()) out["array"] = grid.array;
  return out;
}

json to_json(const Field& field, const std::filesystem::path& directory) {
  json out = json::object();
  if (!field.name.empty()) out["name"] = field.name;
  if (!field.visible) out["visible"] = false;
  if (field.grid) out["grid"] = to_json(*field.grid, directory);
  if (field.select != Selection{}) out["select"] = to_json(field.select);
  if (field.radius) out["radius"] = number_or_property_to_json(*field.radius);
  if (field.weight) out["weight"] = number_or_property_to_json(*field.weight);
  if (field.normalise) out["normalise"] = *field.normalise;
  if (field.kernel_shape) out["kernel"] = to_json(*field.kernel_shape, directory);
  if (field.support_factor) out["kernel"]["support_factor"] = *field.support_factor;
  if (field.kernel_scale) out["kernel"]["kernel_scale"] = *field.kernel_scale;
  if (!std::holds_alternative<std::monostate>(field.transfer_function)) {
    out["transfer_function"] =
        std::visit([](const auto& f) { return to_json(f); }, field.transfer_function);
  }
  if (field.fitted_isosurfaces) out["isosurfaces"] = fitted_isosurfaces;
  for (const Isosurface& isosurface : field.isosurfaces) {
    out["isosurfaces"].push_back(to_json(isosurface));
  }
  return out;
}

json to_json(const RenderSettings& render) {
  json out{{"size", {render.width, render.height}}};
  if (render.step_size) out["step_size"] = *render.step_size;
  out["termination_opacity"] = render.termination_opacity;
  out["lighting"] = to_json(render.lighting);
  if (render.surface != SurfaceSettings{}) out["surface"] = to_json(render.surface);
  for (const ClipPlane& plane : render.clip_planes) {
    const Vector3d& n = plane.normal;
    out["clip_planes"].push_back(
        {{"normal", vector_to_json(n.x, n.y, n.z)}, {"distance", plane.distance}});
  }
  out["background"] = color_to_json(render.background);
  out["engine"] = name_of(render.engine);
  return out;
}

json data_to_json(const Scene& scene, const std::filesystem::path& directory) {
  json out;
  if (!scene.data_path.empty()) out["path"] = path_to_text(scene.data_path, directory);
  out["frame"] = scene.frame;
  for (const auto& [number, name] : scene.types) out["types"][std::to_string(number)] = name;
  return out;
}

json camera_to_json(const Scene& scene) {
  json out = json::object();
  if (const auto& p = scene.eye) out["eye"] = vector_to_json(p->x, p->y, p->z);
  if (const auto& p = scene.target) out["target"] = vector_to_json(p->x, p->y, p->z);
  if (const auto& v = scene.up) out["up"] = vector_to_json(v->x, v->y, v->z);
  if (scene.fov_degrees) out["fov"] = *scene.fov_degrees;
  if (scene.orthographic_height) out["orthographic"] = *scene.orthographic_height;
  return out;
}

/// As json::dump() with an indent of two, but arrays and objects without others inside stay on one
/// line.
void print(const json& value, const std::string& indent, std::string& out) {
  const bool flat = std::none_of(value.begin(), value.end(),
                                 [](const json& item) { return item.is_structured(); });
  if (!value.is_structured() || value.empty() || (flat && value.is_array())) {
    out += value.dump();
    return;
  }
  const std::string inner = indent + "  ";
  out += value.is_array() ? "[" : "{";
  const char* separator = "\n";
  for (const auto& item : value.items()) {
    out += separator + inner;
    if (value.is_object()) out += json(item.key()).dump() + ": ";
    print(item.value(), inner, out);
    separator = ",\n";
  }
  out += "\n" + indent + (value.is_array() ? "]" : "}");
}

}  // namespace

std::string_view name_of(Engine engine) {
  switch (engine) {
    case Engine::sweep:
      return "sweep";
    case Engine::coherent:
      return "coherent";
    case Engine::direct:
      return "direct";
    case Engine::cells:
      return "cells";
  }
  return "";
}

std::string_view name_of(Reconstruction interpolation) {
  switch (interpolation) {
    case Reconstruction::trilinear:
      return "trilinear";
    case Reconstruction::tricubic:
      return "tricubic";
    case Reconstruction::tricubic_smoothing:
      return "tricubic_smoothing";
  }
  return "";
}

std::string scene_to_json(const Scene& scene, const std::filesystem::path& directory) {
  json root{{"version", 1}, {"data", data_to_json(scene, directory)}};
  const json camera = camera_to_json(scene);
  if (!camera.empty()) root["camera"] = camera;
  root["kernel"] = to_json(scene.kernel.shape, directory);
  if (scene.kernel.shape.type == KernelType::gaussian) {
    root["kernel"]["support_factor"] = scene.kernel.support_factor;
  }
  root["kernel"]["kernel_scale"] = scene.kernel.kernel_scale;
  if (!scene.fields.empty()) {
    root["fields"] = json::array();
    for (const Field& field : scene.fields) root["fields"].push_back(to_json(field, directory));
  }
  if (!scene.geometry.empty()) {
    root["geometry"] = json::array();
    for (const Geometry& item : scene.geometry) root["geometry"].push_back(to_json(item));
  }
  root["render"] = to_json(scene.render);
  try {
    std::string out;
    print(root, "", out);
    return out + "\n";
  } catch (const json::type_error&) {
    throw Error("the scene has a name or path that is not UTF-8, which JSON cannot hold");
  }
}

}  // namespace motes
