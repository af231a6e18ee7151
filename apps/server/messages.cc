// JSON -> messages, every value checked.
#include "server/messages.h"

#include <fmt/format.h>

#include <functional>
#include <limits>
#include <map>

#include "core/error.h"
#include "scene/checked_json.h"

namespace motes::server {
namespace {

using Value = CheckedJson;

constexpr std::size_t max_path = 4096;

std::uint32_t number_of(const Value& value) {
  return static_cast<std::uint32_t>(value.integer(0, std::numeric_limits<std::uint32_t>::max()));
}

int side_of(const Value& value) { return static_cast<int>(value.integer(1, max_picture_side)); }

/// A path may be empty: the folder itself.
std::string path_of(const Value& value) {
  if (!value.raw().is_string()) value.expected("a path");
  auto path = value.raw().get<std::string>();
  if (path.size() > max_path) value.expected(fmt::format("at most {} bytes", max_path));
  return path;
}

/// A camera with nothing open, as "camera" of scene files.
Camera camera_of(const Value& value) {
  value.check_keys({"eye", "target", "up", "fov", "orthographic"});
  Camera camera;
  camera.eye = Point3d(value.at("eye").vector());
  camera.target = Point3d(value.at("target").vector());
  camera.up = value.at("up").vector();
  value.with("fov", [&](const Value& v) { camera.fov_degrees = v.number(); });
  value.with("orthographic",
             [&](const Value& v) { camera.orthographic_height = v.number_above(0); });
  try {
    camera_axes(camera);
  } catch (const Error& error) {
    value.fail(error.what());
  }
  return camera;
}

Message read_size(const Value& value) {
  value.check_keys({"type", "width", "height"});
  return SizeMessage{side_of(value.at("width")), side_of(value.at("height"))};
}

Message read_view(const Value& value) {
  value.check_keys({"type", "sequence", "camera", "moving"});
  return ViewMessage{number_of(value.at("sequence")), camera_of(value.at("camera")),
                     value.at("moving").boolean()};
}

Message read_scene_message(const Value& value) {
  value.check_keys({"type", "sequence", "scene"});
  const Value scene = value.at("scene");
  if (!scene.raw().is_object()) scene.expected("a scene");
  return SceneMessage{number_of(value.at("sequence")), scene.raw().dump()};
}

Message read_pick(const Value& value) {
  value.check_keys({"type", "sequence", "x", "y"});
  return PickMessage{number_of(value.at("sequence")), value.at("x").number(),
                     value.at("y").number()};
}

Message read_ack(const Value& value) {
  value.check_keys({"type", "frame"});
  return AckMessage{number_of(value.at("frame"))};
}

Message read_follow(const Value& value) {
  value.check_keys({"type", "client"});
  const Value client = value.at("client");
  if (client.raw().is_null()) return FollowMessage{};
  return FollowMessage{number_of(client)};
}

/// Of messages that say no more than their type.
template <class M>
Message read_plain(const Value& value) {
  value.check_keys({"type"});
  return M{};
}

template <class M>
Message read_path(const Value& value) {
  value.check_keys({"type", "path"});
  return M{path_of(value.at("path"))};
}

const std::map<std::string, Message (*)(const Value&), std::less<>> readers{
    {"size", read_size},
    {"view", read_view},
    {"scene", read_scene_message},
    {"pick", read_pick},
    {"fit", read_plain<FitMessage>},
    {"histogram", read_plain<HistogramMessage>},
    {"statistics", read_plain<StatisticsMessage>},
    {"ack", read_ack},
    {"list", read_path<ListMessage>},
    {"open", read_path<OpenMessage>},
    {"cancel", read_plain<CancelMessage>},
    {"follow", read_follow}};

}  // namespace

Message parse_message(std::string_view text) {
  const nlohmann::json root = parse_json(text, "message");
  const Value value(root, "message");
  if (!root.is_object()) value.expected("an object");
  const std::string type = value.at("type").text("a type of message");
  const auto reader = readers.find(type);
  if (reader == readers.end()) {
    value.fail(fmt::format("unknown type '{}'", printable(type)));
  }
  return reader->second(value);
}

}  // namespace motes::server
