// Files appear whole or not at all, and failures say why.
#include "core/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "core/error.h"
#include "support/temporary_directory.h"

namespace motes {
namespace {

using testing::HasSubstr;

std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The message of the Error that `action` throws.
template <class Action>
std::string error_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no Error";
  return "";
}

TEST(AtomicFile, AppearsWithCommitOnly) {
  const TemporaryDirectory directory;
  const auto path = directory / "a.txt";
  write_file(path, "old");
  {
    AtomicFile file(path);
    file.write("new ");
    file.write("text");
    EXPECT_EQ(contents(path), "old");
    file.commit();
  }
  EXPECT_EQ(contents(path), "new text");
  EXPECT_EQ(directory.num_entries(), 1U);
}

TEST(AtomicFile, WithoutCommitLeavesTheOldFileAndNothingElse) {
  const TemporaryDirectory directory;
  const auto path = directory / "a.txt";
  write_file(path, "old");
  { AtomicFile(path).write("half"); }
  EXPECT_EQ(contents(path), "old");
  EXPECT_EQ(directory.num_entries(), 1U);
}

TEST(AtomicFile, HasThePermissionsOfAnOrdinaryNewFile) {
  const TemporaryDirectory directory;
  write_file(directory / "a", "x");
  std::ofstream(directory / "b") << "x";
  EXPECT_EQ(std::filesystem::status(directory / "a").permissions(),
            std::filesystem::status(directory / "b").permissions());
}

TEST(AtomicFile, FollowsLinks) {
  const TemporaryDirectory directory;
  write_file(directory / "real", "old");
  std::filesystem::create_symlink("real", directory / "link");
  write_file(directory / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
  EXPECT_EQ(contents(directory / "real"), "new");
}

TEST(AtomicFile, LongestNamesWork) {
  const TemporaryDirectory directory;
  const std::string name(255, 'n');
  write_file(directory / name, "x");
  EXPECT_EQ(contents(directory / name), "x");
}

TEST(AtomicFile, NamesTheFileAndTheReason) {
  const TemporaryDirectory directory;
  const auto missing = directory / "no/such/a.png";
  EXPECT_EQ(error_of([&] { AtomicFile file(missing); }),
            missing.string() + ": cannot write: No such file or directory");
  EXPECT_THAT(error_of([&] { AtomicFile file(directory.path()); }), HasSubstr("Is a directory"));
  EXPECT_THAT(error_of([&] { AtomicFile file(""); }), HasSubstr("No such file"));
  write_file(directory / "plain", "x");
  EXPECT_THAT(error_of([&] { AtomicFile file(directory / "plain/a.png"); }),
              HasSubstr("Not a directory"));
}

TEST(AtomicFile, LeavesReadOnlyFilesAlone) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everything";
  const TemporaryDirectory directory;
  const auto path = directory / "a.txt";
  write_file(path, "old");
  ASSERT_EQ(chmod(path.c_str(), 0444), 0);
  EXPECT_THAT(error_of([&] { write_file(path, "new"); }), HasSubstr("Permission denied"));
  EXPECT_EQ(contents(path), "old");

  ASSERT_EQ(chmod(directory.path().c_str(), 0555), 0);
  EXPECT_THAT(error_of([&] { write_file(directory / "b.txt", "x"); }),
              HasSubstr("Permission denied"));
  ASSERT_EQ(chmod(directory.path().c_str(), 0755), 0);
}

TEST(AtomicFile, WritesToWhatIsNoFile) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
  write_file("/dev/null", "x");
  EXPECT_FALSE(std::filesystem::is_regular_file("/dev/null"));
  EXPECT_EQ(error_of([&] { write_file("/dev/full", "x"); }),
            "/dev/full: cannot write: No space left on device");
}

TEST(AtomicFile, AFullDiskHarmsNothing) {
  const TemporaryDirectory directory;
  if (mount("tmpfs", directory.path().c_str(), "tmpfs", 0, "size=64k") != 0) {
    GTEST_SKIP() << "cannot mount a small file system: " << std::strerror(errno);
  }
  const auto path = directory / "a.txt";
  write_file(path, "old");
  EXPECT_EQ(error_of([&] { write_file(path, std::string(1 << 20, 'x')); }),
            path.string() + ": cannot write: No space left on device");
  EXPECT_EQ(contents(path), "old");
  EXPECT_EQ(directory.num_entries(), 1U);
  EXPECT_EQ(umount(directory.path().c_str()), 0);
}

}  // namespace
}  // namespace motes
