// The one folder that clients may look into.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace motes::server {

struct FolderEntry {
  std::string name;
  bool is_folder = false;
  std::uint64_t size = 0;  ///< bytes of a file
};

/// A folder with all that lies in it, symbolic links to elsewhere excepted.
class Folder {
 public:
  /// Throws Error if there is no such folder.
  explicit Folder(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }  ///< absolute, without links
  /// The file or folder at `path`, relative to the folder or absolute, with all links followed.
  /// Throws Error if it is not there or lies outside; which of the two is not told.
  std::filesystem::path resolve(std::string_view path) const;
  /// What is in the folder at `path`: files and folders that resolve() takes, folders first, sorted
  /// by name; hidden ones (.name) left out. Throws Error as resolve() does.
  std::vector<FolderEntry> list(std::string_view path) const;
  bool contains(const std::filesystem::path& canonical) const;

 private:
  std::filesystem::path path_;
};

}  // namespace motes::server
