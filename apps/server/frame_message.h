// A picture on its way to a page: a header and the bytes of an image file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace motes::server {

enum class FrameFormat : std::uint16_t { jpeg = 0, png = 1 };

/// What stands before the image: 40 bytes, little-endian, in this order after the four of "MTF1".
struct FrameHeader {
  std::uint32_t frame = 0;           ///< counts up for each client
  std::uint32_t view_sequence = 0;   ///< of the newest "view" that it shows
  std::uint32_t scene_sequence = 0;  ///< of the client's newest "scene" that it shows
  FrameFormat format = FrameFormat::jpeg;
  bool final = false;  ///< the full picture, without loss
  std::uint32_t width = 0, height = 0;
  float render_ms = 0, encode_ms = 0;
  /// Of the image. A message with fewer has been recalled on its way: there is no picture in it.
  std::uint32_t bytes = 0;
};

inline constexpr std::size_t frame_header_bytes = 40;

/// The message: header, with the image's bytes, and image.
std::string frame_message(const FrameHeader& header, std::string_view image);
/// The header of such a message; nullopt: it is none.
std::optional<FrameHeader> parse_frame_header(std::string_view message);
/// Whether the message with that header holds all of its image.
bool is_whole(const FrameHeader& header, std::string_view message);

}  // namespace motes::server
