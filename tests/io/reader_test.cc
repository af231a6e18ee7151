// Finding the format of a file.
#include "io/reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/in_memory.h"
#include "support/temporary_file.h"

namespace motes {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(OpenTrajectory, RefusesEmptyAndUnknownFiles) {
  const TemporaryFile empty("a.xyz"), unknown("a.unknown", "what is this\n");
  EXPECT_THAT([&] { open_trajectory(empty.path(), {}); },
              ThrowsMessage<Error>(HasSubstr("is empty")));
  EXPECT_THAT([&] { open_trajectory(unknown.path(), {}); },
              ThrowsMessage<Error>(HasSubstr("unknown format; expected one of")));
  EXPECT_THAT([&] { open_trajectory("/no/such/file", {}); },
              ThrowsMessage<Error>(HasSubstr("there is no such file")));
}

TEST(InMemoryTrajectory, NamesTheNumberOfFrames) {
  InMemoryTrajectory one("test", "a.one", std::vector<ParticleSet>(1));
  InMemoryTrajectory three("test", "a.three", std::vector<ParticleSet>(3));
  EXPECT_EQ(three.num_frames(), 3u);
  EXPECT_EQ(three.read_frame(2).size(), 0u);
  EXPECT_THAT([&] { three.read_frame(3); }, ThrowsMessage<Error>(HasSubstr("expected 0 to 2")));
  EXPECT_THAT([&] { one.read_frame(1); }, ThrowsMessage<Error>(HasSubstr("has no frame 1")));
}

}  // namespace
}  // namespace motes
