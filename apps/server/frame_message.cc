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

}  // namespace

std::string frame_message(const FrameHeader& header, std::string_view image) {
  std::string out;
  out.reserve(frame_header_bytes + image.size());
  out += "MTF1";
  append(out, header.frame);
  append(out, header.view_sequence);
  append(out, header.scene_sequence);
  append(out, static_cast<std::uint16_t>(header.format));
  append(out, static_cast<std::uint16_t>(header.final ? 1 : 0));
  append(out, header.width);
  append(out, header.height);
  append(out, std::bit_cast<std::uint32_t>(header.render_ms));
  append(out, std::bit_cast<std::uint32_t>(header.encode_ms));
  assert(out.size() == frame_header_bytes);
  out += image;
  return out;
}

}  // namespace motes::server
