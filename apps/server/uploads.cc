// A folder that goes away with its owner.
#include "server/uploads.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <system_error>

#include "core/error.h"

namespace motes::server {

namespace fs = std::filesystem;

Uploads::Uploads() {
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
  return folder / fs::path(std::string(name));
}

}  // namespace motes::server
