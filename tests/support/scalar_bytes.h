// Numbers as the bytes of a binary file.
#pragma once

#include <algorithm>
#include <bit>
#include <string>
#include <vector>

namespace motes {

template <class T>
std::string scalar_bytes(const std::vector<double>& values, bool big_endian) {
  std::string out;
  for (const double value : values) {
    const T number = static_cast<T>(value);
    std::string bytes(reinterpret_cast<const char*>(&number), sizeof(T));
    if (big_endian != (std::endian::native == std::endian::big)) {
      std::reverse(bytes.begin(), bytes.end());
    }
    out += bytes;
  }
  return out;
}

}  // namespace motes
