// Finds a file's format, from its content and then from its name, and opens it.
#include "io/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/bytes.h"
#include "io/format.h"
#include "io/grid_format.h"
#include "io/grid_reader.h"

namespace motes {

namespace {

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

/// A well-known format that is not read: users learn more from its name than from "unknown".
struct ForeignFormat {
  std::string_view name;
  std::vector<std::pair<std::size_t, std::string_view>> marks;  ///< bytes at offsets; one is enough
  std::vector<std::string_view> suffixes;
};

const std::vector<ForeignFormat>& foreign_formats() {
  using std::string_view_literals::operator""sv;
  static const std::vector<ForeignFormat> table{
      {"GADGET binary", {{0, "\0\1\0\0"sv}, {0, "\0\0\1\0"sv}, {4, "HEAD"sv}}, {".gadget"}},
      {"XTC", {{0, "\0\0\x07\xcb"sv}, {0, "\0\0\x07\xe7"sv}}, {".xtc"}},
      {"TRR", {{0, "\0\0\x07\xc9"sv}}, {".trr"}},
      {"DCD", {{4, "CORD"sv}, {8, "CORD"sv}}, {".dcd"}},
      {"GSD", {{0, "\xdf\x65\xdf\x65\xdf\x65\xdf\x65"sv}}, {".gsd"}},
      {"NetCDF", {{0, "CDF\1"sv}, {0, "CDF\2"sv}, {0, "CDF\5"sv}}, {}},
      {"TIPSY", {}, {".tipsy", ".tbin"}},
  };
  return table;
}

const ForeignFormat* find_foreign_format(const std::filesystem::path& path, std::string_view head) {
  const std::string name = bare_name(path);
  const auto is_marked = [&](const auto& mark) {
    return head.substr(std::min(mark.first, head.size())).starts_with(mark.second);
  };
  const auto is_named = [&](std::string_view suffix) { return name.ends_with(suffix); };
  const auto& table = foreign_formats();
  auto found = std::find_if(table.begin(), table.end(), [&](const ForeignFormat& format) {
    return std::any_of(format.marks.begin(), format.marks.end(), is_marked);
  });
  if (found == table.end()) {
    found = std::find_if(table.begin(), table.end(), [&](const ForeignFormat& format) {
      return std::any_of(format.suffixes.begin(), format.suffixes.end(), is_named);
    });
  }
  return found == table.end() ? nullptr : &*found;
}

/// Of particles, then those of grids alone.
std::string known_formats() {
  std::vector<std::string_view> names;
  for (const Format& format : formats()) names.push_back(format.name);
  for (const GridFormat& format : grid_formats()) {
    if (std::find(names.begin(), names.end(), format.name) == names.end()) {
      names.push_back(format.name);
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::unique_ptr<Trajectory> open_trajectory(const std::filesystem::path& path,
                                            const ReadOptions& options) {
  const std::string head = read_head(path);
  if (head.empty()) throw Error(path, "is empty; expected particles");
  const Format* format = find_format(path, head);
  if (format == nullptr) {
    if (is_grid_file(path)) throw Error(path, "is a grid without particles; expected particles");
    if (const ForeignFormat* foreign = find_foreign_format(path, head)) {
      throw Error(path, fmt::format("looks like {}, which Motes does not read; expected one of {}",
                                    foreign->name, known_formats()));
    }
    throw Error(path, fmt::format("has an unknown format; expected one of {}", known_formats()));
  }
  return format->open(path, options);
}

bool has_particles(const std::filesystem::path& path) {
  const std::string head = read_head(path);
  const Format* format = head.empty() ? nullptr : find_format(path, head);
  return format != nullptr && format->open(path, {})->read_frame(0).size() > 0;
}

void throw_no_such_frame(const std::filesystem::path& path, std::size_t frame,
                         std::size_t num_frames) {
  throw Error(path, num_frames == 1
                        ? fmt::format("has no frame {}; expected 0, the only one", frame)
                        : fmt::format("has no frame {}; expected 0 to {}, for it has {} frames",
                                      frame, num_frames - 1, num_frames));
}

}  // namespace motes
