// Reading bytes: plain and compressed files, and what cannot be read.
#include "io/bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "core/error.h"
#include "io/text_source.h"
#include "support/compress.h"
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
  for (const std::size_t missing :
       {whole.size() / 2, std::size_t{12}, std::size_t{6}, std::size_t{1}}) {
    const TemporaryFile file("a.txt", whole.substr(0, whole.size() - missing));
    EXPECT_THAT(error_of([&] { read_decompressed(file.path(), {}); }),
                HasSubstr("a.txt: cannot be decompressed"))
        << missing;
  }
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

TEST(ByteStream, OfALineWithoutEndIsNotReadIntoMemory) {
  const TemporaryFile file("a.xyz.zst",
                           compress("1\n\nH 0 0 0" + std::string(70 << 20, ' '), "zstd"));
  EXPECT_THAT(error_of([&] { open_trajectory(file.path(), {})->read_frame(0); }),
              HasSubstr("a.xyz.zst:3: a line of more than 64 MiB; expected text"));
}

TEST(ByteStream, OfMoreThanTheMemoryAllowsIsNotReadWhole) {
  const std::string content(3 << 20, '\n');
  const TemporaryFile file("a.csv.zst", compress(content, "zstd"));
  EXPECT_EQ(read_decompressed(file.path(), {}, content.size()), content);
  EXPECT_THAT(error_of([&] { read_decompressed(file.path(), {}, content.size() - 1); }),
              HasSubstr("a.csv.zst: content of more than 0.00293 GiB; expected less"));
  EXPECT_GT(half_of_memory(), std::uint64_t{128} << 20);
}

TEST(TextSource, HoldsNoMoreThanTheMemoryAllows) {
  const std::string content = "1\n" + std::string(4 << 20, '\n');
  const TemporaryFile file("a.xyz.zst", compress(content, "zstd"));
  TextSource whole(file.path(), {}, content.size() + 1);
  while (!whole.complete()) whole.load_more();
  EXPECT_EQ(whole.loaded(), content);

  TextSource source(file.path(), {}, 3 << 20);
  source.load_more();
  source.seek({2, 2});
  EXPECT_THAT(error_of([&] {
                while (!source.complete()) source.load_more();
              }),
              HasSubstr("a.xyz.zst:2: a frame of more than 0.00293 GiB"));
  EXPECT_EQ(source.loaded().size(), std::size_t{3} << 20);
  // What is left behind makes room.
  source.seek({2 << 20, 100});
  while (!source.complete()) source.load_more();
  EXPECT_EQ(source.loaded().size(), content.size() - (2 << 20));
}

}  // namespace
}  // namespace motes
