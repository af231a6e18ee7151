// The header's bytes, one after the other whatever the machine's own order.
#include "server/frame_message.h"

#include <bit>
#include <cassert>

namespace motes::server {
namespace {

template <class T>
void append(std::string& out, T value) {
  for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
    out += static_cast<char>(value >> (8 * byte) & 0xff);
  }
}

/// Takes a number from the front of `bytes`.
template <class T>
T take(std::string_view& bytes) {
  T value = 0;
  for (std::size_t byte = sizeof(T); byte-- > 0;) {
    value = static_cast<T>(value << 8 | static_cast<unsigned char>(bytes[byte]));
  }
  bytes.remove_prefix(sizeof(T));
  return value;
}

constexpr std::string_view magic = "MTF1";

}  // namespace

std::string frame_message(const FrameHeader& header, std::string_view image) {
  std::string out;
  out.reserve(frame_header_bytes + image.size());
  out += magic;
  append(out, header.frame);
  append(out, header.view_sequence);
  append(out, header.scene_sequence);
  append(out, static_cast<std::uint16_t>(header.format));
  append(out, static_cast<std::uint16_t>(header.final ? 1 : 0));
  append(out, header.width);
  append(out, header.height);
  append(out, std::bit_cast<std::uint32_t>(header.render_ms));
  append(out, std::bit_cast<std::uint32_t>(header.encode_ms));
  append(out, static_cast<std::uint32_t>(image.size()));
  assert(out.size() == frame_header_bytes);
  out += image;
  return out;
}

std::optional<FrameHeader> parse_frame_header(std::string_view message) {
  if (message.size() < frame_header_bytes || !message.starts_with(magic)) return {};
  message.remove_prefix(magic.size());
  FrameHeader header;
  header.frame = take<std::uint32_t>(message);
  header.view_sequence = take<std::uint32_t>(message);
  header.scene_sequence = take<std::uint32_t>(message);
  const auto format = take<std::uint16_t>(message);
  if (format > static_cast<std::uint16_t>(FrameFormat::png)) return {};
  header.format = static_cast<FrameFormat>(format);
  header.final = (take<std::uint16_t>(message) & 1U) != 0;
  header.width = take<std::uint32_t>(message);
  header.height = take<std::uint32_t>(message);
  header.render_ms = std::bit_cast<float>(take<std::uint32_t>(message));
  header.encode_ms = std::bit_cast<float>(take<std::uint32_t>(message));
  header.bytes = take<std::uint32_t>(message);
  return header;
}

bool is_whole(const FrameHeader& header, std::string_view message) {
  return message.size() == frame_header_bytes + header.bytes;
}

}  // namespace motes::server
