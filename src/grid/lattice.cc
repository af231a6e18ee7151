#include "grid/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/error.h"

namespace motes {

namespace {

constexpr double most_along_axis = 1 << 24;

std::string readable_bytes(double bytes) {
  const char* const units[] = {"bytes", "kB", "MB", "GB", "TB", "PB", "EB"};
  std::size_t unit = 0;
  while (bytes >= 999.5 && unit + 1 < std::size(units)) {
    bytes /= 1000;
    ++unit;
  }
  return fmt::format("{:.3g} {}", bytes, units[unit]);
}

/// x rounded up to three digits.
double round_up(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 2);
  return std::ceil(x / unit) * unit;
}

/// A size at which the samples fit, or close to the smallest such.
double fitting_size(const Lattice& lattice, std::size_t num_fields, double limit) {
  const Vector3d extent{static_cast<double>(lattice.dims[0] - 1) * lattice.step.x,
                        static_cast<double>(lattice.dims[1] - 1) * lattice.step.y,
                        static_cast<double>(lattice.dims[2] - 1) * lattice.step.z};
  const auto bytes_at = [&](double size) {
    double bytes = sizeof(float) * static_cast<double>(num_fields);
    for (int a = 0; a < 3; ++a) bytes *= std::ceil(extent[a] / size) + 1;
    return bytes;
  };
  double size = std::cbrt(extent.x * extent.y * extent.z * sizeof(float) *
                          static_cast<double>(num_fields) / limit);
  while (bytes_at(round_up(size)) > limit) size *= 1.02;
  return round_up(size);
}

}  // namespace

Lattice lattice_of_size(const Bounds3d& box, double voxel_size) {
  assert(!box.empty() && voxel_size > 0);
  Lattice lattice;
  lattice.step = {voxel_size, voxel_size, voxel_size};
  for (int a = 0; a < 3; ++a) {
    const double extent = box.diagonal()[a];
    // (where the extent is a whole number of steps, rounding must not make it one more)
    const double steps = std::max(1., std::ceil(extent / voxel_size * (1 - 1e-12)));
    if (steps >= most_along_axis) {
      throw Error(
          fmt::format("voxel size {}: {:.3g} samples along an axis, expected at most {:.0f}",
                      voxel_size, steps + 1, most_along_axis));
    }
    lattice.dims[static_cast<std::size_t>(a)] = static_cast<std::size_t>(steps) + 1;
    lattice.origin[a] = box.center()[a] - 0.5 * steps * voxel_size;
  }
  return lattice;
}

Lattice lattice_of_counts(const Bounds3d& box, const std::array<std::size_t, 3>& dims) {
  assert(!box.empty());
  const Vector3d extent = box.diagonal();
  const auto step = [&](std::size_t a) {
    assert(dims[a] >= 2);
    return extent[static_cast<int>(a)] / static_cast<double>(dims[a] - 1);
  };
  return {box.min, {step(0), step(1), step(2)}, dims};
}

double sample_bytes(const Lattice& lattice, std::size_t num_fields) {
  double bytes = sizeof(float) * static_cast<double>(num_fields);
  for (const std::size_t n : lattice.dims) bytes *= static_cast<double>(n);
  return bytes;
}

void expect_to_fit(const Lattice& lattice, std::size_t num_fields, std::uint64_t limit) {
  const double bytes = sample_bytes(lattice, num_fields);
  if (bytes <= static_cast<double>(limit)) return;
  const auto& dims = lattice.dims;
  const double least = 8 * sizeof(float) * static_cast<double>(num_fields);
  const std::string advice =
      static_cast<double>(limit) < least
          ? ""
          : fmt::format("; voxels of {:g} would fit",
                        fitting_size(lattice, num_fields, static_cast<double>(limit)));
  throw Error(
      fmt::format("a grid of {} x {} x {} samples{} takes {} of memory, there are {}{}", dims[0],
                  dims[1], dims[2], num_fields == 1 ? "" : fmt::format(" of {} fields", num_fields),
                  readable_bytes(bytes), readable_bytes(static_cast<double>(limit)), advice));
}

}  // namespace motes
