// What is written in a text format is read back the same, whole or cut short, plain or compressed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <random>

#include "core/error.h"
#include "io/text_fixture.h"
#include "io/text_writers.h"
#include "support/compress.h"

namespace motes {
namespace {

struct TextFormat {
  std::string file_name;
  std::string (*write)(const std::vector<TestFrame>&);
  bool several_frames;
  std::string property;  ///< that holds TestFrame::values; "" if none does
};

void PrintTo(const TextFormat& format, std::ostream* out) { *out << format.file_name; }

const std::vector<TextFormat>& text_formats() {
  static const std::vector<TextFormat> formats{{"a.dump", to_dump, true, "f"},
                                               {"a.xyz", to_extxyz, true, "f"},
                                               {"a.gro", to_gro, true, ""},
                                               {"a.data", to_lammps_data, false, "q"}};
  return formats;
}

TestFrame random_frame(std::mt19937_64& random, std::size_t n) {
  std::uniform_int_distribution<int> hundredths(-10000, 10000);
  std::uniform_real_distribution<float> value(-1e6F, 1e6F);
  TestFrame frame;
  for (std::size_t i = 0; i < n; ++i) {
    frame.positions.push_back(
        {hundredths(random) / 100.0, hundredths(random) / 100.0, hundredths(random) / 100.0});
    frame.species.emplace_back(random() % 2 == 0 ? "O" : "Si");
    frame.values.push_back(value(random));
  }
  return frame;
}

std::vector<TestFrame> random_frames(std::uint64_t seed, std::size_t num_frames,
                                     std::size_t max_size) {
  std::mt19937_64 random(seed);
  std::vector<TestFrame> frames;
  for (std::size_t t = 0; t < num_frames; ++t) {
    frames.push_back(random_frame(random, random() % (max_size + 1)));
  }
  return frames;
}

/// Compares all but the last `num_uncertain` particles.
void expect_frame(const TextFormat& format, const ParticleSet& particles, const TestFrame& frame,
                  std::size_t num_uncertain = 0) {
  ASSERT_EQ(particles.size(), frame.positions.size());
  const Property* property = particles.find_property(format.property);
  if (particles.size() > 0) {
    ASSERT_EQ(property == nullptr, format.property.empty());
  }
  for (std::size_t i = 0; i + num_uncertain < particles.size(); ++i) {
    // Positions are floats near zero: 200 / 2^24 is the last bit.
    ASSERT_NEAR(length(particles.position(i) - frame.positions[i]), 0, 4e-5);
    ASSERT_EQ(particles.species_names[particles.species[i]], frame.species[i]);
    if (property != nullptr) {
      ASSERT_EQ(property->values[i], frame.values[i]);
    }
  }
}

RC_GTEST_PROP(TextRoundTrip, GivesAllFramesBack, ()) {
  const auto& format = text_formats()[*rc::gen::inRange<std::size_t>(0, text_formats().size())];
  const auto num_frames = *rc::gen::inRange<std::size_t>(1, 5);
  const auto max_size = *rc::gen::inRange<std::size_t>(1, 40);
  const auto frames = random_frames(*rc::gen::arbitrary<std::uint64_t>(),
                                    format.several_frames ? num_frames : 1, max_size);
  const bool compressed = *rc::gen::arbitrary<bool>();
  const std::string text = format.write(frames);
  const TemporaryFile file(format.file_name, compressed ? compress(text, "gzip") : text);
  const ReadOptions options;
  const auto trajectory = open_trajectory(file.path(), options);
  const auto first = *rc::gen::inRange<std::size_t>(0, frames.size());
  expect_frame(format, trajectory->read_frame(first), frames[first]);
  RC_ASSERT(trajectory->num_frames() == frames.size());
  for (std::size_t t = frames.size(); t-- > 0;) {
    expect_frame(format, trajectory->read_frame(t), frames[t]);
  }
  RC_ASSERT(!testing::Test::HasFailure());
}

class TextTruncation : public testing::TestWithParam<TextFormat> {};

TEST_P(TextTruncation, LosesNothingThatIsWholeAndSaysTheRest) {
  const TextFormat& format = GetParam();
  const auto frames = random_frames(7, format.several_frames ? 4 : 1, 30);
  const std::string text = format.write(frames);
  std::mt19937_64 random(3);
  for (int i = 0; i < 50; ++i) {
    const std::size_t cut = random() % text.size();
    SCOPED_TRACE(cut);
    const TemporaryFile file(format.file_name, text.substr(0, cut));
    Warnings warnings;
    ReadOptions options;
    options.warnings = &warnings;
    try {
      const auto trajectory = open_trajectory(file.path(), options);
      const std::size_t num_frames = trajectory->num_frames();
      ASSERT_LE(num_frames, frames.size());
      for (std::size_t t = 0; t < num_frames; ++t) {
        const auto particles = trajectory->read_frame(t);
        // The end of a number may be missing, and then there is a warning.
        const bool uncertain =
            t + 1 == num_frames && text[cut - 1] != '\n' && !warnings.lines().empty();
        expect_frame(format, particles, frames[t], uncertain ? 1 : 0);
      }
      if (num_frames < frames.size() && !warnings.lines().empty()) {
        EXPECT_THROW(trajectory->read_frame(num_frames), Error);
      }
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with(file.path().string() + ":")) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, TextTruncation, testing::ValuesIn(text_formats()),
                         [](const auto& format) { return format.param.file_name.substr(2); });

// Larger than the window of a compressed file and than a chunk of rows.
TEST(TextTrajectory, ReadsLargeFramesInAnyOrder) {
  std::mt19937_64 random(1);
  std::vector<TestFrame> frames;
  for (const std::size_t n : {1, 60000, 0, 3, 90000, 2}) frames.push_back(random_frame(random, n));
  for (const TextFormat& format : text_formats()) {
    if (!format.several_frames) continue;
    const std::string text = format.write(frames);
    for (const bool compressed : {false, true}) {
      SCOPED_TRACE(format.file_name + (compressed ? " compressed" : ""));
      const TemporaryFile file(format.file_name, compressed ? compress(text, "zstd") : text);
      const ReadOptions options;
      const auto trajectory = open_trajectory(file.path(), options);
      for (const std::size_t t : {1, 4, 0, 5, 2, 3, 1}) {
        expect_frame(format, trajectory->read_frame(t), frames[t]);
      }
      EXPECT_EQ(trajectory->num_frames(), frames.size());
    }
  }
}

TEST(TextTrajectory, NamesTheLineOfAnErrorFarDown) {
  std::mt19937_64 random(1);
  std::string text = to_dump({random_frame(random, 100), random_frame(random, 200000)});
  std::size_t line = 0, at = 0;
  for (; line < 150000; ++line) at = text.find('\n', at) + 1;
  text.insert(at, "x");
  const ReadOptions options;
  for (const bool compressed : {false, true}) {
    const TemporaryFile file("a.dump", compressed ? compress(text, "gzip") : text);
    EXPECT_THAT([&] { open_trajectory(file.path(), options)->read_frame(1); },
                testing::ThrowsMessage<Error>(
                    testing::HasSubstr("a.dump:150001: expected an integer for id")));
  }
}

class LastFraction : public Progress {
 public:
  void update(std::string_view activity, double fraction) override {
    EXPECT_THAT(std::string(activity), testing::HasSubstr("reading a.dump"));
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    value = fraction;
  }
  double value = 0;
};

TEST(TextTrajectory, ReportsProgress) {
  std::mt19937_64 random(1);
  const TemporaryFile file("a.dump", to_dump({random_frame(random, 100000)}));
  LastFraction progress;
  ReadOptions options;
  options.progress = &progress;
  open_trajectory(file.path(), options)->read_frame(0);
  EXPECT_EQ(progress.value, 1);
}

}  // namespace
}  // namespace motes
