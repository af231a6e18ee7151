// Bytes as text (RFC 4648, section 4).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace motes {

/// With padding, in one line.
std::string encode_base64(std::string_view bytes);

/// The bytes that `text` stands for, but no more than the first `most_bytes`; nothing if a
/// character before them is not of the alphabet. Blanks are passed over. Text behind padding is
/// another part: the bytes of all parts follow each other.
std::optional<std::string> decode_base64(std::string_view text, std::size_t most_bytes);

}  // namespace motes
