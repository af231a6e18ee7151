// Temporary files go when the program is given up.
#include "core/temporary_files.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "core/atomic_file.h"
#include "support/temporary_directory.h"

namespace motes {
namespace {

TEST(TemporaryFiles, AreDeletedUnlessTheyWereTakenBack) {
  const TemporaryDirectory directory;
  const auto gone = directory / "gone", kept = directory / "kept";
  write_file(gone, "x");
  write_file(kept, "x");
  // Given up, it stays locked, and may not be destroyed.
  static TemporaryFiles& files = *new TemporaryFiles;
  files.add(gone);
  files.add(kept);
  files.remove(kept);
  files.abandon();
  EXPECT_FALSE(std::filesystem::exists(gone));
  EXPECT_TRUE(std::filesystem::exists(kept));
}

TEST(TemporaryFiles, MayBeOfSeveralThreads) {
  const TemporaryDirectory directory;
  static TemporaryFiles& files = *new TemporaryFiles;
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&directory, t] {
      for (int i = 0; i < 100; ++i) {
        const auto path = directory / (std::to_string(t) + "-" + std::to_string(i));
        files.add(path);
        if (i < 99) files.remove(path);
      }
      write_file(directory / (std::to_string(t) + "-99"), "x");
    });
  }
  for (std::thread& thread : threads) thread.join();
  files.abandon();
  for (int t = 0; t < 4; ++t) {
    EXPECT_FALSE(std::filesystem::exists(directory / (std::to_string(t) + "-99")));
  }
}

}  // namespace
}  // namespace motes
