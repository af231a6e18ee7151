// The one exception of Motes: something that the user can understand and mend.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace motes {

/// A user's mistake, a bad file or a failure of the system. what() is one line,
/// "FILE:LINE: what, and what was expected"; FILE and LINE are left out where there are none.
/// Programmer mistakes are asserts, never this.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message);
  Error(const std::filesystem::path& file, const std::string& message);
  /// `line` counts from 1.
  Error(const std::filesystem::path& file, std::uint64_t line, const std::string& message);
};

/// `text` made fit for a message of one line: control characters as \xHH, cut at `max_length`.
std::string printable(std::string_view text, std::size_t max_length = 60);

/// The member of `candidates` that `word` was likely meant to be: a typing mistake away, or one a
/// part of the other, whatever the case; "" if none is.
std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates);

/// The member of `candidates` that takes the fewest edits to make of `word`, whatever the case; ""
/// if there are none.
std::string closest_word(std::string_view word, const std::vector<std::string>& candidates);

/// "unknown KIND 'NAME'; did you mean 'NEAREST'?", or, where none is near, what there is.
Error unknown_name(std::string_view kind, std::string_view name,
                   const std::vector<std::string>& candidates);

}  // namespace motes
