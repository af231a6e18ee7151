// Finds a grid's format, from its content and then from its name.
#include "io/grid_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/error.h"
#include "io/bytes.h"
#include "io/grid_format.h"

namespace motes {

namespace {

const GridFormat* find_grid_format(const std::filesystem::path& path, std::string_view head) {
  for (const GridFormat& format : grid_formats()) {
    if (format.matches(head)) return &format;
  }
  const std::string name = bare_name(path);
  for (const GridFormat& format : grid_formats()) {
    for (const std::string_view suffix : format.suffixes) {
      if (name.ends_with(suffix)) return &format;
    }
  }
  return nullptr;
}

}  // namespace

const std::vector<GridFormat>& grid_formats() {
  static const std::vector<GridFormat> table{nrrd_format(), vti_format(), cube_grid_format(),
                                             vasp_grid_format()};
  return table;
}

void check_steps(const std::filesystem::path& file, const Grid& grid) {
  const auto& [a, b, c] = grid.steps;
  const double volume = std::abs(dot(a, cross(b, c)));
  // Less than the rounding of coordinates with some digits can make of parallel steps.
  const double least = 1e-9 * length(a) * length(b) * length(c);
  const Point3d& o = grid.origin;
  if (!(volume > least) || !std::isfinite(volume + o.x + o.y + o.z)) {
    throw Error(file,
                "has steps between its samples that span no volume; expected three vectors "
                "that are not in one plane");
  }
}

std::vector<Grid> read_grids(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string head = read_head(path);
  if (head.empty()) throw Error(path, "is empty; expected a grid");
  const GridFormat* format = find_grid_format(path, head);
  if (format != nullptr) return format->read(path, options);
  std::string known;
  for (const GridFormat& f : grid_formats())
    known += fmt::format("{}{}", known.empty() ? "" : ", ", f.name);
  throw Error(path, fmt::format("is no grid of a known format; expected one of {}", known));
}

std::string_view grid_format(const std::filesystem::path& path) {
  return find_grid_format(path, read_head(path))->name;
}

bool is_grid_file(const std::filesystem::path& path) {
  const std::string head = read_head(path);
  const GridFormat* format = head.empty() ? nullptr : find_grid_format(path, head);
  if (format == nullptr) return false;
  return format->has_grid == nullptr || !format->matches(head) || format->has_grid(path);
}

}  // namespace motes
