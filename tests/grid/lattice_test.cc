// Lattices over boxes, and what fits into memory.
#include "grid/lattice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/error.h"

namespace motes {
namespace {

using testing::HasSubstr;

Point3d last_sample(const Lattice& lattice) {
  Point3d last = lattice.origin;
  for (int a = 0; a < 3; ++a) {
    last[a] += double(lattice.dims[static_cast<std::size_t>(a)] - 1) * lattice.step[a];
  }
  return last;
}

TEST(Lattice, OfASizeCoversTheBoxInItsMiddle) {
  const Bounds3d box{{-1, 2, 1e6}, {9, 2.5, 1e6 + 7.3}};
  for (const double size : {0.3, 1., 4., 100.}) {
    const Lattice lattice = lattice_of_size(box, size);
    const Point3d last = last_sample(lattice);
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(lattice.step[a], size);
      EXPECT_LE(lattice.origin[a], box.min[a] + 1e-9);
      EXPECT_GE(last[a], box.max[a] - 1e-9);
      EXPECT_LT(last[a] - lattice.origin[a], box.diagonal()[a] + size);
      EXPECT_NEAR(box.min[a] - lattice.origin[a], last[a] - box.max[a], 1e-9);
    }
  }
}

TEST(Lattice, OfASizeThatDividesTheBoxHasNoStepMore) {
  for (const int n : {1, 3, 7, 10, 49, 1000}) {
    const Bounds3d box{{0.1, -3, 2}, {0.1 + 4.7, -3 + 4.7, 2 + 4.7}};
    const Lattice lattice = lattice_of_size(box, 4.7 / n);
    for (const std::size_t dim : lattice.dims) EXPECT_EQ(dim, std::size_t(n) + 1);
  }
}

TEST(Lattice, OfCountsReachesFromFaceToFace) {
  const Bounds3d box{{-1, 2, 3}, {9, 2.5, 10}};
  const Lattice lattice = lattice_of_counts(box, {2, 11, 8});
  EXPECT_EQ(lattice.origin, box.min);
  EXPECT_EQ(lattice.dims, (std::array<std::size_t, 3>{2, 11, 8}));
  EXPECT_NEAR(length(last_sample(lattice) - box.max), 0, 1e-14);
}

TEST(Lattice, OfTooManySamplesIsRefused) {
  const Bounds3d box{{0, 0, 0}, {1, 2, 3}};
  try {
    lattice_of_size(box, 1e-9);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("expected at most 16777216"));
  }
}

TEST(Lattice, ThatDoesNotFitIsRefusedWithASizeThatDoes) {
  const Bounds3d box{{0, 0, 0}, {100, 60, 3}};
  for (const double voxel_size : {0.1, 0.01, 1e-4}) {
    for (const std::size_t num_fields : {1u, 3u}) {
      for (const std::uint64_t limit : {100000u, 3000000u}) {
        const Lattice lattice = lattice_of_size(box, voxel_size);
        if (sample_bytes(lattice, num_fields) <= double(limit)) {
          EXPECT_NO_THROW(expect_to_fit(lattice, num_fields, limit));
          continue;
        }
        std::string message;
        try {
          expect_to_fit(lattice, num_fields, limit);
        } catch (const Error& error) {
          message = error.what();
        }
        const std::string before = "voxels of ";
        const std::size_t place = message.find(before);
        ASSERT_NE(place, std::string::npos) << message;
        ASSERT_NE(message.find(" would fit", place), std::string::npos) << message;
        const Lattice fitting =
            lattice_of_size(box, std::stod(message.substr(place + before.size())));
        EXPECT_LE(sample_bytes(fitting, num_fields), double(limit)) << message;
        // Not far from what would just fit.
        EXPECT_GT(sample_bytes(fitting, num_fields), 0.7 * double(limit)) << message;
      }
    }
  }
}

TEST(Lattice, SaysWhatItTakes) {
  try {
    expect_to_fit({{}, {1, 1, 1}, {1000, 2000, 3000}}, 2, 8000000000);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(
        error.what(),
        "a grid of 1000 x 2000 x 3000 samples of 2 fields takes 48 GB of memory, there are "
        "8 GB; voxels of 1.82 would fit");
  }
  try {
    expect_to_fit({{}, {1, 1, 1}, {2, 2, 2}}, 1, 31);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "a grid of 2 x 2 x 2 samples takes 32 bytes of memory, there are 31 bytes");
  }
  EXPECT_NO_THROW(expect_to_fit({{}, {1, 1, 1}, {2, 2, 2}}, 1, 32));
}

}  // namespace
}  // namespace motes
