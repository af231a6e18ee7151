// A file with a given content, or a free path, that a test leaves no trace of.
#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

#include "support/temporary_directory.h"

namespace motes {

class TemporaryFile {
 public:
  /// `name` decides what the name ends in: readers may look at it.
  explicit TemporaryFile(std::string_view name, std::string_view content = {}) {
    path_ = directory_ / name;
    write(content);
  }

  const std::filesystem::path& path() const { return path_; }
  void write(std::string_view content) const {
    std::ofstream out(path_, std::ios::binary);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
  }

 private:
  TemporaryDirectory directory_;
  std::filesystem::path path_;
};

}  // namespace motes
