// The header of NumPy's array files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace motes {

/// A number or text of each item of an array.
struct NpyField {
  std::string name;
  char kind = 'f';       ///< f, i, u, b (bool), S (bytes), U (UCS-4 text)
  std::size_t size = 4;  ///< bytes of one value
  bool big_endian = false;
  std::size_t offset = 0;  ///< in the item
  std::size_t count = 1;   ///< values of a field that is an array itself

  bool is_text() const { return kind == 'S' || kind == 'U'; }
};

struct NpyHeader {
  std::vector<NpyField> fields;  ///< one without a name, unless structured
  bool structured = false;
  std::size_t item_size = 0;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t data_offset = 0;

  std::string shape_text() const;
};

/// Parses the header of a whole file. Throws Error if it is no such file, its type is not one of
/// NpyField's, or its data have not the size that its shape says.
NpyHeader parse_npy_header(const std::filesystem::path& path, std::string_view content);

}  // namespace motes
