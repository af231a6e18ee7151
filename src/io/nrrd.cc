// NRRD, Nearly Raw Raster Data: volumes of one number a sample, with the values behind the header
// or in a file of their own.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "core/error.h"
#include "io/bytes.h"
#include "io/companion.h"
#include "io/grid_format.h"
#include "io/nrrd_header.h"
#include "io/number_text.h"
#include "io/scalars.h"

namespace motes {

namespace {

/// `stored` without what the header says comes before the values.
std::string_view skip_lines(const std::filesystem::path& file, std::string_view stored,
                            std::uint64_t count) {
  LineReader lines(file, {stored, 1}, true);
  lines.skip(count, "lines before the values");
  return stored.substr(lines.position());
}

std::string expected_size(const NrrdHeader& header, std::uint64_t num_samples) {
  const auto& dims = header.shape.dims;
  return fmt::format("expected {} for {} x {} x {} samples of {} bytes",
                     num_samples * size_of(header.type), dims[0], dims[1], dims[2],
                     size_of(header.type));
}

void warn_if_swapped(const std::filesystem::path& file, std::string_view bytes,
                     const NrrdHeader& header, const ReadOptions& options) {
  if (options.warnings == nullptr || !looks_swapped(bytes, header.type, header.big_endian)) return;
  const auto name = [](bool big) { return big ? "big" : "little"; };
  options.warnings->add(
      Error(file, fmt::format("has values that make no sense with 'endian: {}', but would with "
                              "'endian: {}', in the other order of bytes",
                              name(header.big_endian), name(!header.big_endian)))
          .what());
}

void read_raw(const std::filesystem::path& file, std::string_view stored, const NrrdHeader& header,
              std::uint64_t num_samples, UninitializedVector<float>& values,
              const ReadOptions& options) {
  const std::uint64_t size = num_samples * size_of(header.type);
  const std::uint64_t skip =
      header.byte_skip >= 0
          ? std::min<std::uint64_t>(static_cast<std::uint64_t>(header.byte_skip), stored.size())
          : stored.size() - std::min<std::uint64_t>(size, stored.size());
  stored.remove_prefix(skip);
  if (stored.size() != size) {
    throw Error(file, fmt::format("holds {} bytes of values; {}", stored.size(),
                                  expected_size(header, num_samples)));
  }
  warn_if_swapped(file, stored, header, options);
  values.resize(num_samples);
  convert_scalars(stored, header.type, header.big_endian, values);
}

/// The memory for values grows with what the stream gives.
void read_compressed(const std::filesystem::path& file, std::string_view stored,
                     const NrrdHeader& header, std::uint64_t num_samples,
                     UninitializedVector<float>& values, const ReadOptions& options) {
  ByteStream stream(file, stored);
  if (!stream.compressed()) {
    throw Error(file, "has values that are not compressed; expected gzip or bzip2");
  }
  const std::size_t value_bytes = size_of(header.type);
  std::string block(std::size_t{1} << 20, '\0');
  for (auto skip = static_cast<std::uint64_t>(header.byte_skip); skip > 0;) {
    const std::size_t n = stream.read(block.data(), std::min<std::uint64_t>(skip, block.size()));
    if (n == 0) break;
    skip -= n;
  }
  const auto fail = [&](std::uint64_t found, std::string_view or_more) {
    throw Error(file, fmt::format("holds {} bytes of values{}; {}", found, or_more,
                                  expected_size(header, num_samples)));
  };
  std::uint64_t filled = 0;
  for (;;) {
    const std::size_t n = stream.read(block.data(), block.size());
    const std::size_t count = n / value_bytes;
    if (count > num_samples - filled) fail(filled * value_bytes + n, " or more");
    if (values.capacity() < filled + count) {
      values.reserve(std::min(num_samples, std::max(filled + count, 2 * filled)));
    }
    if (filled == 0) warn_if_swapped(file, {block.data(), count * value_bytes}, header, options);
    values.resize(filled + count);
    convert_scalars({block.data(), count * value_bytes}, header.type, header.big_endian,
                    std::span(values).subspan(filled));
    filled += count;
    if (options.progress != nullptr) {
      options.progress->update(reading_activity(file), stream.fraction());
    }
    if (n < block.size()) {
      // (blocks are whole numbers of values, but for the last one)
      if (filled != num_samples || n % value_bytes != 0)
        fail(filled * value_bytes + n % value_bytes, "");
      if (stream.read(block.data(), 1) == 0) return;
      fail(filled * value_bytes, " and more");
    }
  }
}

void read_text(const std::filesystem::path& file, TextBlock text, std::uint64_t num_samples,
               UninitializedVector<float>& values, const ReadOptions& options) {
  const NumberText numbers(file, text, num_samples);
  expect_no_more(file, numbers.rest(), num_samples);
  numbers.warn_if_open(options);
  values.resize(num_samples);
  numbers.parse(options,
                [&](std::uint64_t n, double value) { values[n] = static_cast<float>(value); });
}

std::vector<Grid> read_nrrd(const std::filesystem::path& path, const ReadOptions& options) {
  const FileContent content(path, options);
  const NrrdHeader header = parse_nrrd_header(path, content.bytes());
  check_steps(path, header.shape);
  const std::uint64_t num_samples = count_samples(path, header.shape.dims);

  // The values are named relative to the header.
  const bool detached = !header.data_file.empty();
  const std::filesystem::path file = detached ? companion_of(path, header.data_file) : path;
  std::optional<FileContent> data;
  std::optional<MappedFile> compressed_data;
  std::string_view stored = content.bytes().substr(header.end);
  if (detached && header.encoding == NrrdEncoding::compressed) {
    stored = compressed_data.emplace(file).bytes();
  } else if (detached) {
    stored = data.emplace(file, options).bytes();
  }
  const std::uint64_t first_line = (detached ? 1 : header.end_line) + header.line_skip;
  stored = skip_lines(file, stored, header.line_skip);

  std::vector<Grid> grids{header.shape};
  auto& values = grids[0].values;
  switch (header.encoding) {
    case NrrdEncoding::raw:
      read_raw(file, stored, header, num_samples, values, options);
      break;
    case NrrdEncoding::text:
      stored.remove_prefix(
          std::min<std::uint64_t>(static_cast<std::uint64_t>(header.byte_skip), stored.size()));
      read_text(file, {stored, first_line}, num_samples, values, options);
      break;
    case NrrdEncoding::compressed:
      read_compressed(file, stored, header, num_samples, values, options);
      break;
  }
  return grids;
}

bool matches_nrrd(std::string_view head) { return head.starts_with("NRRD000"); }

}  // namespace

const GridFormat& nrrd_format() {
  static const GridFormat format{"NRRD", {".nrrd", ".nhdr"}, matches_nrrd, read_nrrd};
  return format;
}

}  // namespace motes
