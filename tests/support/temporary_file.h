// A file with a given content, or a free path, that a test leaves no trace of.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace motes {

class TemporaryFile {
 public:
  /// `name` decides what the name ends in: readers may look at it.
  explicit TemporaryFile(std::string_view name, std::string_view content = {}) {
    static int counter = 0;
    directory_ = std::filesystem::path(testing::TempDir()) /
                 ("motes-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
    std::filesystem::create_directories(directory_);
    path_ = directory_ / name;
    write(content);
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void write(std::string_view content) const {
    std::ofstream out(path_, std::ios::binary);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
  }

 private:
  std::filesystem::path directory_, path_;
};

}  // namespace motes
