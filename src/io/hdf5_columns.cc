// Reads datasets in slices of rows, so that no column is in memory twice.
#include "io/hdf5_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "core/error.h"
#include "io/bytes.h"

namespace motes {

namespace {

constexpr std::uint64_t slice_rows = std::uint64_t{1} << 18;
constexpr float not_given = std::numeric_limits<float>::quiet_NaN();

/// Tells of progress over all the rows of all the datasets to read.
class RowProgress {
 public:
  RowProgress(const ReadOptions& options, const std::filesystem::path& path, std::uint64_t total)
      : progress_(options.progress), activity_(reading_activity(path)), total_(total) {}
  void add(std::uint64_t rows) {
    done_ += rows;
    if (progress_ == nullptr) return;
    progress_->update(activity_, static_cast<double>(done_) / static_cast<double>(total_));
  }

 private:
  Progress* progress_;
  std::string activity_;
  std::uint64_t total_, done_ = 0;
};

/// Reads the rows of one block's dataset with K values a row into K columns.
template <class T, std::size_t K>
void read_into(const Hdf5Block& block, std::string_view name,
               const std::array<std::vector<T>*, K>& columns, RowProgress& progress) {
  const std::string dataset = block.dataset(name);
  std::vector<T> slice;
  for (std::uint64_t row = 0; row < block.count; row += slice_rows) {
    const std::uint64_t num_rows = std::min(slice_rows, block.count - row);
    slice.resize(num_rows * K);
    block.file->read_rows(dataset, row, num_rows, slice.data());
    for (std::size_t k = 0; k < K; ++k) {
      T* out = columns[k]->data() + block.first + row;
      for (std::uint64_t i = 0; i < num_rows; ++i) out[i] = slice[i * K + k];
    }
    progress.add(num_rows);
  }
}

template <class T>
void read_positions(const std::vector<Hdf5Block>& blocks, std::string_view name,
                    std::uint64_t num_particles, RowProgress& progress, ParticleSet& particles) {
  std::vector<T> x(num_particles), y(num_particles), z(num_particles);
  for (const Hdf5Block& block : blocks) {
    read_into<T, 3>(block, name, {&x, &y, &z}, progress);
  }
  set_positions(particles, std::move(x), std::move(y), std::move(z));
}

/// A dataset that becomes properties: one, or three for a vector.
struct Column {
  std::string dataset;
  std::vector<std::string> properties;
  bool wanted = false;  ///< has a name that means something to Motes
};

/// Number of values a row, 1 or 3; 0 for what cannot become a property.
std::size_t values_per_row(const Hdf5Block& block, std::string_view name) {
  const std::string dataset = block.dataset(name);
  if (!block.has(name)) return 0;  // a group
  const Hdf5Type type = block.file->type(dataset);
  if (type == Hdf5Type::text || type == Hdf5Type::other) return 0;
  const std::vector<std::uint64_t> shape = block.file->shape(dataset);
  const bool scalar = shape.size() == 1 || (shape.size() == 2 && shape[1] == 1);
  const bool vector = shape.size() == 2 && shape[1] == 3;
  if (!scalar && !vector) return 0;
  if (shape[0] != block.count) {
    block.file->fail(
        dataset, fmt::format("has {} rows; expected {}, as many as there are positions", shape[0],
                             block.count));
  }
  return vector ? 3 : 1;
}

std::vector<std::string> property_names(std::string_view dataset, std::size_t num_values,
                                        const std::vector<ColumnName>& names, bool& wanted) {
  const auto it = std::find_if(names.begin(), names.end(), [&](const ColumnName& n) {
    return n.dataset == dataset && n.properties[1].empty() == (num_values == 1);
  });
  wanted = it != names.end();
  std::vector<std::string> result;
  for (std::size_t k = 0; k < num_values; ++k) {
    if (wanted) {
      result.emplace_back(it->properties[k]);
    } else {
      result.push_back(num_values == 1 ? std::string(dataset)
                                       : fmt::format("{}_{}", dataset, "xyz"[k]));
    }
  }
  return result;
}

std::vector<Column> find_columns(const std::vector<Hdf5Block>& blocks, std::string_view position,
                                 std::string_view id, const std::vector<ColumnName>& names) {
  std::map<std::string, std::size_t> widths;
  for (const Hdf5Block& block : blocks) {
    for (const std::string& name : block.file->members(block.group)) {
      if (name == position || name == id) continue;
      const std::size_t width = values_per_row(block, name);
      if (width == 0) continue;
      const auto [it, added] = widths.emplace(name, width);
      if (it->second != width) {
        block.file->fail(
            block.dataset(name),
            fmt::format("has {} values a row; expected {}, as elsewhere", width, it->second));
      }
    }
  }
  std::vector<Column> columns;
  for (const auto& [name, width] : widths) {
    Column column{name, {}, false};
    column.properties = property_names(name, width, names, column.wanted);
    columns.push_back(std::move(column));
  }
  std::stable_partition(columns.begin(), columns.end(), [](const Column& c) { return c.wanted; });
  return columns;
}

/// Drops the columns that do not fit into the memory for properties, with a warning.
void drop_what_is_too_much(std::vector<Column>& columns, std::uint64_t num_particles,
                           const ReadOptions& options) {
  constexpr std::uint64_t budget_bytes = std::uint64_t{2} << 30;
  std::uint64_t bytes = 0;
  std::vector<std::string> dropped;
  std::erase_if(columns, [&](const Column& column) {
    const std::uint64_t more = num_particles * sizeof(float) * column.properties.size();
    if (!column.wanted && bytes + more > budget_bytes) {
      dropped.push_back(column.dataset);
      return true;
    }
    bytes += more;
    return false;
  });
  warn_of_left_out(dropped, "for want of memory", options);
}

/// False, and nothing is added, if the column is of integers that floats may not tell apart.
bool read_properties(const std::vector<Hdf5Block>& blocks, const Column& column,
                     std::uint64_t num_particles, RowProgress& progress, ParticleSet& particles) {
  std::array<std::vector<float>, 3> values;
  for (std::size_t k = 0; k < column.properties.size(); ++k) {
    values[k].assign(num_particles, not_given);
  }
  bool integers = false;
  for (const Hdf5Block& block : blocks) {
    if (!block.has(column.dataset)) continue;
    integers |= block.file->type(block.dataset(column.dataset)) == Hdf5Type::integer;
    if (column.properties.size() == 1) {
      read_into<float, 1>(block, column.dataset, {&values[0]}, progress);
    } else {
      read_into<float, 3>(block, column.dataset, {&values[0], &values[1], &values[2]}, progress);
    }
  }
  if (integers && !column.wanted && std::any_of(values.begin(), values.end(), may_lack_digits)) {
    return false;
  }
  for (std::size_t k = 0; k < column.properties.size(); ++k) {
    particles.properties.push_back({column.properties[k], std::move(values[k])});
  }
  return true;
}

}  // namespace

bool may_lack_digits(const std::vector<float>& integers) {
  constexpr float first_gap = 1 << std::numeric_limits<float>::digits;
  return std::any_of(integers.begin(), integers.end(),
                     [](float value) { return std::abs(value) >= first_gap; });
}

void warn_of_left_out(const std::vector<std::string>& datasets, std::string_view reason,
                      const ReadOptions& options) {
  if (datasets.empty() || options.warnings == nullptr) return;
  const std::string names = fmt::format("{}", fmt::join(datasets, ", "));
  options.warnings->add(fmt::format("left out {}: {}", reason, printable(names, 200)));
}

std::string Hdf5Block::dataset(std::string_view name) const {
  return group == "/" ? std::string(name) : fmt::format("{}/{}", group, name);
}

std::uint64_t count_positions(const Hdf5File& file, const std::string& dataset) {
  const Hdf5Type type = file.type(dataset);
  const std::vector<std::uint64_t> shape = file.shape(dataset);
  if (shape.size() != 2 || shape[1] != 3 || type == Hdf5Type::text || type == Hdf5Type::other) {
    file.fail(dataset, "is no table of positions; expected n x 3 numbers");
  }
  return shape[0];
}

void read_columns(const std::vector<Hdf5Block>& blocks, std::string_view position,
                  std::string_view id, const std::vector<ColumnName>& names,
                  const ReadOptions& options, ParticleSet& particles) {
  if (blocks.empty()) return;
  const std::uint64_t num_particles = blocks.back().first + blocks.back().count;
  std::vector<Column> columns = find_columns(blocks, position, id, names);
  drop_what_is_too_much(columns, num_particles, options);
  RowProgress progress(options, blocks.front().file->path(), num_particles * (columns.size() + 2));

  // Positions in single precision need no copy in double.
  const bool single = std::all_of(blocks.begin(), blocks.end(), [&](const Hdf5Block& block) {
    return block.file->type(block.dataset(position)) == Hdf5Type::float32;
  });
  if (single) {
    read_positions<float>(blocks, position, num_particles, progress, particles);
  } else {
    read_positions<double>(blocks, position, num_particles, progress, particles);
  }

  const bool all_have_ids = std::all_of(blocks.begin(), blocks.end(), [&](const Hdf5Block& block) {
    return block.has(id) && values_per_row(block, id) == 1;
  });
  if (all_have_ids) {
    particles.ids.resize(num_particles);
    for (const Hdf5Block& block : blocks) {
      read_into<std::int64_t, 1>(block, id, {&particles.ids}, progress);
    }
  }
  std::vector<std::string> imprecise;
  for (const Column& column : columns) {
    if (!read_properties(blocks, column, num_particles, progress, particles)) {
      imprecise.push_back(column.dataset);
    }
  }
  warn_of_left_out(imprecise, lack_of_digits, options);
}

}  // namespace motes
