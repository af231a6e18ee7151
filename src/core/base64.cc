// Three bytes are four characters.
#include "core/base64.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace motes {

namespace {

constexpr std::string_view alphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t no_digit = 255;

constexpr auto digits = [] {
  std::array<std::uint8_t, 256> table{};
  table.fill(no_digit);
  for (std::size_t i = 0; i < alphabet.size(); ++i) {
    table[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
  }
  return table;
}();

}  // namespace

std::string encode_base64(std::string_view bytes) {
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= n ? alphabet[word >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

std::optional<std::string> decode_base64(std::string_view text, std::size_t most_bytes) {
  std::string out;
  out.reserve(std::min(most_bytes, text.size() / 4 * 3 + 3));
  std::uint32_t word = 0;
  int num_bits = 0;
  for (const char c : text) {
    if (out.size() >= most_bytes) break;
    const std::uint8_t digit = digits[static_cast<unsigned char>(c)];
    if (digit != no_digit) {
      word = word << 6 | digit;
      num_bits += 6;
      if (num_bits >= 8) {
        num_bits -= 8;
        out += static_cast<char>(word >> num_bits & 255);
      }
    } else if (c == '=') {
      num_bits = 0;
    } else if (static_cast<unsigned char>(c) > ' ') {
      return std::nullopt;
    }
  }
  return out;
}

}  // namespace motes
