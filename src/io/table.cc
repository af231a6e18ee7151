// Tables: each chunk of rows writes its own part of the columns.
#include "io/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <optional>
#include <unordered_map>

#include "io/row_loop.h"

namespace motes {

namespace {

constexpr std::size_t max_words = std::numeric_limits<std::uint16_t>::max();

/// The distinct words of one column in one chunk.
class WordList {
 public:
  /// Index of `word`, added if it is new; nothing if there are too many.
  std::optional<std::uint16_t> index(std::string_view word) {
    // Neighbours are often alike, and mostly there are few words.
    if (last_ < words_.size() && words_[last_] == word) return last_;
    const auto [it, is_new] = indices_.try_emplace(word, static_cast<std::uint16_t>(words_.size()));
    if (is_new) {
      if (words_.size() == max_words) return std::nullopt;
      words_.push_back(word);
    }
    last_ = it->second;
    return last_;
  }
  const std::vector<std::string_view>& words() const { return words_; }

 private:
  std::vector<std::string_view> words_;  // into the text
  std::unordered_map<std::string_view, std::uint16_t> indices_;
  std::uint16_t last_ = 0;
};

std::optional<float> to_logical(std::string_view token) {
  std::string lower(token);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (lower == "t" || lower == "true" || lower == "1") return 1.0F;
  if (lower == "f" || lower == "false" || lower == "0") return 0.0F;
  return std::nullopt;
}

std::string_view token_at(const char* begin, const char* end) {
  std::string_view text(begin, static_cast<std::size_t>(end - begin));
  return next_token(text);
}

class TableParser {
 public:
  TableParser(const std::filesystem::path& file, std::vector<Column>& columns, RowWidth width,
              std::size_t num_chunks)
      : file_(file), columns_(columns), width_(width) {
    for (const Column& column : columns) {
      words_.emplace_back(column.kind == Column::Kind::word ? num_chunks : 0);
    }
  }

  void parse_chunk(const RowChunk& chunk, std::size_t chunk_index) {
    for_each_row(chunk, [&](std::size_t row, const char* p, const char* end, std::uint64_t line) {
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        while (p != end && is_blank(*p)) ++p;
        if (p == end) fail_short(c, line);
        const char* token_end = parse_token(c, row, p, end, chunk_index);
        if (token_end == nullptr) fail_token(c, token_at(p, end), line);
        p = token_end;
      }
      if (width_ == RowWidth::exact) expect_end(p, end, line);
    });
  }

  /// Joins the chunks' lists of words into one a column.
  void join_words(const std::vector<RowChunk>& chunks) {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (columns_[c].kind == Column::Kind::word) join_column(columns_[c], words_[c], chunks);
    }
  }

 private:
  /// Puts the token at `p` where it belongs; its end, or null if it is of the wrong kind.
  const char* parse_token(std::size_t c, std::size_t row, const char* p, const char* end,
                          std::size_t chunk_index) {
    Column& column = columns_[c];
    switch (column.kind) {
      case Column::Kind::real:
        return parse_real(p, end, column.reals[row]);
      case Column::Kind::single: {
        double value = 0;
        const char* token_end = parse_real(p, end, value);
        column.singles[row] = static_cast<float>(value);
        return token_end;
      }
      case Column::Kind::integer:
        return parse_integer(p, end, column.integers[row]);
      case Column::Kind::logical: {
        const std::string_view token = token_at(p, end);
        const auto value = to_logical(token);
        column.singles[row] = value.value_or(0);
        return value ? p + token.size() : nullptr;
      }
      case Column::Kind::word: {
        const std::string_view token = token_at(p, end);
        const auto index = words_[c][chunk_index].index(token);
        if (!index) throw too_many_words(column);
        column.word_indices[row] = *index;
        return p + token.size();
      }
      case Column::Kind::ignored:
        break;
    }
    while (p != end && !is_blank(*p)) ++p;
    return p;
  }

  Error too_many_words(const Column& column) const {
    return Error(file_, fmt::format("column {} has more than {} different names",
                                    printable(column.name), max_words));
  }

  [[noreturn]] void fail_short(std::size_t found, std::uint64_t line) const {
    throw Error(
        file_, line,
        fmt::format("expected {} columns ({}), found {}", columns_.size(), column_names(), found));
  }

  void expect_end(const char* p, const char* end, std::uint64_t line) const {
    const std::string_view token = token_at(p, end);
    if (token.empty()) return;
    throw Error(file_, line,
                fmt::format("expected {} columns ({}), found '{}' after them", columns_.size(),
                            column_names(), printable(token)));
  }

  [[noreturn]] void fail_token(std::size_t c, std::string_view token, std::uint64_t line) const {
    const Column& column = columns_[c];
    const std::string_view expected = column.kind == Column::Kind::integer   ? "an integer"
                                      : column.kind == Column::Kind::logical ? "T or F"
                                                                             : "a number";
    throw Error(file_, line,
                fmt::format("expected {} for {}, found '{}'", expected, printable(column.name),
                            printable(token)));
  }

  std::string column_names() const {
    std::string names;
    for (const Column& column : columns_) {
      if (!names.empty()) names += ' ';
      names += column.name;
    }
    return printable(names, 100);
  }

  void join_column(Column& column, const std::vector<WordList>& lists,
                   const std::vector<RowChunk>& chunks) const {
    std::unordered_map<std::string_view, std::uint16_t> indices;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      std::vector<std::uint16_t> joined;
      for (const std::string_view word : lists[i].words()) {
        const auto [it, is_new] =
            indices.try_emplace(word, static_cast<std::uint16_t>(column.words.size()));
        if (is_new) {
          if (column.words.size() == max_words) throw too_many_words(column);
          column.words.emplace_back(word);
        }
        joined.push_back(it->second);
      }
      const auto first =
          column.word_indices.begin() + static_cast<std::ptrdiff_t>(chunks[i].first_row);
      std::transform(first, first + static_cast<std::ptrdiff_t>(chunks[i].num_rows), first,
                     [&](std::uint16_t index) { return joined[index]; });
    }
  }

  const std::filesystem::path& file_;
  std::vector<Column>& columns_;
  RowWidth width_;
  std::vector<std::vector<WordList>> words_;  // [column][chunk]
};

}  // namespace

void Column::resize(std::size_t num_rows) {
  switch (kind) {
    case Kind::ignored:
      break;
    case Kind::real:
      reals.resize(num_rows);
      break;
    case Kind::single:
    case Kind::logical:
      singles.resize(num_rows);
      break;
    case Kind::integer:
      integers.resize(num_rows);
      break;
    case Kind::word:
      word_indices.resize(num_rows);
      break;
  }
}

void parse_table(const std::filesystem::path& file, TextBlock block, std::size_t num_rows,
                 RowWidth width, std::vector<Column>& columns, const ReadOptions& options) {
  const std::vector<RowChunk> chunks = split_rows(block);
  const std::size_t found = chunks.empty() ? 0 : chunks.back().first_row + chunks.back().num_rows;
  if (found != num_rows) {
    throw Error(file, block.first_line,
                fmt::format("expected {} rows from here on, found {}", num_rows, found));
  }
  // Only now is it sure that there are as many rows as the file says.
  for (Column& column : columns) column.resize(num_rows);
  TableParser parser(file, columns, width, chunks.size());
  for_each_chunk(
      file, chunks.size(), [&](std::size_t i) { parser.parse_chunk(chunks[i], i); }, options);
  parser.join_words(chunks);
}

}  // namespace motes
