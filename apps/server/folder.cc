// Paths that stay inside.
#include "server/folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/error.h"

namespace motes::server {

namespace fs = std::filesystem;

namespace {

/// A listing is for people; a folder of millions of files would only choke their browser.
constexpr std::size_t max_entries = 10000;

bool is_openable(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) || fs::is_regular_file(path, error);
}

}  // namespace

Folder::Folder(const fs::path& path) {
  std::error_code error;
  path_ = fs::canonical(path.empty() ? "." : path, error);
  if (error || !fs::is_directory(path_, error)) {
    throw Error(path, "expected a folder that can be read");
  }
}

bool Folder::contains(const fs::path& canonical) const {
  const auto [folder_end, rest] =
      std::mismatch(path_.begin(), path_.end(), canonical.begin(), canonical.end());
  return folder_end == path_.end();
}

fs::path Folder::resolve(std::string_view path) const {
  const std::string shown = printable(path, 400);
  std::error_code error;
  // An absolute path replaces the folder; the null byte would end it early for the system.
  fs::path found = path.find('\0') == path.npos
                       ? fs::canonical(path_ / fs::path(std::string(path)), error)
                       : fs::path();
  if (error || found.empty() || !contains(found) || !is_openable(found)) {
    throw Error(fmt::format("{}: there is no such file in the folder that is shared", shown));
  }
  return found;
}

std::vector<FolderEntry> Folder::list(std::string_view path) const {
  const fs::path folder = resolve(path);
  std::error_code error;
  fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, error);
  if (error) throw Error(fmt::format("{}: expected a folder", printable(path, 400)));
  std::vector<FolderEntry> entries;
  for (; it != fs::directory_iterator() && entries.size() < max_entries; it.increment(error)) {
    if (error) break;
    const std::string name = it->path().filename().string();
    const fs::path target = fs::canonical(it->path(), error);
    if (error || name.starts_with('.') || !contains(target) || !is_openable(target)) continue;
    const bool is_folder = fs::is_directory(target, error);
    entries.push_back({name, is_folder, is_folder ? 0 : fs::file_size(target, error)});
  }
  std::sort(entries.begin(), entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    return a.is_folder != b.is_folder ? a.is_folder : a.name < b.name;
  });
  return entries;
}

}  // namespace motes::server
