// The calls of the HDF5 library, each with its result checked.
#include "io/hdf5_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/error.h"
#include "io/bytes.h"
#include "io/companion.h"

namespace motes {

namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>);
static_assert(std::is_same_v<herr_t, int>);

constexpr const char* damaged = "cannot be read; the file is damaged, or needs a missing filter";

Hdf5Handle open_file(const std::filesystem::path& path, const ReadOptions& options) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // it would print; we throw
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access.id(), false, true);  // a lock needs write access on some file systems
  std::string name = path.string();
  if (ByteStream(path).compressed()) {
    // (the library makes copies of it)
    std::string content = read_decompressed(path, options, half_of_memory() / 2);
    H5Pset_fapl_core(access.id(), std::size_t{1} << 20, false);
    H5Pset_file_image(access.id(), content.data(), content.size());
    name += "/content";  // the library wants a name that no file has
  }
  Hdf5Handle file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!file.valid()) throw Error(path, "is damaged or cut short; expected a whole HDF5 file");
  return file;
}

template <class T>
hid_t memory_type(hid_t file_type) {
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  // Identifiers above 2^63 keep their bits rather than being cut to the largest signed number.
  return H5Tget_class(file_type) == H5T_INTEGER && H5Tget_sign(file_type) == H5T_SGN_NONE
             ? H5T_NATIVE_UINT64
             : H5T_NATIVE_INT64;
}

std::vector<hsize_t> dimensions(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> dims(static_cast<std::size_t>(std::max(rank, 0)));
  if (rank > 0) H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  return dims;
}

/// Throws Error where a dataset says that it holds more than the file does: values that were never
/// written would be read as zeros, and a lying shape would take memory.
void check_all_written(const Hdf5File& file, const std::string& name, const Hdf5Handle& dataset,
                       const Hdf5Handle& creation, const std::vector<hsize_t>& dims, double bytes) {
  if (H5Pget_layout(creation.id()) == H5D_CHUNKED) {
    std::vector<hsize_t> chunk(dims.size());
    H5Pget_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data());
    double expected = 1;
    for (std::size_t d = 0; d < dims.size(); ++d) {
      expected *= std::ceil(static_cast<double>(dims[d]) / static_cast<double>(chunk[d]));
    }
    const Hdf5Handle space(H5Dget_space(dataset.id()), H5Sclose);
    hsize_t written = 0;
    H5Dget_num_chunks(dataset.id(), space.id(), &written);
    if (static_cast<double>(written) < expected) {
      file.fail(name,
                fmt::format("has {} of its {:.0f} blocks of values; the others were not written",
                            written, expected));
    }
  }
  // Deflate packs at most 1032 to 1; only the scale-offset filter can do better.
  constexpr double best_compression = 1100;
  unsigned flags = 0, config = 0;
  std::size_t num_values = 0;
  const bool scale_offset = H5Pget_filter_by_id2(creation.id(), H5Z_FILTER_SCALEOFFSET, &flags,
                                                 &num_values, nullptr, 0, nullptr, &config) >= 0;
  const hsize_t stored = H5Dget_storage_size(dataset.id());
  if (!scale_offset && bytes > best_compression * static_cast<double>(stored)) {
    file.fail(name,
              fmt::format("says that it holds {:.3g} bytes, but {} are stored", bytes, stored));
  }
}

/// The strings that `read` (H5Aread or H5Dread) puts into memory of the type that it is given.
template <class Read>
std::optional<std::vector<std::string>> strings(hid_t type, hid_t space, Read&& read) {
  const auto count =
      static_cast<std::size_t>(std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0));
  std::vector<std::string> result;
  if (count == 0) return result;
  if (H5Tis_variable_str(type) > 0) {
    std::vector<char*> pointers(count, nullptr);
    if (read(type, pointers.data()) < 0) return std::nullopt;
    for (const char* text : pointers) result.emplace_back(text == nullptr ? "" : text);
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
    return result;
  }
  const std::size_t length = H5Tget_size(type);
  std::string buffer(count * length, '\0');
  if (read(type, buffer.data()) < 0) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    std::string text = buffer.substr(i * length, length);
    text.resize(std::min(text.find('\0'), text.size()));
    text.erase(text.find_last_not_of(' ') + 1);  // padded with blanks by Fortran
    result.push_back(std::move(text));
  }
  return result;
}

}  // namespace

Hdf5Handle::Hdf5Handle(std::int64_t id, Close close) : id_(id), close_(close) {
  // The library cannot close itself after a thread that has ended with a failure on its record.
  if (id < 0) H5Eclear2(H5E_DEFAULT);
}

