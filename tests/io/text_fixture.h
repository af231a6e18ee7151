// What the tests of text formats share.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/reader.h"
#include "support/temporary_file.h"

namespace motes {

/// Reads a frame of a file `name` with this content.
inline ParticleSet read_text(std::string_view name, std::string_view text,
                             const ReadOptions& options = {}, std::size_t frame = 0) {
  const TemporaryFile file(name, text);
  return open_trajectory(file.path(), options)->read_frame(frame);
}

inline std::vector<std::string> species_of(const ParticleSet& particles) {
  std::vector<std::string> names;
  for (const std::uint16_t index : particles.species) {
    names.push_back(particles.species_names[index]);
  }
  return names;
}

inline void expect_position(const ParticleSet& particles, std::size_t i, Point3d expected) {
  ASSERT_LT(i, particles.size());
  EXPECT_NEAR(particles.position(i).x, expected.x, 1e-5);
  EXPECT_NEAR(particles.position(i).y, expected.y, 1e-5);
  EXPECT_NEAR(particles.position(i).z, expected.z, 1e-5);
}

/// A text that must be refused, and a part of the message.
struct BadText {
  std::string name, text, message;
};

}  // namespace motes
