// Finds tokens chunk by chunk.
#include "io/number_text.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <string>

namespace motes {

namespace {

// As in row_loop.cc.
constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

std::uint64_t count_lines(std::string_view text) {
  return static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Tokens of a text that begins between two of them.
std::uint64_t count_tokens(std::string_view text) {
  std::uint64_t count = 0;
  bool after_blank = true;
  for (const char c : text) {
    const bool blank = is_blank(c);
    count += after_blank && !blank ? 1 : 0;
    after_blank = blank;
  }
  return count;
}

}  // namespace

const char* parse_fortran_real(const char* begin, const char* end, double& value) {
  const char* const stop = parse_real(begin, end, value);
  if (stop != nullptr) return stop;
  const char* const token_end = std::find_if(begin, end, is_blank);
  constexpr std::ptrdiff_t longest = 64;
  if (token_end - begin > longest) return nullptr;
  std::string token(begin, token_end);
  if (const std::size_t letter = token.find_first_of("dD"); letter != std::string::npos) {
    token[letter] = 'e';
  } else if (const std::size_t sign = token.find_last_of("+-");
             sign != std::string::npos && sign > 0 && token.find_first_of("eE") == token.npos) {
    token.insert(sign, 1, 'e');
  }
  const auto number = to_real(token);
  value = number.value_or(0);
  return number ? token_end : nullptr;
}

NumberText::NumberText(const std::filesystem::path& file, TextBlock text, std::uint64_t count,
                       std::string_view what)
    : file_(file), rest_(text) {
  split(text);
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t i) {
    chunks_[i].count = count_tokens(chunks_[i].text);
    chunks_[i].first_line = count_lines(chunks_[i].text);
  });
  std::uint64_t first = 0, line = text.first_line;
  for (Chunk& chunk : chunks_) {
    chunk.first = first;
    first += chunk.count;
    const std::uint64_t num_lines = chunk.first_line;
    chunk.first_line = line;
    line += num_lines;
  }
  if (first < count) {
    throw Error(file, line, fmt::format("{} ends after {} of {} values", what, first, count));
  }
  drop_behind(count);
}

void NumberText::split(TextBlock text) {
  for (std::string_view left = text.text; !left.empty();) {
    std::size_t size = std::min(chunk_bytes, left.size());
    while (size < left.size() && !is_blank(left[size])) ++size;
    chunks_.push_back({.text = left.substr(0, size)});
    left.remove_prefix(size);
  }
}

/// Leaves the first `count` numbers in the chunks, and the rest in rest_.
void NumberText::drop_behind(std::uint64_t count) {
  while (!chunks_.empty() && chunks_.back().first >= count) chunks_.pop_back();
  if (chunks_.empty()) return;
  Chunk& last = chunks_.back();
  last.count = count - last.first;
  std::string_view left = last.text;
  for (std::uint64_t i = 0; i < last.count; ++i) next_token(left);
  const char* const end = left.data();
  last.text = last.text.substr(0, last.text.size() - left.size());
  const auto taken = static_cast<std::size_t>(end - rest_.text.data());
  rest_ = {rest_.text.substr(taken), last.first_line + count_lines(last.text)};
}

void NumberText::fail(const Chunk& chunk, const char* token) const {
  const auto before = static_cast<std::size_t>(token - chunk.text.data());
  std::string_view left = chunk.text.substr(before);
  throw Error(file_, chunk.first_line + count_lines(chunk.text.substr(0, before)),
              fmt::format("expected a number, found '{}'", printable(next_token(left))));
}

void expect_no_more(const std::filesystem::path& file, TextBlock rest, std::uint64_t count,
                    std::string_view what) {
  LineReader lines(file, rest, true);
  if (!lines.skip_blank_lines()) return;
  std::string_view line = lines.next("");
  lines.fail(fmt::format("expected the end of {} after {} values, found '{}'", what, count,
                         printable(next_token(line))));
}

}  // namespace motes
