// Real files that may lie beside the checkout; a test that needs one skips where it is absent.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>

namespace motes {

/// The directory named by MOTES_SHARED_DATA, else ../shared/data beside the source directory.
inline std::filesystem::path shared_data_dir() {
  const char* dir = std::getenv("MOTES_SHARED_DATA");
  return dir != nullptr ? std::filesystem::path(dir)
                        : std::filesystem::path(MOTES_SOURCE_DIR) / ".." / "shared" / "data";
}

/// A file of that directory, if it is there: `path` is for example "files/gro/lysozyme.gro".
inline std::optional<std::filesystem::path> shared_file(std::string_view path) {
  const std::filesystem::path file = shared_data_dir() / path;
  if (!std::filesystem::exists(file)) return std::nullopt;
  return file;
}

}  // namespace motes