Hdf5File::Hdf5File(const std::filesystem::path& path, const ReadOptions& options)
    : path_(path), file_(open_file(path, options)) {}

void Hdf5File::fail(const std::string& object, const std::string& message) const {
  throw Error(path_, fmt::format("{}{} {}", object.starts_with('/') ? "" : "/", printable(object),
                                 message));
}

bool Hdf5File::has_object(const std::string& name, int kind) const {
  const Hdf5Handle object(H5Oopen(file_.id(), name.c_str(), H5P_DEFAULT), H5Oclose);
  return object.valid() && H5Iget_type(object.id()) == kind;
}

bool Hdf5File::has_group(const std::string& name) const { return has_object(name, H5I_GROUP); }
bool Hdf5File::has_dataset(const std::string& name) const { return has_object(name, H5I_DATASET); }

std::vector<std::string> Hdf5File::members(const std::string& group) const {
  const Hdf5Handle handle(H5Gopen2(file_.id(), group.c_str(), H5P_DEFAULT), H5Gclose);
  H5G_info_t info{};
  if (!handle.valid() || H5Gget_info(handle.id(), &info) < 0) fail(group, damaged);
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const auto name_at = [&](char* out, std::size_t size) {
      return H5Lget_name_by_idx(handle.id(), ".", H5_INDEX_NAME, H5_ITER_INC, i, out, size,
                                H5P_DEFAULT);
    };
    const auto length = name_at(nullptr, 0);
    if (length < 0) fail(group, damaged);
    std::string name(static_cast<std::size_t>(length) + 1, '\0');
    name_at(name.data(), name.size());
    name.pop_back();
    names.push_back(std::move(name));
  }
  return names;
}

Hdf5Handle Hdf5File::open_dataset(const std::string& name) const {
  Hdf5Handle dataset(H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail(name, damaged);
  const Hdf5Handle creation(H5Dget_create_plist(dataset.id()), H5Pclose);
  if (keeps_to_own_directories() && H5Pget_external_count(creation.id()) != 0) {
    fail(name, "has its values in other files, which are not opened from here");
  }
  return dataset;
}

Hdf5Type Hdf5File::type(const std::string& dataset) const {
  const Hdf5Handle handle = open_dataset(dataset);
  const Hdf5Handle type(H5Dget_type(handle.id()), H5Tclose);
  switch (H5Tget_class(type.id())) {
    case H5T_FLOAT:
      return H5Tget_size(type.id()) > 4 ? Hdf5Type::float64 : Hdf5Type::float32;
    case H5T_INTEGER:
    case H5T_ENUM:
      return Hdf5Type::integer;
    case H5T_STRING:
      return Hdf5Type::text;
    default:
      return Hdf5Type::other;
  }
}

std::vector<std::uint64_t> Hdf5File::shape(const std::string& dataset) const {
  const Hdf5Handle handle = open_dataset(dataset);
  const Hdf5Handle space(H5Dget_space(handle.id()), H5Sclose);
  const Hdf5Handle type(H5Dget_type(handle.id()), H5Tclose);
  const std::vector<hsize_t> dims = dimensions(space.id());
  double bytes = static_cast<double>(H5Tget_size(type.id()));
  for (const hsize_t n : dims) bytes *= static_cast<double>(n);
  const Hdf5Handle creation(H5Dget_create_plist(handle.id()), H5Pclose);
  if (H5Pget_layout(creation.id()) == H5D_VIRTUAL) {
    fail(dataset, "is a virtual dataset; expected one of the files that it refers to");
  }
  check_all_written(*this, dataset, handle, creation, dims, bytes);
  return {dims.begin(), dims.end()};
}

template <class T>
void Hdf5File::read_rows(const std::string& dataset, std::uint64_t first_row,
                         std::uint64_t num_rows, T* out) const {
  const Hdf5Handle handle = open_dataset(dataset);
  const Hdf5Handle type(H5Dget_type(handle.id()), H5Tclose);
  const Hdf5Handle space(H5Dget_space(handle.id()), H5Sclose);
  std::vector<hsize_t> counts = dimensions(space.id()), starts(counts.size(), 0);
  if (!counts.empty()) {
    starts[0] = first_row;
    counts[0] = num_rows;
    H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, starts.data(), nullptr, counts.data(), nullptr);
  }
  const Hdf5Handle memory(
      counts.empty() ? H5Screate(H5S_SCALAR)
                     : H5Screate_simple(static_cast<int>(counts.size()), counts.data(), nullptr),
      H5Sclose);
  if (H5Dread(handle.id(), memory_type<T>(type.id()), memory.id(), space.id(), H5P_DEFAULT, out) <
      0) {
    fail(dataset, damaged);
  }
}

