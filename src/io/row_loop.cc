// Chunks of rows in parallel.
#include "io/row_loop.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <exception>
#include <mutex>

#include "io/bytes.h"

namespace motes {

namespace {

// Large enough to be worth a task, small enough for a progress bar that moves and for cores that
// differ in speed.
constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

}  // namespace

std::vector<RowChunk> split_rows(TextBlock block) {
  std::vector<RowChunk> chunks;
  for (std::string_view rest = block.text; !rest.empty();) {
    const std::size_t newline = rest.find('\n', std::min(chunk_bytes, rest.size() - 1));
    const std::size_t size = newline == std::string_view::npos ? rest.size() : newline + 1;
    chunks.push_back({{rest.substr(0, size), 0}});
    rest.remove_prefix(size);
  }
  std::vector<std::uint64_t> num_lines(chunks.size());
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
    num_lines[i] = for_each_row(chunks[i], [&](std::size_t, const char*, const char*,
                                               std::uint64_t) { ++chunks[i].num_rows; });
  });
  std::size_t row = 0;
  std::uint64_t line = block.first_line;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    chunks[i].first_row = row;
    chunks[i].block.first_line = line;
    row += chunks[i].num_rows;
    line += num_lines[i];
  }
  return chunks;
}

std::uint64_t line_of_row(TextBlock block, std::size_t row) {
  std::uint64_t of_row = block.first_line;
  for_each_row({block}, [&](std::size_t number, const char*, const char*, std::uint64_t line) {
    if (number == row) of_row = line;
  });
  return of_row;
}

void for_each_chunk(const std::filesystem::path& file, std::size_t num_chunks,
                    const std::function<void(std::size_t)>& parse, const ReadOptions& options) {
  std::vector<std::exception_ptr> errors(num_chunks);
  std::mutex progress_mutex;
  std::size_t num_done = 0;
  tbb::parallel_for(std::size_t{0}, num_chunks, [&](std::size_t i) {
    try {
      parse(i);
    } catch (const Error&) {
      errors[i] = std::current_exception();
    }
    if (options.progress == nullptr) return;
    const std::lock_guard lock(progress_mutex);
    ++num_done;
    options.progress->update(reading_activity(file),
                             static_cast<double>(num_done) / static_cast<double>(num_chunks));
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace motes
