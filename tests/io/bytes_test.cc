// Reading bytes: plain and compressed files, and what cannot be read.
#include "io/bytes.h"

#include <archive.h>
#include <archive_entry.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "core/error.h"
#include "support/temporary_file.h"

namespace motes {
namespace {

using testing::HasSubstr;

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// `content` compressed as one stream by the libarchive filter of that name.
std::string compress(const std::string& content, const char* filter) {
  archive* a = archive_write_new();
  archive_write_add_filter_by_name(a, filter);
  archive_write_set_format_raw(a);
  archive_write_set_bytes_per_block(a, 0);
  std::string out(content.size() + 65536, '\0');
  std::size_t used = 0;
  EXPECT_EQ(archive_write_open_memory(a, out.data(), out.size(), &used), ARCHIVE_OK);
  archive_entry* entry = archive_entry_new();
  archive_entry_set_filetype(entry, AE_IFREG);
  EXPECT_EQ(archive_write_header(a, entry), ARCHIVE_OK);
  archive_write_data(a, content.data(), content.size());
  archive_entry_free(entry);
  archive_write_close(a);
  archive_write_free(a);
  out.resize(used);
  return out;
}

std::string numbers(int first, int last) {
  std::string text;
  for (int i = first; i < last; ++i) text += std::to_string(i) + "\n";
  return text;
}

class Compressions : public testing::TestWithParam<const char*> {};

TEST_P(Compressions, GiveTheContentOfSeveralStreamsInARow) {
  const std::string first = numbers(0, 100000), second = numbers(100000, 150000);
  const TemporaryFile file("a.txt", compress(first, GetParam()) + compress(second, GetParam()));
  EXPECT_TRUE(ByteStream(file.path()).compressed());
  EXPECT_EQ(read_head(file.path(), 6), "0\n1\n2\n");
  EXPECT_EQ(read_decompressed(file.path(), {}), first + second);
}

TEST_P(Compressions, SayWhenTheDataAreCutShort) {
  const std::string whole = compress(numbers(0, 100000), GetParam());
  const TemporaryFile file("a.txt", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(error_of([&] { read_decompressed(file.path(), {}); }),
              HasSubstr("a.txt: cannot be decompressed"));
}

INSTANTIATE_TEST_SUITE_P(Filters, Compressions, testing::Values("gzip", "bzip2", "xz", "zstd"));

TEST(ByteStream, ReadsPlainFiles) {
  const std::string content = numbers(0, 100000);
  const TemporaryFile file("a.txt", content);
  EXPECT_FALSE(ByteStream(file.path()).compressed());
  EXPECT_EQ(read_head(file.path()), content.substr(0, head_bytes));
  EXPECT_EQ(read_decompressed(file.path(), {}), content);
  EXPECT_EQ(MappedFile(file.path()).bytes(), content);
}

TEST(ByteStream, ReadsAnEmptyFile) {
  const TemporaryFile file("a.txt");
  EXPECT_EQ(read_decompressed(file.path(), {}), "");
  EXPECT_EQ(MappedFile(file.path()).bytes(), "");
}

TEST(ByteStream, RefusesWhatIsNoFile) {
  EXPECT_THAT(error_of([] { read_head("/no/such/file"); }),
              HasSubstr("/no/such/file: there is no such file"));
  EXPECT_THAT(error_of([] { read_head("/"); }), HasSubstr("is a directory"));
  EXPECT_THAT(error_of([] { read_head("/dev/zero"); }), HasSubstr("is not a regular file"));
  EXPECT_THAT(error_of([] { MappedFile("/no/such/file"); }), HasSubstr("there is no such file"));
}

}  // namespace
}  // namespace motes
