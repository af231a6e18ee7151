// Text in lines: numbers, tokens, and a reader of lines that knows where it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/report.h"

namespace motes {

/// Blanks separate tokens: space, tab, carriage return and all other control characters.
inline bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' '; }

/// Reads the number that fills the token from `begin` to the next blank or to `end`: decimal, in
/// any notation of C, nan and inf too; the nearest double. Returns the token's end, or null if the
/// token is no number.
const char* parse_real(const char* begin, const char* end, double& value);

/// The same for integers of 64 bits.
const char* parse_integer(const char* begin, const char* end, std::int64_t& value);

/// The number that `token` is as a whole, if it is one.
std::optional<double> to_real(std::string_view token);
std::optional<std::int64_t> to_integer(std::string_view token);
/// The count that `text` is, blanks around it aside: an integer of at least 0.
std::optional<std::uint64_t> to_count(std::string_view text);

/// `text` without blanks at either end.
std::string_view trim(std::string_view text);

/// Whether a line of a table is a row: neither blank nor a comment ("# ...").
inline bool is_row(const char* begin, const char* end) {
  while (begin != end && is_blank(*begin)) ++begin;
  return begin != end && *begin != '#';
}

/// The next token of `text`, which is cut off its front; "" at the end.
std::string_view next_token(std::string_view& text);
std::vector<std::string_view> split_tokens(std::string_view text);

/// A part of a file and the number of its first line, so that messages can name lines.
struct TextBlock {
  std::string_view text;
  std::uint64_t first_line = 1;
};

/// Warns that the last line of a file has no end: what it ends with may be cut short.
void warn_of_open_end(const std::filesystem::path& file, std::uint64_t line, Warnings* warnings);

/// The text at hand ended too soon. An error, if it is the whole text of the file.
class TextEnds : public Error {
 public:
  using Error::Error;
};

/// Gives the lines of a block one by one, without line ends ("\n" or "\r\n").
class LineReader {
 public:
  /// `complete`: the block reaches the end of the file. `file` must outlive the reader.
  LineReader(const std::filesystem::path& file, TextBlock block, bool complete);

  /// The next line. Throws TextEnds where there is none: "ends here; expected EXPECTED".
  std::string_view next(std::string_view expected);
  /// The next line that is not blank.
  std::string_view next_filled(std::string_view expected);
  /// Skips `count` lines; throws TextEnds if there are fewer, "ends after K of COUNT WHAT".
  void skip(std::uint64_t count, std::string_view what);
  /// Skips to the end of the file; throws TextEnds if the text ends before.
  void skip_rest();
  /// The next `count` rows, with the lines before and between them that are none. Throws TextEnds
  /// as skip() does.
  TextBlock take_rows(std::uint64_t count, std::string_view what);
  /// Skips blank lines; false if the file has nothing else. Throws TextEnds if the text ends but
  /// not the file.
  bool skip_blank_lines();
  /// The next line, not taken; "" at the end.
  std::string_view peek() const;

  /// The count that `text`, of the line that next() gave last, is. Throws Error, "expected WHAT,
  /// found 'TEXT'", if it is none.
  std::uint64_t parse_count(std::string_view text, std::string_view what) const;

  /// Number in the file of the line that next() gave last.
  std::uint64_t line() const { return next_line_ - 1; }
  /// What is not taken yet.
  TextBlock rest() const { return {text_.substr(position_), next_line_}; }
  /// Bytes taken.
  std::size_t position() const { return position_; }

  /// Throws the Error that names the last line.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  const std::filesystem::path& file_;
  std::string_view text_;
  std::size_t position_ = 0;
  std::uint64_t next_line_;
  bool complete_;

  [[noreturn]] void fail_short(std::uint64_t found, std::uint64_t count, std::string_view what);
};

}  // namespace motes