template <class T>
std::vector<T> Hdf5File::read(const std::string& dataset) const {
  const std::vector<std::uint64_t> dims = shape(dataset);
  std::uint64_t count = 1;
  for (const std::uint64_t n : dims) count *= n;
  std::vector<T> values(count);
  if (count > 0) read_rows(dataset, 0, dims.empty() ? 1 : dims[0], values.data());
  return values;
}

template void Hdf5File::read_rows(const std::string&, std::uint64_t, std::uint64_t, float*) const;
template void Hdf5File::read_rows(const std::string&, std::uint64_t, std::uint64_t, double*) const;
template void Hdf5File::read_rows(const std::string&, std::uint64_t, std::uint64_t,
                                  std::int64_t*) const;
template std::vector<float> Hdf5File::read(const std::string&) const;
template std::vector<double> Hdf5File::read(const std::string&) const;
template std::vector<std::int64_t> Hdf5File::read(const std::string&) const;

std::map<std::int64_t, std::string> Hdf5File::enumeration(const std::string& dataset) const {
  const Hdf5Handle handle = open_dataset(dataset);
  const Hdf5Handle type(H5Dget_type(handle.id()), H5Tclose);
  std::map<std::int64_t, std::string> names;
  if (H5Tget_class(type.id()) != H5T_ENUM) return names;
  for (int i = 0; i < H5Tget_nmembers(type.id()); ++i) {
    const auto member = static_cast<unsigned>(i);
    // The value has the size of the file's integer; converted in place to a long one.
    std::int64_t value = 0;
    const Hdf5Handle integer(H5Tget_super(type.id()), H5Tclose);
    char* name = H5Tget_member_name(type.id(), member);
    if (name == nullptr) continue;
    if (H5Tget_size(integer.id()) <= sizeof value &&
        H5Tget_member_value(type.id(), member, &value) >= 0 &&
        H5Tconvert(integer.id(), H5T_NATIVE_INT64, 1, &value, nullptr, H5P_DEFAULT) >= 0) {
      names[value] = name;
    }
    H5free_memory(name);
  }
  return names;
}

Hdf5Handle Hdf5File::open_attribute(const std::string& object, const std::string& attribute) const {
  const char* name = object.c_str();
  if (!has_group(object) && !has_dataset(object)) return {-1, H5Aclose};
  return {H5Aopen_by_name(file_.id(), name, attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose};
}

std::optional<std::vector<double>> Hdf5File::numbers(const std::string& object,
                                                     const std::string& attribute) const {
  const Hdf5Handle handle = open_attribute(object, attribute);
  if (!handle.valid()) return std::nullopt;
  const Hdf5Handle type(H5Aget_type(handle.id()), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type.id());
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) return std::nullopt;
  const Hdf5Handle space(H5Aget_space(handle.id()), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  std::vector<double> values(static_cast<std::size_t>(std::max<hssize_t>(count, 0)));
  if (values.empty()) return std::nullopt;
  if (H5Aread(handle.id(), H5T_NATIVE_DOUBLE, values.data()) < 0) fail(object, damaged);
  return values;
}

std::optional<double> Hdf5File::number(const std::string& object,
                                       const std::string& attribute) const {
  const auto values = numbers(object, attribute);
  return values ? std::optional(values->front()) : std::nullopt;
}

std::vector<std::string> Hdf5File::texts(const std::string& object,
                                         const std::string& attribute) const {
  const Hdf5Handle handle = open_attribute(object, attribute);
  if (!handle.valid()) return {};
  const Hdf5Handle type(H5Aget_type(handle.id()), H5Tclose);
  if (H5Tget_class(type.id()) != H5T_STRING) return {};
  const Hdf5Handle space(H5Aget_space(handle.id()), H5Sclose);
  auto result = strings(type.id(), space.id(),
                        [&](hid_t memory, void* out) { return H5Aread(handle.id(), memory, out); });
  if (!result) fail(object, damaged);
  return *std::move(result);
}

std::string Hdf5File::text(const std::string& object, const std::string& attribute) const {
  const std::vector<std::string> all = texts(object, attribute);
  return all.empty() ? "" : all.front();
}

}  // namespace motes
