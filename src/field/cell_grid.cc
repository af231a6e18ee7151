#include "field/cell_grid.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>

namespace motes {
namespace {

constexpr std::size_t grain = 1 << 14;
constexpr double max_entries_per_kernel = 32, max_cells_per_kernel = 4;

bool is_in_a_field(const KernelSet& kernels, std::size_t i) {
  return kernels.field_of(i) < kernels.fields.size();
}

double support_of(const KernelSet& kernels, std::size_t i) {
  const std::size_t f = kernels.field_of(i);
  return kernels.fields[f].kernel.support() * kernels.radius[i];
}

/// The support that half of some kernels' are smaller than; nullopt if none is in a field.
std::optional<double> typical_support(const KernelSet& kernels) {
  std::vector<double> supports;
  const std::size_t stride = 1 + kernels.size() / 65536;
  for (std::size_t i = 0; i < kernels.size(); i += stride) {
    if (is_in_a_field(kernels, i)) supports.push_back(support_of(kernels, i));
  }
  for (std::size_t i = 0; supports.empty(); ++i) {
    if (i == kernels.size()) return std::nullopt;
    if (is_in_a_field(kernels, i)) supports.push_back(support_of(kernels, i));
  }
  const auto middle = supports.begin() + static_cast<std::ptrdiff_t>(supports.size() / 2);
  std::nth_element(supports.begin(), middle, supports.end());
  return *middle;
}

/// Cells along each axis that a kernel's support reaches, first and last.
struct CellRange {
  std::array<std::int64_t, 3> first, last;
  double entries() const {
    double product = 1;
    for (std::size_t i = 0; i < 3; ++i) product *= static_cast<double>(last[i] - first[i] + 1);
    return product;
  }
};

CellRange cells_around(const KernelSet& kernels, const CellGrid& grid, std::size_t k) {
  // Samples' places are rounded.
  const double reach = support_of(kernels, k) * (1 + 1e-5);
  const double center[3] = {kernels.x[k], kernels.y[k], kernels.z[k]};
  CellRange range;
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = center[i] - grid.corner[static_cast<int>(i)];
    const auto cell = [&](double place) {
      const double last = static_cast<double>(grid.count[i] - 1);
      return static_cast<std::int64_t>(std::clamp(std::floor(place * grid.per_length), 0.0, last));
    };
    range.first[i] = cell(at - reach);
    range.last[i] = cell(at + reach);
  }
  return range;
}

/// Calls visit(cell) for the cells that kernel k reaches.
template <class Visit>
void for_cells(const CellGrid& grid, const CellRange& range, Visit&& visit) {
  for (std::int64_t z = range.first[2]; z <= range.last[2]; ++z) {
    for (std::int64_t y = range.first[1]; y <= range.last[1]; ++y) {
      const std::int64_t row = (z * grid.count[1] + y) * grid.count[0];
      for (std::int64_t x = range.first[0]; x <= range.last[0]; ++x) {
        visit(static_cast<std::size_t>(row + x));
      }
    }
  }
}

/// Cells of that width over the box, without lists.
CellGrid lay_out(const Bounds3d& box, double width) {
  CellGrid grid;
  grid.corner = box.min;
  grid.per_length = 1 / width;
  const Vector3d sides = box.diagonal();
  for (std::size_t i = 0; i < 3; ++i) {
    // One more than fits, so that the far face of the box lies in a cell.
    grid.count[i] = static_cast<std::int64_t>(sides[static_cast<int>(i)] / width) + 1;
  }
  return grid;
}

double cells_of(const CellGrid& grid) {
  return static_cast<double>(grid.count[0]) * static_cast<double>(grid.count[1]) *
         static_cast<double>(grid.count[2]);
}

double entries_of(const KernelSet& kernels, const CellGrid& grid) {
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, kernels.size(), grain), 0.0,
      [&](const auto& range, double sum) {
        for (std::size_t k = range.begin(); k != range.end(); ++k) {
          if (is_in_a_field(kernels, k)) sum += cells_around(kernels, grid, k).entries();
        }
        return sum;
      },
      std::plus<>());
}

CellGrid choose_cells(const KernelSet& kernels, double support, const Bounds3d& box) {
  const auto n = static_cast<double>(kernels.size());
  double width = support * 2;
  const Vector3d sides = box.diagonal();
  const double longest = std::max({sides.x, sides.y, sides.z});
  // A huge empty box around few kernels has fewer cells.
  while (cells_of(lay_out(box, width)) > std::max(max_cells_per_kernel * n, 4096.0)) width *= 1.25;
  while (width < longest && entries_of(kernels, lay_out(box, width)) > max_entries_per_kernel * n) {
    width *= 1.5;
  }
  return lay_out(box, width);
}

}  // namespace

CellGrid build_cell_grid(const KernelSet& kernels) {
  const std::optional<double> support = typical_support(kernels);
  if (!support) return {};
  const Bounds3d file_box = kernels.box();
  const auto to_internal = [&](const Point3d& p) {
    return Point3d{} + kernels.length_scale * (p - kernels.origin);
  };
  CellGrid grid =
      choose_cells(kernels, *support, {to_internal(file_box.min), to_internal(file_box.max)});

  // Count each cell's kernels, then fill the lists; then sort each, whatever threads came first.
  std::vector<std::atomic<std::uint32_t>> counts(static_cast<std::size_t>(cells_of(grid)));
  const auto for_all_entries = [&](const auto& visit) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, kernels.size(), grain),
                      [&](const auto& range) {
                        for (std::size_t k = range.begin(); k != range.end(); ++k) {
                          if (!is_in_a_field(kernels, k)) continue;
                          for_cells(grid, cells_around(kernels, grid, k),
                                    [&](std::size_t cell) { visit(cell, k); });
                        }
                      });
  };
  for_all_entries([&](std::size_t cell, std::size_t) { ++counts[cell]; });
  grid.begin.resize(counts.size() + 1);
  for (std::size_t c = 0; c < counts.size(); ++c) grid.begin[c + 1] = grid.begin[c] + counts[c];
  grid.kernels.resize(grid.begin.back());
  for_all_entries([&](std::size_t cell, std::size_t k) {
    grid.kernels[grid.begin[cell] + --counts[cell]] = static_cast<std::uint32_t>(k);
  });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, counts.size(), 256), [&](const auto& range) {
    for (std::size_t c = range.begin(); c != range.end(); ++c) {
      const auto first = grid.kernels.begin();
      std::sort(first + static_cast<std::ptrdiff_t>(grid.begin[c]),
                first + static_cast<std::ptrdiff_t>(grid.begin[c + 1]));
    }
  });
  return grid;
}

}  // namespace motes
