// Rows of columns, parsed on all threads: what all text formats are mostly made of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/reader.h"
#include "io/text.h"

namespace motes {

/// One column of a table: what its tokens are, and after parse_table() its values, one a row.
struct Column {
  enum class Kind {
    ignored,
    real,     ///< -> reals
    single,   ///< a number -> singles, the float nearest to the double that it is
    integer,  ///< -> integers
    logical,  ///< T, F, True, False (in any case), 1, 0 -> singles
    word      ///< -> words and word_indices
  };

  std::string name;  ///< for messages
  Kind kind = Kind::ignored;
  std::vector<double> reals{};
  std::vector<float> singles{};
  std::vector<std::int64_t> integers{};
  std::vector<std::string> words{};           ///< distinct, in the order of their first row
  std::vector<std::uint16_t> word_indices{};  ///< into words

  void resize(std::size_t num_rows);
};

enum class RowWidth { exact, at_least };

/// Parses the rows of `block` (lines but blank ones and comments) into `columns`, and reports
/// progress. Throws Error with the line if there are not exactly `num_rows` of them, or a row has
/// too few columns (or, if `width` is exact, too many) or another thing than its column's kind.
void parse_table(const std::filesystem::path& file, TextBlock block, std::size_t num_rows,
                 RowWidth width, std::vector<Column>& columns, const ReadOptions& options);

}  // namespace motes
