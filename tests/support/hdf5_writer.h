// Small HDF5 files for tests.
#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>

#include <filesystem>
#include <string>
#include <vector>

namespace motes {

class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path)
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {
    EXPECT_GE(file_, 0);
  }
  ~Hdf5Writer() { H5Fclose(file_); }
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// Makes the group and those above it.
  void group(const std::string& name) {
    if (name == "/" || H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0) return;
    if (const auto slash = name.rfind('/'); slash != std::string::npos)
      group(name.substr(0, slash));
    H5Gclose(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  }
  /// Values in the order of the rows, stored as `type`.
  void dataset(const std::string& name, const std::vector<hsize_t>& shape,
               const std::vector<double>& values, hid_t type = H5T_IEEE_F32LE) {
    if (const auto slash = name.rfind('/'); slash != std::string::npos)
      group(name.substr(0, slash));
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    const hid_t set =
        H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    H5Dclose(set);
    H5Sclose(space);
  }
  /// A dataset in blocks of `chunk` rows of which none is written.
  void empty_dataset(const std::string& name, const std::vector<hsize_t>& shape, hsize_t chunk) {
    if (const auto slash = name.rfind('/'); slash != std::string::npos)
      group(name.substr(0, slash));
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    std::vector<hsize_t> block = shape;
    block[0] = chunk;
    H5Pset_chunk(properties, static_cast<int>(block.size()), block.data());
    H5Dclose(H5Dcreate2(file_, name.c_str(), H5T_IEEE_F32LE, space, H5P_DEFAULT, properties,
                        H5P_DEFAULT));
    H5Pclose(properties);
    H5Sclose(space);
  }
  /// One number is a scalar.
  void attribute(const std::string& object, const std::string& name,
                 const std::vector<double>& values) {
    const hsize_t count = values.size();
    const hid_t space = count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr);
    write_attribute(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, space, values.data());
  }
  void text_attribute(const std::string& object, const std::string& name, const std::string& text) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, text.size());
    write_attribute(object, name, type, type, H5Screate(H5S_SCALAR), text.data());
    H5Tclose(type);
  }

 private:
  void write_attribute(const std::string& object, const std::string& name, hid_t type, hid_t memory,
                       hid_t space, const void* values) {
    const hid_t owner = H5Oopen(file_, object.c_str(), H5P_DEFAULT);
    const hid_t attribute = H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Awrite(attribute, memory, values), 0);
    H5Aclose(attribute);
    H5Oclose(owner);
    H5Sclose(space);
  }

  hid_t file_;
};

}  // namespace motes
