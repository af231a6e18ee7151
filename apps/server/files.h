// What clients may name: the shared folder, what they have sent, and what the user has opened.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "server/folder.h"
#include "server/uploads.h"

namespace motes::server {

/// The files that a scene names.
std::vector<std::filesystem::path> files_of(const Scene& scene);

/// Safe from any thread.
class Files {
 public:
  /// Throws Error as Folder and Uploads do.
  Files(const std::filesystem::path& folder, std::uint64_t max_kept_bytes)
      : folder_(folder), uploads_(max_kept_bytes) {}

  const Folder& folder() const { return folder_; }
  /// Lets clients name all files of a scene that the user has opened.
  void allow(const Scene& scene);

  /// The file at `path`, relative to the folder or absolute. Throws Error as Folder::resolve()
  /// does.
  std::filesystem::path resolve(std::string_view path) const;
  /// What clients send, while nobody else looks at it.
  template <class Work>
  auto with_uploads(Work&& work) {
    const std::lock_guard lock(mutex_);
    return work(uploads_);
  }

  /// Below which the files of clients are, each in a folder of its own.
  const std::filesystem::path& uploads_folder() const { return uploads_.path(); }

  /// A scene from JSON that is not trusted, its paths relative to `directory` or names of files
  /// that were sent: none of them is opened that resolve() does not take. Throws Error as
  /// parse_scene() and resolve() do.
  Scene parse_scene(std::string_view json, const std::filesystem::path& directory) const;
  /// The scene in `path`, as resolve() has found it, or of the data in it. Throws Error.
  Scene open_scene(const std::filesystem::path& path) const;

 private:
  std::filesystem::path resolve_in_scene(const std::filesystem::path& directory,
                                         const std::string& path) const;

  Folder folder_;
  mutable std::mutex mutex_;
  std::set<std::filesystem::path> allowed_;  ///< canonical
  Uploads uploads_;
};

}  // namespace motes::server
