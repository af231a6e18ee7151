// Temporary files go when the program is given up.
#include "core/temporary_files.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace motes
