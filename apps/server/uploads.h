// Files that clients send: kept in a private folder until the server ends or others need the room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <optional>
#include <string_view>
#include <vector>

namespace motes::server {

class Uploads {
 public:
  /// Makes the folder, for this user alone, where temporary files go; all files together get at
  /// most `max_bytes` of the disk. Throws Error.
  explicit Uploads(std::uint64_t max_bytes);
  ~Uploads();
  Uploads(const Uploads&) = delete;
  Uploads& operator=(const Uploads&) = delete;

  /// A path for a file of that name, in a folder of its own; of the name only what follows the last
  /// slash counts. The file has no room yet. Throws Error if the name is no name.
  std::filesystem::path place_for(std::string_view name);
  /// Gives the file at `place` so many bytes more. For that others have to go that are complete and
  /// not `in_use`, oldest first, but only where that is enough; false: there is no room.
  bool grow(const std::filesystem::path& place, std::uint64_t bytes,
            const std::vector<std::filesystem::path>& in_use);
  /// All of the file is there.
  void complete(const std::filesystem::path& place);
  void remove(const std::filesystem::path& place);

  /// The newest complete file of that name.
  std::optional<std::filesystem::path> find(std::string_view name) const;
  bool contains(const std::filesystem::path& place) const;
  const std::filesystem::path& path() const { return path_; }

 private:
  struct File {
    std::filesystem::path place;
    std::uint64_t bytes = 0;
    bool complete = false;
  };

  std::list<File>::iterator of(const std::filesystem::path& place);
  std::list<File>::iterator erase(std::list<File>::iterator file);

  std::filesystem::path path_;
  const std::uint64_t max_bytes_;
  std::uint64_t bytes_ = 0;  ///< of all files
  std::list<File> files_;    ///< oldest first
  int count_ = 0;
};

}  // namespace motes::server
