// Any bytes as a file that a reader can open.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

namespace motes {

/// A file in memory, and the name under which it can be opened.
struct MemoryFile {
  const int descriptor = memfd_create("input", 0);
  const std::string path = "/proc/self/fd/" + std::to_string(descriptor);

  void assign(const std::uint8_t* data, std::size_t size) const {
    const auto length = static_cast<ssize_t>(size);
    if (ftruncate(descriptor, 0) != 0 || pwrite(descriptor, data, size, 0) != length) std::abort();
  }
};

}  // namespace motes
