// Files through libarchive's decompressing filters, and memory maps.
#include "io/bytes.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <system_error>

#include "core/error.h"

namespace motes {

namespace {

std::string system_message(int number) { return std::generic_category().message(number); }

/// Size of the regular file at `path`; throws Error for anything else.
std::uint64_t regular_file_size(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw Error(path, error && error != std::errc::no_such_file_or_directory
                          ? fmt::format("cannot be opened: {}", error.message())
                          : "there is no such file");
  }
  if (std::filesystem::is_directory(status)) throw Error(path, "is a directory; expected a file");
  if (!std::filesystem::is_regular_file(status)) {
    throw Error(path, "is not a regular file; expected one");
  }
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw Error(path, fmt::format("cannot be opened: {}", error.message()));
  return size;
}

}  // namespace

void ByteStream::Close::operator()(archive* a) const { archive_read_free(a); }

ByteStream::ByteStream(const std::filesystem::path& path, std::uint64_t size)
    : path_(path), file_size_(size), archive_(archive_read_new()) {
  archive* a = archive_.get();
  if (a == nullptr) throw Error(path_, "cannot be opened: out of memory");
  archive_read_support_filter_gzip(a);
  archive_read_support_filter_bzip2(a);
  archive_read_support_filter_xz(a);
  archive_read_support_filter_zstd(a);
  archive_read_support_format_raw(a);
  archive_read_support_format_empty(a);
}

ByteStream::ByteStream(const std::filesystem::path& path)
    : ByteStream(path, regular_file_size(path)) {
  // Larger blocks than the usual 10 KiB, and few enough to keep the start of a file quick.
  const std::size_t block_bytes = std::size_t{256} << 10;
  if (archive_read_open_filename(archive_.get(), path_.c_str(), block_bytes) != ARCHIVE_OK) fail();
  read_header();
}

ByteStream::ByteStream(const std::filesystem::path& path, std::string_view stored)
    : ByteStream(path, stored.size()) {
  if (archive_read_open_memory(archive_.get(), stored.data(), stored.size()) != ARCHIVE_OK) fail();
  read_header();
}

/// Of the one entry that the raw format has.
void ByteStream::read_header() {
  archive_entry* entry = nullptr;
  const int result = archive_read_next_header(archive_.get(), &entry);
  at_end_ = result == ARCHIVE_EOF;
  if (result < ARCHIVE_WARN) fail();
}

void ByteStream::fail() const {
  const char* message = archive_error_string(archive_.get());
  const int number = archive_errno(archive_.get());
  if (!compressed() && number > 0) {
    throw Error(path_, fmt::format("cannot be read: {}", system_message(number)));
  }
  throw Error(path_, fmt::format("cannot be decompressed: {}",
                                 message != nullptr ? printable(message, 200) : "damaged data"));
}

bool ByteStream::compressed() const {
  // The last filter is always the file itself.
  return archive_filter_count(archive_.get()) > 1;
}

double ByteStream::fraction() const {
  if (at_end_ || file_size_ == 0) return 1;
  const auto consumed = static_cast<double>(archive_filter_bytes(archive_.get(), -1));
  return std::clamp(consumed / static_cast<double>(file_size_), 0.0, 1.0);
}

std::size_t ByteStream::read(char* out, std::size_t size) {
  std::size_t filled = 0;
  while (filled < size) {
    if (block_.empty() && !next_block(filled)) break;
    const std::size_t n = block_.copy(out + filled, size - filled);
    block_.remove_prefix(n);
    filled += n;
  }
  return filled;
}

/// Decompresses the next block; false at the end, or before damage if something has been `filled`.
bool ByteStream::next_block(std::size_t filled) {
  while (!at_end_) {
    const void* data = nullptr;
    std::size_t size = 0;
    la_int64_t offset = 0;
    const int result = archive_read_data_block(archive_.get(), &data, &size, &offset);
    at_end_ = result == ARCHIVE_EOF;
    if (result < ARCHIVE_WARN) {
      if (filled == 0) fail();
      return false;
    }
    block_ = {static_cast<const char*>(data), at_end_ ? 0 : size};
    if (!block_.empty()) return true;
  }
  return false;
}

MappedFile::MappedFile(const std::filesystem::path& path)
    : size_(static_cast<std::size_t>(regular_file_size(path))) {
  if (size_ == 0) return;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw Error(path, fmt::format("cannot be opened: {}", system_message(errno)));
  void* data = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
  const int number = errno;
  ::close(file);
  if (data == MAP_FAILED) {
    throw Error(path, fmt::format("cannot be mapped into memory: {}", system_message(number)));
  }
  data_ = static_cast<const char*>(data);
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(const_cast<char*>(data_), size_);
}

std::string read_head(const std::filesystem::path& path, std::size_t size) {
  ByteStream stream(path);
  std::string head(size, '\0');
  head.resize(stream.read(head.data(), size));
  return head;
}

std::uint64_t half_of_memory() {
  const long num_pages = ::sysconf(_SC_PHYS_PAGES), page_bytes = ::sysconf(_SC_PAGE_SIZE);
  assert(num_pages > 0 && page_bytes > 0);
  return static_cast<std::uint64_t>(num_pages) * static_cast<std::uint64_t>(page_bytes) / 2;
}

std::string too_large(std::string_view what, std::uint64_t most_bytes) {
  return fmt::format("{} of more than {:.3g} GiB; expected less, for it must fit into memory", what,
                     std::ldexp(static_cast<double>(most_bytes), -30));
}

std::string read_decompressed(const std::filesystem::path& path, const ReadOptions& options,
                              std::uint64_t most_bytes) {
  ByteStream stream(path);
  const std::string activity = reading_activity(path);
  const std::size_t block_bytes = std::size_t{256} << 10;
  std::string content;
  for (std::size_t n = block_bytes; n > 0;) {
    const std::size_t size = content.size();
    content.resize(size + block_bytes);
    n = stream.read(content.data() + size, block_bytes);
    content.resize(size + n);
    if (content.size() > most_bytes) throw Error(path, too_large("content", most_bytes));
    if (options.progress != nullptr) options.progress->update(activity, stream.fraction());
  }
  return content;
}

FileContent::FileContent(const std::filesystem::path& path, const ReadOptions& options) {
  if (ByteStream(path).compressed()) {
    content_ = read_decompressed(path, options);
  } else {
    mapped_ = std::make_unique<MappedFile>(path);
  }
}

std::string bare_name(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const std::string_view ending : {".gz", ".bz2", ".xz", ".zst"}) {
    if (name.ends_with(ending)) {
      name.resize(name.size() - ending.size());
      break;
    }
  }
  return name;
}

std::string reading_activity(const std::filesystem::path& path) {
  return fmt::format("reading {}", printable(path.filename().string()));
}

}  // namespace motes
