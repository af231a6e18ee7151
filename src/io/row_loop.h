// Calls a function for each row of a block of text, on all threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <vector>

#include "io/reader.h"
#include "io/text.h"

namespace motes {

/// A part of a block: whole lines, and where its rows come in the block.
struct RowChunk {
  TextBlock block;
  std::size_t first_row = 0;
  std::size_t num_rows = 0;
};

/// Cuts `block` into chunks for parsing in parallel and counts their rows.
std::vector<RowChunk> split_rows(TextBlock block);

/// The number of the line that row number `row` of the block is.
std::uint64_t line_of_row(TextBlock block, std::size_t row);

/// Calls parse(chunk_index) for all chunks in parallel, with progress. Of the Errors that it
/// throws, that of the first chunk is passed on.
void for_each_chunk(const std::filesystem::path& file, std::size_t num_chunks,
                    const std::function<void(std::size_t)>& parse, const ReadOptions& options);

/// Calls f(row_index, begin, end, line_number) for each row of the chunk, in order. Returns the
/// number of its lines.
template <class F>
std::uint64_t for_each_row(const RowChunk& chunk, F&& f) {
  const char* p = chunk.block.text.data();
  const char* const end = p + chunk.block.text.size();
  std::uint64_t line = chunk.block.first_line;
  std::size_t row = chunk.first_row;
  for (; p != end; ++line) {
    const void* found = std::memchr(p, '\n', static_cast<std::size_t>(end - p));
    const char* const newline = found == nullptr ? end : static_cast<const char*>(found);
    if (is_row(p, newline)) f(row++, p, newline, line);
    p = newline == end ? end : newline + 1;
  }
  return line - chunk.block.first_line;
}

}  // namespace motes
