// One function a message.
#include "server/answers.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <variant>

#include "scene/style.h"

namespace motes::server {
namespace {

using json = nlohmann::ordered_json;

/// Names of files and particles may be no UTF-8; not a number and infinity become null.
std::string text_of(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

json to_json(const Vector3d& v) { return json::array({v.x, v.y, v.z}); }
json to_json(const Point3d& p) { return to_json(Vector3d(p)); }

template <class T>
json or_null(const std::optional<T>& value) {
  return value ? json(*value) : json(nullptr);
}

json to_json(const Camera& camera) {
  json out{
      {"eye", to_json(camera.eye)}, {"target", to_json(camera.target)}, {"up", to_json(camera.up)}};
  if (camera.orthographic_height) {
    out["orthographic"] = *camera.orthographic_height;
  } else {
    out["fov"] = camera.fov_degrees;
  }
  return out;
}

std::string hex(std::uint32_t srgb) { return fmt::format("#{:06x}", srgb & 0xffffffU); }

json color_maps() {
  constexpr int num_colors = 32;
  json maps = json::object();
  for (const std::string& name : color_map_names()) {
    const TransferFunction map = named_transfer_function(name, 0, num_colors - 1, 1);
    for (int i = 0; i < num_colors; ++i) maps[name].push_back(hex(color_to_srgb(color_at(map, i))));
  }
  return maps;
}

json data_of(const DataInfo& info, std::optional<std::size_t> frames) {
  json data{{"file", info.path.filename().string()},
            {"format", info.format},
            {"particles", info.particles},
            {"frames", or_null(frames)},
            {"time", or_null(info.time)},
            {"length_unit", info.length_unit},
            {"bounds", {{"min", to_json(info.bounds.min)}, {"max", to_json(info.bounds.max)}}},
            {"species", json::array()},
            {"properties", json::array()},
            {"cell", nullptr},
            {"grids", json::array()},
            {"fields", json::array()}};
  for (const SpeciesInfo& species : info.species) {
    data["species"].push_back(
        {{"name", species.name}, {"count", species.count}, {"color", hex(species.srgb)}});
  }
  for (const PropertyInfo& property : info.properties) {
    data["properties"].push_back(
        {{"name", property.name}, {"min", or_null(property.min)}, {"max", or_null(property.max)}});
  }
  if (const auto& cell = info.cell) {
    data["cell"] = {to_json(cell->vectors[0]), to_json(cell->vectors[1]),
                    to_json(cell->vectors[2])};
  }
  for (const GridInfo& grid : info.grids) {
    data["grids"].push_back({{"name", grid.name}, {"size", grid.dims}});
  }
  for (const FieldInfo& field : info.fields) {
    data["fields"].push_back({{"name", field.name},
                              {"particles", field.particles},
                              {"default_radius", or_null(field.radius)}});
  }
  return data;
}

/// Colour maps that were fitted, with all of their points: those are what pages edit.
Scene with_points(Scene scene) {
  for (Field& field : scene.fields) {
    const auto* named = std::get_if<NamedTransferFunction>(&field.transfer_function);
    if (named == nullptr || !named->range || !named->extinction) continue;
    const auto [low, high] = *named->range;
    field.transfer_function = named_transfer_function(named->name, low, high, *named->extinction,
                                                      named->log_scale.value_or(false));
  }
  return scene;
}

/// Resident memory of the program.
std::size_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

std::string hello_text(ClientId client, const std::filesystem::path& uploads) {
  return text_of({{"type", "hello"},
                  {"protocol", 1},
                  {"version", MOTES_VERSION},
                  {"client", client},
                  {"uploads", uploads.string()},
                  {"color_maps", color_maps()},
                  {"styles", style_names()},
                  {"engines", {"sweep", "coherent", "direct", "cells"}}});
}

std::string scene_text(const Document& document, std::optional<std::size_t> frames,
                       const SceneAnswer& answer) {
  json scene = json::parse(scene_to_json(with_points(document.scene()), ""));
  if (!scene.contains("fields")) scene["fields"] = json::array();
  json message{{"type", "scene"},
               {"sequence", or_null(answer.sequence)},
               {"client", or_null(answer.client)},
               {"scene", std::move(scene)},
               {"data", data_of(document.info(), frames)}};
  if (answer.new_data) message["new_data"] = true;
  if (answer.fitted) message["fitted"] = true;
  return text_of(message);
}

std::string progress_text(std::string_view activity, double fraction) {
  return text_of({{"type", "progress"}, {"activity", activity}, {"fraction", fraction}});
}

std::string ready_text() { return text_of({{"type", "ready"}}); }

std::string error_text(Sequence sequence, std::string_view message) {
  return text_of({{"type", "error"}, {"sequence", or_null(sequence)}, {"message", message}});
}

std::string warnings_text(const Warnings& warnings) {
  return text_of({{"type", "warnings"}, {"lines", warnings.lines()}});
}

std::string picked_text(std::uint32_t sequence, const std::optional<Pick>& pick) {
  json message{{"type", "picked"}, {"sequence", sequence}, {"hit", nullptr}};
  if (!pick) return text_of(message);
  json hit{{"index", pick->index},       {"id", or_null(pick->id)},
           {"species", nullptr},         {"position", to_json(pick->position)},
           {"distance", pick->distance}, {"properties", json::object()},
           {"values", json::object()}};
  if (!pick->species.empty()) hit["species"] = pick->species;
  for (const auto& [name, value] : pick->properties) hit["properties"][name] = value;
  for (const auto& [name, value] : pick->values) hit["values"][name] = value;
  message["hit"] = std::move(hit);
  return text_of(message);
}

std::string camera_text(ClientId client, const Camera& camera) {
  return text_of({{"type", "camera"}, {"client", client}, {"camera", to_json(camera)}});
}

std::string clients_text(const std::map<ClientId, std::optional<ClientId>>& following) {
  json clients = json::array();
  for (const auto& [client, followed] : following) {
    clients.push_back({{"client", client}, {"following", or_null(followed)}});
  }
  return text_of({{"type", "clients"}, {"clients", std::move(clients)}});
}

std::string histogram_text(const std::vector<Histogram>& histograms) {
  json fields = json::array();
  for (const Histogram& histogram : histograms) {
    json field{{"name", histogram.name}, {"min", histogram.min},
               {"max", histogram.max},   {"counts", histogram.counts},
               {"log_counts", nullptr},  {"positive_min", or_null(histogram.positive_min)}};
    if (histogram.positive_min) field["log_counts"] = histogram.log_counts;
    fields.push_back(std::move(field));
  }
  return text_of({{"type", "histogram"}, {"fields", std::move(fields)}});
}

std::string statistics_text(const Document& document, const RenderStatistics& frame,
                            double encode_ms, std::size_t clients) {
  const MemoryUse memory = document.memory();
  return text_of({{"type", "statistics"},
                  {"frame_ms", frame.frame_ms},
                  {"encode_ms", encode_ms},
                  {"samples", frame.samples},
                  {"kernel_evaluations", frame.kernel_evaluations},
                  {"particles", document.info().particles},
                  {"particle_bytes", memory.particle_bytes},
                  {"tree_bytes", memory.tree_bytes},
                  {"rss_bytes", resident_bytes()},
                  {"threads", frame.threads},
                  {"engine", frame.engine},
                  {"instruction_set", frame.instruction_set},
                  {"clients", clients}});
}

std::string listing_text(std::string_view path, const std::vector<FolderEntry>& entries) {
  json list = json::array();
  for (const FolderEntry& entry : entries) {
    list.push_back({{"name", entry.name}, {"folder", entry.is_folder}, {"size", entry.size}});
  }
  return text_of({{"type", "listing"}, {"path", path}, {"entries", std::move(list)}});
}

}  // namespace motes::server
