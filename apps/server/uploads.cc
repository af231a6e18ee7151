// A folder that goes away with its owner.
#include "server/uploads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>
#include <system_error>

#include "core/error.h"

namespace motes::server {

namespace fs = std::filesystem;

Uploads::Uploads(std::uint64_t max_bytes) : max_bytes_(max_bytes) {
  std::error_code error;
  std::string pattern = (fs::temp_directory_path(error) / "motes-view-XXXXXX").string();
  if (error || mkdtemp(pattern.data()) == nullptr) {
    throw Error(pattern, "cannot make a folder for files that are dropped on the page");
  }
  path_ = fs::canonical(pattern);
}

Uploads::~Uploads() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

fs::path Uploads::place_for(std::string_view name) {
  constexpr std::size_t max_name = 200;
  name.remove_prefix(name.find_last_of("/\\") + 1);  // npos + 1 is 0
  if (name.empty() || name == "." || name == ".." || name.size() > max_name ||
      name.find('\0') != name.npos) {
    throw Error(fmt::format("'{}' is no name for a file", printable(name)));
  }
  const fs::path folder = path_ / std::to_string(++count_);
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) throw Error(folder, "cannot make a folder: " + error.message());
  files_.push_back({folder / fs::path(std::string(name))});
  return files_.back().place;
}

bool Uploads::grow(const fs::path& place, std::uint64_t bytes,
                   const std::vector<fs::path>& in_use) {
  const auto may_go = [&in_use](const File& file) {
    return file.complete && std::find(in_use.begin(), in_use.end(), file.place) == in_use.end();
  };
  std::uint64_t stay = 0;
  for (const File& file : files_) stay += may_go(file) ? 0 : file.bytes;
  if (bytes > max_bytes_ - stay) return false;
  for (auto file = files_.begin(); bytes > max_bytes_ - bytes_;) {
    file = may_go(*file) ? erase(file) : std::next(file);
  }
  bytes_ += bytes;
  of(place)->bytes += bytes;
  return true;
}

void Uploads::complete(const fs::path& place) { of(place)->complete = true; }

void Uploads::remove(const fs::path& place) {
  const auto file = of(place);
  if (file != files_.end()) erase(file);
}

std::optional<fs::path> Uploads::find(std::string_view name) const {
  const auto found = std::find_if(files_.rbegin(), files_.rend(), [name](const File& file) {
    return file.complete && file.place.filename() == name;
  });
  return found == files_.rend() ? std::nullopt : std::optional(found->place);
}

bool Uploads::contains(const fs::path& place) const {
  return std::any_of(files_.begin(), files_.end(),
                     [&place](const File& file) { return file.place == place; });
}

std::list<Uploads::File>::iterator Uploads::of(const fs::path& place) {
  return std::find_if(files_.begin(), files_.end(),
                      [&place](const File& file) { return file.place == place; });
}

std::list<Uploads::File>::iterator Uploads::erase(std::list<File>::iterator file) {
  bytes_ -= file->bytes;
  std::error_code ignored;
  fs::remove_all(file->place.parent_path(), ignored);
  return files_.erase(file);
}

}  // namespace motes::server
