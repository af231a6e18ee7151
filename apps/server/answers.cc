// One function a message.
#include "server/answers.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/geometry.h"
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
  json out{{"eye", to_json(camera.eye)},
           {"target", to_json(camera.target)},
           {"up", to_json(camera.up)}};
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

json species_of(const ParticleSet& particles) {
  std::vector<std::size_t> counts(particles.species_names.size());
  for (const std::uint16_t s : particles.species) ++counts[s];
  json out = json::array();
  if (particles.species.empty()) return out;
  const auto colors = colors_of_species(particles, ColorBy::element);
  for (std::size_t s = 0; s < counts.size(); ++s) {
    out.push_back({{"name", particles.species_names[s]},
                   {"count", counts[s]},
                   {"color", hex(colors[s])}});
  }
  return out;
}

json properties_of(const ParticleSet& particles) {
  json out = json::array();
  for (const Property& property : particles.properties) {
    float low = INFINITY, high = -INFINITY;
    for (const float value : property.values) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    out.push_back({{"name", property.name}, {"min", low}, {"max", high}});
  }
  return out;
}

json grids_of(const Document& document) {
  json out = json::array();
  for (const LoadedGrid& loaded : document.grids()) {
    out.push_back({{"name", loaded.grid->name}, {"size", loaded.grid->dims}});
  }
  return out;
}

/// One a field of the scene, those that are not visible included.
json fields_of(const Document& document) {
  json out = json::array();
  auto source = document.gathered().sources.begin();
  for (const Field& field : document.scene().fields) {
    json entry{{"name", field.name}, {"particles", 0}, {"default_radius", nullptr}};
    if (field.visible) {
      entry["particles"] = source->index.size();
      if (!source->radius.empty()) entry["default_radius"] = source->radius_of(0);
      ++source;
    }
    out.push_back(std::move(entry));
  }
  return out;
}

json data_of(const Document& document, const SceneAnswer& answer) {
  const ParticleSet& particles = document.particles();
  const Bounds3d bounds = document.bounds();
  std::string unit = particles.length_unit;
  if (particles.size() == 0 && !document.grids().empty()) {
    unit = document.grids().front().grid->length_unit;
  }
  json data{{"file", answer.name},
            {"format", document.format()},
            {"particles", particles.size()},
            {"frames", or_null(answer.frames)},
            {"time", or_null(particles.time)},
            {"length_unit", unit},
            {"bounds", {{"min", to_json(bounds.min)}, {"max", to_json(bounds.max)}}},
            {"species", species_of(particles)},
            {"properties", properties_of(particles)},
            {"cell", nullptr},
            {"grids", grids_of(document)},
            {"fields", fields_of(document)}};
  if (const auto& cell = particles.cell) {
    data["cell"] = {to_json(cell->vectors[0]), to_json(cell->vectors[1]),
                    to_json(cell->vectors[2])};
  }
  return data;
}

/// Resident memory of the program.
std::size_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

std::string hello_text(ClientId client) {
  return text_of({{"type", "hello"},
                  {"protocol", 1},
                  {"version", MOTES_VERSION},
                  {"client", client},
                  {"color_maps", color_maps()},
                  {"styles", style_names()},
                  {"engines", {"sweep", "coherent", "direct", "cells"}}});
}

std::string scene_text(const Document& document, const SceneAnswer& answer) {
  json scene = json::parse(scene_to_json(document.scene(), ""));
  if (!scene.contains("fields")) scene["fields"] = json::array();
  json message{{"type", "scene"},
               {"sequence", or_null(answer.sequence)},
               {"client", or_null(answer.client)},
               {"scene", std::move(scene)},
               {"data", data_of(document, answer)}};
  if (answer.new_data) message["new_data"] = true;
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

std::string picked_text(std::uint32_t sequence, const Document& document,
                        const std::optional<Pick>& pick) {
  json message{{"type", "picked"}, {"sequence", sequence}, {"hit", nullptr}};
  if (!pick) return text_of(message);
  const ParticleSet& particles = document.particles();
  const std::size_t i = pick->particle;
  json hit{{"index", i},
           {"id", particles.ids.empty() ? json(nullptr) : json(particles.ids[i])},
           {"species", nullptr},
           {"position", to_json(particles.position(i))},
           {"distance", pick->distance},
           {"properties", json::object()},
           {"values", json::object()}};
  if (!particles.species.empty()) hit["species"] = particles.species_names[particles.species[i]];
  for (const Property& property : particles.properties) {
    hit["properties"][property.name] = property.values[i];
  }
  for (std::size_t f = 0; f < pick->values.size(); ++f) {
    hit["values"][document.gathered().fields[f].name] = pick->values[f];
  }
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

std::string histogram_text(const Document& document, const std::vector<Histogram>& histograms) {
  json fields = json::array();
  for (std::size_t f = 0; f < histograms.size(); ++f) {
    const Histogram& histogram = histograms[f];
    json field{{"name", document.gathered().fields[f].name},
               {"min", histogram.min},
               {"max", histogram.max},
               {"counts", histogram.counts},
               {"log_counts", nullptr},
               {"positive_min", or_null(histogram.positive_min)}};
    if (histogram.positive_min) field["log_counts"] = histogram.log_counts;
    fields.push_back(std::move(field));
  }
  return text_of({{"type", "histogram"}, {"fields", std::move(fields)}});
}

std::string statistics_text(const Document& document, const RenderStatistics& frame,
                            double encode_ms, std::size_t clients) {
  const KernelSet& kernels = document.renderer().kernels();
  return text_of({{"type", "statistics"},
                  {"frame_ms", frame.frame_ms},
                  {"encode_ms", encode_ms},
                  {"samples", frame.samples},
                  {"kernel_evaluations", frame.kernel_evaluations},
                  {"particles", document.particles().size()},
                  {"particle_bytes", kernels.particle_bytes()},
                  {"tree_bytes", kernels.bvh.bytes()},
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
