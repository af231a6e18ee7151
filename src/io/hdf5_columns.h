// Particles as columns of HDF5 datasets: what the layouts of several codes have in common.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/hdf5_file.h"
#include "io/reader.h"
#include "particles/particle_set.h"

namespace motes {

/// A group whose datasets have one row a particle. The particles of several blocks follow each
/// other in the ParticleSet.
struct Hdf5Block {
  const Hdf5File* file;
  std::string group;        ///< "PartType0"
  std::uint64_t first = 0;  ///< index of its first particle in the ParticleSet
  std::uint64_t count = 0;  ///< number of its particles

  std::string dataset(std::string_view name) const;
  bool has(std::string_view name) const { return file->has_dataset(dataset(name)); }
};

/// Number of rows of a dataset of positions. Throws Error unless it has the shape n x 3 and
/// numbers.
std::uint64_t count_positions(const Hdf5File& file, const std::string& dataset);

/// Whether integers that were read as these floats may have lost digits: one is 2^24 or more, from
/// where on floats do not tell all integers apart. Numbers of particles and the like would go
/// wrong.
bool may_lack_digits(const std::vector<float>& integers);

/// Why datasets with such integers are left out.
inline constexpr std::string_view lack_of_digits = "as integers beyond single precision";

/// Adds the warning "left out REASON: DATASETS" unless there are none.
void warn_of_left_out(const std::vector<std::string>& datasets, std::string_view reason,
                      const ReadOptions& options);

/// What the file's names become; vectors that are not named get _x, _y and _z.
struct ColumnName {
  std::string_view dataset;
  std::array<std::string_view, 3> properties;  ///< one, or three for a vector
};

/// Reads all blocks into `particles`: positions from the dataset `position` of each, and every
/// other dataset of numbers with n or n x 3 values as properties (NaN for the blocks that lack it),
/// those in `names` under their names there. Integers of the dataset `id` become ids if all blocks
/// have them. Properties beyond 2 GiB, and integers that may_lack_digits(), are left out with a
/// warning, but never those in `names`.
void read_columns(const std::vector<Hdf5Block>& blocks, std::string_view position,
                  std::string_view id, const std::vector<ColumnName>& names,
                  const ReadOptions& options, ParticleSet& particles);

}  // namespace motes
