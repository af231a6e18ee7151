// Numbers that follow each other over any lines: how formats of text hold the values of grids.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "io/reader.h"
#include "io/row_loop.h"
#include "io/text.h"

namespace motes {

/// parse_real(), and besides what Fortran writes: 1.5D-3, and 1.5-103 where the exponent has left
/// no room for its letter.
const char* parse_fortran_real(const char* begin, const char* end, double& value);

/// The first `count` numbers of a text: counted when made, so that no memory is taken for values
/// that are not there; parsed when asked for, on all threads.
class NumberText {
 public:
  /// Throws Error, "the file ends after K of COUNT values", if the text has fewer tokens, with what
  /// the text is in place of the file if it is a part of it. `file` and the text must outlive this.
  NumberText(const std::filesystem::path& file, TextBlock text, std::uint64_t count,
             std::string_view what = "the file");

  /// What follows the last number.
  TextBlock rest() const { return rest_; }
  /// Warns where nothing does, not even the end of its line.
  void warn_if_open(const ReadOptions& options) const {
    if (rest_.text.empty()) warn_of_open_end(file_, rest_.first_line, options.warnings);
  }

  /// Calls store(index, value) for each number, from several threads. Throws Error with the line of
  /// a token that is none.
  template <class Store>
  void parse(const ReadOptions& options, Store&& store) const {
    for_each_chunk(
        file_, chunks_.size(),
        [&](std::size_t c) {
          const char* p = chunks_[c].text.data();
          const char* const end = p + chunks_[c].text.size();
          for (std::uint64_t i = 0; i < chunks_[c].count; ++i) {
            while (is_blank(*p)) ++p;
            double value = 0;
            const char* const token_end = parse_fortran_real(p, end, value);
            if (token_end == nullptr) fail(chunks_[c], p);
            store(chunks_[c].first + i, value);
            p = token_end;
          }
        },
        options);
  }

 private:
  struct Chunk {
    std::string_view text;  ///< begins and ends between tokens
    std::uint64_t first_line = 0;
    std::uint64_t first = 0;  ///< index of its first number
    std::uint64_t count = 0;
  };

  void split(TextBlock text);
  void drop_behind(std::uint64_t count);
  [[noreturn]] void fail(const Chunk& chunk, const char* token) const;

  const std::filesystem::path& file_;
  std::vector<Chunk> chunks_;
  TextBlock rest_;
};

/// Throws Error, naming the line, if there is anything but blanks in `rest`, behind the last of
/// the `count` values of the file, or of `what` else they are.
void expect_no_more(const std::filesystem::path& file, TextBlock rest, std::uint64_t count,
                    std::string_view what = "the file");

}  // namespace motes
