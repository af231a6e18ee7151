// HDF5 files for the readers of this room: the one place that calls the HDF5 library.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/reader.h"

namespace motes {

/// An identifier of the HDF5 library, closed at the end.
class Hdf5Handle {
 public:
  using Close = int (*)(std::int64_t);
  Hdf5Handle(std::int64_t id, Close close);
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;

  std::int64_t id() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  std::int64_t id_;
  Close close_;
};

enum class Hdf5Type { float32, float64, integer, text, other };

/// A file open for reading. Names of groups and datasets are paths in the file, "PartType0/Masses";
/// "/" is the root. What the file cannot give is an Error that names the file and the object.
/// The HDF5 library may not be safe for threads: use all such files from one thread.
class Hdf5File {
 public:
  /// Compressed files (file.hdf5.gz) are read through memory.
  Hdf5File(const std::filesystem::path& path, const ReadOptions& options);

  const std::filesystem::path& path() const { return path_; }
  bool has_group(const std::string& name) const;
  bool has_dataset(const std::string& name) const;
  /// Names of a group's members, in alphabetical order.
  std::vector<std::string> members(const std::string& group) const;

  Hdf5Type type(const std::string& dataset) const;
  /// Lengths along each dimension; empty for a scalar. Throws Error where the file is too small to
  /// hold that many values.
  std::vector<std::uint64_t> shape(const std::string& dataset) const;

  /// Reads `num_rows` rows (along the first dimension) from `first_row` into `out`, converted to T
  /// (float, double or int64_t; unsigned 64-bit values keep their bits). Precondition: the rows
  /// exist and `out` has room.
  template <class T>
  void read_rows(const std::string& dataset, std::uint64_t first_row, std::uint64_t num_rows,
                 T* out) const;
  /// All values of a dataset or scalar.
  template <class T>
  std::vector<T> read(const std::string& dataset) const;
  /// Names of the values of a dataset of an enumerated type; empty for other types.
  std::map<std::int64_t, std::string> enumeration(const std::string& dataset) const;

  /// The numbers of an attribute of a group or dataset; nothing if it is absent or no number.
  std::optional<std::vector<double>> numbers(const std::string& object,
                                             const std::string& attribute) const;
  /// The first of those numbers.
  std::optional<double> number(const std::string& object, const std::string& attribute) const;
  /// The strings of an attribute; empty if it is absent or no text.
  std::vector<std::string> texts(const std::string& object, const std::string& attribute) const;
  /// The first of those strings, or "".
  std::string text(const std::string& object, const std::string& attribute) const;

  /// Throws Error: the file and `object` (as "/Header") followed by `message`.
  [[noreturn]] void fail(const std::string& object, const std::string& message) const;

 private:
  bool has_object(const std::string& name, int kind) const;
  Hdf5Handle open_dataset(const std::string& name) const;
  Hdf5Handle open_attribute(const std::string& object, const std::string& attribute) const;

  std::filesystem::path path_;
  Hdf5Handle file_;
};

}  // namespace motes
