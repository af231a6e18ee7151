// Prefiltering, axis by axis: Unser, Aldroubi & Eden, "B-spline signal processing", IEEE Trans.
// Signal Processing 41 (1993).
#include "grid/coefficients.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <vector>

namespace motes {

namespace {

constexpr std::size_t line_floats = cache_line_bytes / sizeof(float);

/// At least `floats`, in whole cache lines, an odd number of them.
std::size_t odd_lines(std::size_t floats) {
  const std::size_t lines = (floats + line_floats - 1) / line_floats;
  return (lines | 1) * line_floats;
}

/// Samples with their border along an axis.
std::size_t bordered(const Grid& grid, std::size_t axis) {
  return grid.dims[axis] + (grid.periodic ? 3 : 2);
}

/// Copies the samples into the middle.
Coefficients copy_samples(const Grid& grid) {
  Coefficients out;
  out.row = odd_lines(bordered(grid, 0));
  out.plane = odd_lines(out.row * bordered(grid, 1));
  out.values.resize(out.plane * bordered(grid, 2));
  std::atomic<std::size_t> num_not_finite = 0;
  tbb::parallel_for(std::size_t{0}, grid.dims[2], [&](std::size_t k) {
    std::size_t bad = 0;
    for (std::size_t j = 0; j < grid.dims[1]; ++j) {
      const float* const from = grid.values.data() + grid.index(0, j, k);
      float* const to = out.values.data() + (k + 1) * out.plane + (j + 1) * out.row + 1;
      for (std::size_t i = 0; i < grid.dims[0]; ++i) {
        const bool finite = std::isfinite(from[i]);
        to[i] = finite ? from[i] : 0.0F;
        bad += finite ? 0 : 1;
      }
    }
    num_not_finite += bad;
  });
  out.num_not_finite = num_not_finite;
  return out;
}

/// Fills the border along one axis from the numbers within: `line` is number -1, `n` numbers lie
/// `stride` floats apart.
void extend_line(float* line, std::size_t n, std::size_t stride, bool periodic) {
  float* const first = line + stride;
  float* const end = first + n * stride;
  if (periodic) {
    line[0] = end[-static_cast<std::ptrdiff_t>(stride)];
    end[0] = first[0];
    end[stride] = n > 1 ? first[stride] : first[0];
  } else {
    const auto s = static_cast<std::ptrdiff_t>(stride);
    line[0] = 2 * first[0] - first[s];
    end[0] = 2 * end[-s] - end[-2 * s];
  }
}

/// Axis by axis, each over the borders of those before.
void extend_borders(const Grid& grid, Coefficients& c) {
  const std::size_t nx = bordered(grid, 0), ny = bordered(grid, 1);
  tbb::parallel_for(std::size_t{0}, grid.dims[2], [&](std::size_t k) {
    float* const plane = c.values.data() + (k + 1) * c.plane;
    for (std::size_t j = 0; j < grid.dims[1]; ++j) {
      extend_line(plane + (j + 1) * c.row, grid.dims[0], 1, grid.periodic);
    }
    for (std::size_t i = 0; i < nx; ++i) {
      extend_line(plane + i, grid.dims[1], c.row, grid.periodic);
    }
  });
  tbb::parallel_for(std::size_t{0}, ny, [&](std::size_t j) {
    for (std::size_t i = 0; i < nx; ++i) {
      extend_line(c.values.data() + j * c.row + i, grid.dims[2], c.plane, grid.periodic);
    }
  });
}

/// Solves c[i-1] + 4 c[i] + c[i+1] = 6 f[i] for lines of one length, some side by side.
class LineFilter {
 public:
  static constexpr std::size_t width = 16;  ///< lines side by side

  LineFilter(std::size_t n, bool periodic) : n_(n), periodic_(periodic) {
    if (periodic) return;
    // Elimination of what is below the diagonal (Thomas): the factors are those of every line.
    factors_.resize(n);
    for (std::size_t i = 1; i < n; ++i) factors_[i] = 1 / (4 - factors_[i - 1]);
  }

