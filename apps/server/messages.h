// What pages say to the server (docs/viewer.md, "Protocol").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "scene/camera.h"

namespace motes::server {

using ClientId = std::uint32_t;

inline constexpr std::size_t max_message_bytes = std::size_t{1} << 20;
inline constexpr int max_picture_side = 16384;

/// How many pixels the client's picture has.
struct SizeMessage {
  int width = 0, height = 0;
};
struct ViewMessage {
  std::uint32_t sequence = 0;
  Camera camera;
  bool moving = false;
};
struct SceneMessage {
  std::uint32_t sequence = 0;
  std::string scene;  ///< JSON, not looked at yet
};
struct PickMessage {
  std::uint32_t sequence = 0;
  double x = 0, y = 0;  ///< pixels from the left top
};
struct FitMessage {};
struct HistogramMessage {};
struct StatisticsMessage {};
/// All frames up to this one have arrived.
struct AckMessage {
  std::uint32_t frame = 0;
};
struct ListMessage {
  std::string path;
};
struct OpenMessage {
  std::string path;
};
struct CancelMessage {};
struct FollowMessage {
  std::optional<ClientId> client;  ///< nullopt: nobody any longer
};

using Message = std::variant<SizeMessage, ViewMessage, SceneMessage, PickMessage, FitMessage,
                             HistogramMessage, StatisticsMessage, AckMessage, ListMessage,
                             OpenMessage, CancelMessage, FollowMessage>;

/// Throws Error for what is no message: no JSON, an unknown type, keys that are missing or unknown,
/// values out of range.
Message parse_message(std::string_view text);

}  // namespace motes::server
