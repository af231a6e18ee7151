// What memory there is, from files as the kernel has them.
#include "core/memory.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <string>

#include "support/temporary_directory.h"

namespace motes {
namespace {

class AvailableMemory : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    const std::filesystem::path path = root_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  std::uint64_t available() const { return available_memory(root_ / ""); }

  TemporaryDirectory root_;
};

TEST_F(AvailableMemory, IsWhatTheMachineHasLeft) {
  EXPECT_EQ(available(), std::numeric_limits<std::uint64_t>::max());
  write("proc/meminfo", "MemTotal:  900 kB\nMemFree:  10 kB\nMemAvailable:    500 kB\n");
  EXPECT_EQ(available(), 500u * 1024);
}

TEST_F(AvailableMemory, IsLessUnderALimitOfAnyGroupAbove) {
  write("proc/meminfo", "MemAvailable:    1000 kB\n");
  write("proc/self/cgroup", "0::/a/b\n");
  EXPECT_EQ(available(), 1024000u);
  write("sys/fs/cgroup/a/b/memory.max", "max\n");
  write("sys/fs/cgroup/a/b/memory.current", "5000\n");
  EXPECT_EQ(available(), 1024000u);
  write("sys/fs/cgroup/a/memory.max", "100000\n");
  write("sys/fs/cgroup/a/memory.current", "30000\n");
  EXPECT_EQ(available(), 70000u);
  // What files have in the cache can be given back.
  write("sys/fs/cgroup/a/memory.stat", "anon 1\ninactive_file 10000\nslab 3\n");
  EXPECT_EQ(available(), 80000u);
  write("sys/fs/cgroup/a/b/memory.max", "6000\n");
  EXPECT_EQ(available(), 1000u);
  write("sys/fs/cgroup/a/b/memory.current", "7000\n");
  EXPECT_EQ(available(), 0u);
}

TEST_F(AvailableMemory, KnowsGroupsOfVersion1) {
  write("proc/meminfo", "MemAvailable:    1000 kB\n");
  write("proc/self/cgroup", "7:cpu:/x\n5:memory:/a\n0::/\n");
  write("sys/fs/cgroup/memory/a/memory.limit_in_bytes", "100000\n");
  write("sys/fs/cgroup/memory/a/memory.usage_in_bytes", "30000\n");
  write("sys/fs/cgroup/memory/a/memory.stat", "inactive_file 1\ntotal_inactive_file 5\n");
  EXPECT_EQ(available(), 70005u);
}

TEST_F(AvailableMemory, OfThisMachineIsSome) {
  EXPECT_GT(available_memory(), 1000000u);
  EXPECT_LT(available_memory(), std::uint64_t{1} << 60);
}

}  // namespace
}  // namespace motes
