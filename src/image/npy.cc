// The NPY format, version 1.0 (NumPy's documentation of numpy.lib.format).
#include <fmt/format.h>

#include <bit>

#include "image/encode.h"

namespace motes {

static_assert(std::endian::native == std::endian::little, "'<f4' is written straight from memory");

std::string npy_header(const Framebuffer& framebuffer) {
  std::string dictionary =
      fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}, 4), }}",
                  framebuffer.height, framebuffer.width);
  // Magic, version and length take 10 bytes; all together is padded to a multiple of 64.
  constexpr std::size_t prefix = 10, alignment = 64;
  const std::size_t unpadded = prefix + dictionary.size() + 1;
  dictionary.append((alignment - unpadded % alignment) % alignment, ' ');
  dictionary += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(dictionary.size() & 0xff);
  header += static_cast<char>(dictionary.size() >> 8);
  return header + dictionary;
}

}  // namespace motes
