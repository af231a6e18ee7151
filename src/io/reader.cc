// Finds a file's format, from its content and then from its name, and opens it.
#include "io/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/error.h"
#include "io/bytes.h"
#include "io/format.h"

namespace motes {

namespace {

/// The file's name in lower case, without the endings that compression adds.
std::string bare_name(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const std::string_view ending : {".gz", ".bz2", ".xz", ".zst"}) {
    if (name.ends_with(ending)) {
      name.resize(name.size() - ending.size());
      break;
    }
  }
  return name;
}

const Format* find_format(const std::filesystem::path& path, std::string_view head) {
  for (const Format& format : formats()) {
    if (format.matches(head)) return &format;
  }
  const std::string name = bare_name(path);
  for (const Format& format : formats()) {
    for (const std::string_view suffix : format.suffixes) {
      if (name.ends_with(suffix)) return &format;
    }
  }
  return nullptr;
}

std::string known_formats() {
  std::string list;
  for (const Format& format : formats()) {
    if (!list.empty()) list += ", ";
    list += format.name;
  }
  return list;
}

}  // namespace

std::unique_ptr<Trajectory> open_trajectory(const std::filesystem::path& path,
                                            const ReadOptions& options) {
  const std::string head = read_head(path);
  if (head.empty()) throw Error(path, "is empty; expected particles");
  const Format* format = find_format(path, head);
  if (format == nullptr) {
    throw Error(path, fmt::format("has an unknown format; expected one of {}", known_formats()));
  }
  return format->open(path, options);
}

void throw_no_such_frame(const std::filesystem::path& path, std::size_t frame,
                         std::size_t num_frames) {
  throw Error(path, num_frames == 1
                        ? fmt::format("has no frame {}; expected 0, the only one", frame)
                        : fmt::format("has no frame {}; expected 0 to {}, for it has {} frames",
                                      frame, num_frames - 1, num_frames));
}

}  // namespace motes