  /// Line l begins at first + l * side and has its numbers `stride` apart; `buffer` is for n *
  /// width.
  void run(float* first, std::size_t stride, std::size_t count, std::size_t side,
           std::vector<double>& buffer) const {
    buffer.resize(n_ * width);
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t l = 0; l < count; ++l) {
        buffer[i * width + l] = first[i * stride + l * side];
      }
    }
    if (periodic_) {
      solve_periodic(buffer);
    } else {
      solve_natural(buffer);
    }
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t l = 0; l < count; ++l) {
        first[i * stride + l * side] = static_cast<float>(buffer[i * width + l]);
      }
    }
  }

 private:
  /// No second derivative at the ends: there the coefficients are the samples.
  void solve_natural(std::vector<double>& c) const {
    const auto at = [&](std::size_t i) { return c.data() + i * width; };
    for (std::size_t i = 1; i + 1 < n_; ++i) {
      for (std::size_t l = 0; l < width; ++l) {
        at(i)[l] = (6 * at(i)[l] - at(i - 1)[l]) * factors_[i];
      }
    }
    for (std::size_t i = n_ - 1; i-- > 1;) {
      for (std::size_t l = 0; l < width; ++l) at(i)[l] -= factors_[i] * at(i + 1)[l];
    }
  }

  /// Forth and back by the pole z of the filter, whose powers, summed over the periods, start both.
  void solve_periodic(std::vector<double>& c) const {
    const auto at = [&](std::size_t i) { return c.data() + (i % n_) * width; };
    const double z = std::sqrt(3.0) - 2;
    constexpr std::size_t most_terms = 64;  // |z|^64 = 3e-37
    const std::size_t terms = std::min(n_, most_terms);
    const double whole = 1 - (terms == n_ ? std::pow(z, static_cast<double>(n_)) : 0);
    for (std::size_t l = 0; l < width; ++l) {
      double start = 0, power = 1 / whole;
      for (std::size_t i = 0; i < terms; ++i, power *= z) start += power * at(n_ - i)[l];
      at(0)[l] = start;
    }
    for (std::size_t i = 1; i < n_; ++i) {
      for (std::size_t l = 0; l < width; ++l) at(i)[l] += z * at(i - 1)[l];
    }
    for (std::size_t l = 0; l < width; ++l) {
      double start = 0, power = -z / whole;
      for (std::size_t i = 0; i < terms; ++i, power *= z) start += power * at(n_ - 1 + i)[l];
      at(n_ - 1)[l] = start;
    }
    for (std::size_t i = n_ - 1; i-- > 0;) {
      for (std::size_t l = 0; l < width; ++l) at(i)[l] = z * (at(i + 1)[l] - at(i)[l]);
    }
    for (double& v : c) v *= 6;
  }

  std::size_t n_;
  bool periodic_;
  std::vector<double> factors_;
};

/// Filters the lines along one axis: sheets of them in parallel, within a sheet those side by side.
void filter_axis(const Grid& grid, std::size_t axis, Coefficients& c) {
  const std::array<std::size_t, 3> strides{1, c.row, c.plane};
  const std::size_t side = axis == 0 ? 1 : 0, sheet = axis == 2 ? 1 : 2;
  const LineFilter filter(grid.dims[axis], grid.periodic);
  float* const first = c.values.data() + c.plane + c.row + 1;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grid.dims[sheet]), [&](const auto& sheets) {
    std::vector<double> buffer;
    for (std::size_t s = sheets.begin(); s != sheets.end(); ++s) {
      for (std::size_t l = 0; l < grid.dims[side]; l += LineFilter::width) {
        const std::size_t count = std::min(LineFilter::width, grid.dims[side] - l);
        filter.run(first + s * strides[sheet] + l * strides[side], strides[axis], count,
                   strides[side], buffer);
      }
    }
  });
}

}  // namespace

Coefficients sample_coefficients(const Grid& grid) {
  Coefficients out = copy_samples(grid);
  extend_borders(grid, out);
  return out;
}

Coefficients spline_coefficients(const Grid& grid) {
  Coefficients out = copy_samples(grid);
  for (std::size_t axis = 0; axis < 3; ++axis) filter_axis(grid, axis, out);
  extend_borders(grid, out);
  return out;
}

}  // namespace motes
