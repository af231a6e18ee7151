// Files that clients send: kept in a private folder until the server ends.
#pragma once

#include <filesystem>
#include <string_view>

namespace motes::server {

class Uploads {
 public:
  /// Makes the folder, for this user alone, where temporary files go. Throws Error.
  Uploads();
  ~Uploads();
  Uploads(const Uploads&) = delete;
  Uploads& operator=(const Uploads&) = delete;

  /// A path for a file of that name, in a folder of its own; of the name only what follows the last
  /// slash counts. Throws Error if the name is no name.
  std::filesystem::path place_for(std::string_view name);
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int count_ = 0;
};

}  // namespace motes::server
