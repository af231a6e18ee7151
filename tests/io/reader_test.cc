// Finding the format of a file.
#include "io/reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/in_memory.h"
#include "support/temporary_file.h"

namespace motes {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(OpenTrajectory, RefusesEmptyAndUnknownFiles) {
  const TemporaryFile empty("a.xyz"), unknown("a.unknown", "what is this\n");
  EXPECT_THAT([&] { open_trajectory(empty.path(), {}); },
              ThrowsMessage<Error>(HasSubstr("is empty")));
  EXPECT_THAT([&] { open_trajectory(unknown.path(), {}); },
              ThrowsMessage<Error>(AllOf(HasSubstr("unknown format; expected one of HDF5"),
                                         HasSubstr("NRRD, VTI"))));
  EXPECT_THAT([&] { open_trajectory("/no/such/file", {}); },
              ThrowsMessage<Error>(HasSubstr("there is no such file")));
}

TEST(OpenTrajectory, NamesWellKnownFormatsThatItDoesNotRead) {
  using std::string_literals::operator""s;
  for (const auto& [name, content, format] :
       {std::tuple{"snapshot_000", "\0\1\0\0\0\0\0\0"s, "like GADGET binary, which"},
        std::tuple{"snapshot_001", "\0\0\1\0\0\0\0\0"s, "like GADGET binary, which"},
        std::tuple{"snapshot_002", "\x8\0\0\0HEAD"s, "like GADGET binary, which"},
        std::tuple{"a.bin", "\0\0\x07\xcb\0\0"s, "like XTC, which"},
        std::tuple{"a.bin", "T\0\0\0\0\0\0\0CORD"s, "like DCD, which"},
        std::tuple{"a.bin", "CDF\2\0"s, "like NetCDF, which"},
        std::tuple{"a.tipsy.gz", "\0\0"s, "like TIPSY, which"}}) {
    const TemporaryFile file(name, content);
    EXPECT_THAT([&] { open_trajectory(file.path(), {}); },
                ThrowsMessage<Error>(
                    AllOf(HasSubstr(format), HasSubstr("does not read; expected one of HDF5"))));
  }
}

TEST(OpenTrajectory, SaysOneThingOfADamagedFileWithoutALastEnd) {
  for (const auto& [name, content] :
       {std::pair{"a.csv", "x,y,z\n1,2,3\n4,5"}, std::pair{"a.xyz", "2\n\nC 0 0 0\nC 0 0"},
        std::pair{"a.cif", "data_a\nloop_\n_a\n_b\n1"}}) {
    const TemporaryFile file(name, content);
    Warnings warnings;
    EXPECT_THROW(open_trajectory(file.path(), {{}, nullptr, &warnings})->read_frame(0), Error);
    EXPECT_THAT(warnings.lines(), testing::IsEmpty()) << name;
  }
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
