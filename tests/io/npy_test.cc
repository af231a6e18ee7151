// NumPy's arrays: types, orders, structured ones, lying headers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>

#include "core/error.h"
#include "io/reader.h"
#include "support/truncation.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string header_text(const std::string& type, const std::string& order,
                        const std::string& shape) {
  return "{'descr': " + type + ", 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
}

std::string npy(const std::string& header, const std::string& data, int version = 1) {
  std::string length(version == 1 ? 2 : 4, '\0');
  length[0] = static_cast<char>(header.size() & 255);
  length[1] = static_cast<char>(header.size() >> 8);
  return std::string("\x93NUMPY") + static_cast<char>(version) + '\0' + length + header + data;
}

template <class T>
std::string bytes(const std::vector<T>& values, bool big_endian = false) {
  std::string out;
  for (const T value : values) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (big_endian) std::reverse(raw.begin(), raw.end());
    out.append(raw.data(), raw.size());
  }
  return out;
}

ParticleSet read(const std::string& content, const ReadOptions& options = {}) {
  const TemporaryFile file("a.npy", content);
  return open_trajectory(file.path(), options)->read_frame(0);
}

std::string error_of(const std::string& content) {
  const TemporaryFile file("a.npy", content);
  return error_of_reading(file.path());
}

template <class T>
void expect_read(const char* type, bool big_endian, int version) {
  const auto quoted = "'" + std::string(type) + "'";
  const ParticleSet c_order = read(npy(header_text(quoted, "False", "(2, 4)"),
                                       bytes<T>({1, 2, 3, 4, 5, 6, 7, 8}, big_endian), version));
  const ParticleSet fortran_order =
      read(npy(header_text(quoted, "True", "(2, 4)"),
               bytes<T>({1, 5, 2, 6, 3, 7, 4, 8}, big_endian), version));
  for (const ParticleSet& particles : {c_order, fortran_order}) {
    ASSERT_EQ(particles.size(), 2u) << type;
    EXPECT_EQ(particles.position(0), Point3d(1, 2, 3)) << type;
    EXPECT_EQ(particles.position(1), Point3d(5, 6, 7)) << type;
    EXPECT_THAT(particles.find_property("column4")->values, ElementsAre(4, 8)) << type;
  }
}

TEST(Npy, ReadsAllTypesOrdersAndVersions) {
  for (const int version : {1, 2, 3}) {
    expect_read<float>("<f4", false, version);
    expect_read<float>(">f4", true, version);
  }
  expect_read<double>("<f8", false, 1);
  expect_read<double>(">f8", true, 1);
  expect_read<std::int32_t>("<i4", false, 1);
  expect_read<std::int64_t>(">i8", true, 1);
  expect_read<std::uint16_t>("<u2", false, 1);
  expect_read<std::int8_t>("|i1", false, 1);
}

TEST(Npy, ReadsStructuredArrays) {
  const std::string header =
      header_text("[('species', '|S2'), ('pos', '<f4', (3,)), ('', '|S1'), ('charge', '>f8')]",
                  "False", "(2,)");
  const std::string data = "Si" + bytes<float>({1, 2, 3}) + "#" + bytes<double>({0.5}, true) +
                           std::string("O\0", 2) + bytes<float>({4, 5, 6}) + "#" +
                           bytes<double>({-1}, true);
  const ParticleSet particles = read(npy(header, data));
  EXPECT_EQ(particles.position(1), Point3d(4, 5, 6));
  EXPECT_THAT(particles.species_names, ElementsAre("Si", "O"));
  EXPECT_THAT(particles.find_property("charge")->values, ElementsAre(0.5, -1));
  EXPECT_EQ(particles.properties.size(), 1u);
}

TEST(Npy, NamesNumericTypes) {
  ReadOptions options;
  options.types = {{2, "O"}};
  const std::string header =
      header_text("[('x', '|i1'), ('y', '|i1'), ('z', '|i1'), ('type', '|u1')]", "False", "(1,)");
  EXPECT_THAT(read(npy(header, std::string("\1\2\3\2")), options).species_names, ElementsAre("O"));
}

TEST(Npy, RefusesShapesThatTheDataDoNotFill) {
  EXPECT_THAT(error_of(npy(header_text("'<f4'", "False", "(1000000000000, 3)"), "1234")),
              HasSubstr("holds 4 bytes of values; expected 12000000000000"));
  EXPECT_THAT(error_of(npy(header_text("'<f4'", "False", "(1, 3)"), std::string(13, '\0'))),
              HasSubstr("expected 12"));
}

TEST(Npy, RefusesWhatIsNoTableOfPositions) {
  const std::string data(24, '\0');
  EXPECT_THAT(error_of(npy(header_text("'<f4'", "False", "(6,)"), data)),
              HasSubstr("has the shape (6); expected N x 3"));
  EXPECT_THAT(error_of(npy(header_text("'<c8'", "False", "(1, 3)"), data)),
              HasSubstr("has values of type '<c8'"));
  EXPECT_THAT(error_of(npy(header_text("'|O'", "False", "(1, 3)"), data)),
              HasSubstr("has values of type '|O'"));
  EXPECT_THAT(error_of(npy(header_text("[('x', '<f4'), ('y', '<f8')]", "False", "(2,)"), data)),
              HasSubstr("has no field z"));
  EXPECT_THAT(error_of(npy("{'descr': __import__('os')", data)), HasSubstr("expected a string"));
  EXPECT_THAT(error_of(npy("{}", data)), HasSubstr("expected descr"));
}

TEST(Npy, CutShortIsAlwaysAnError) {
  expect_clear_errors_when_cut(
      "a.npy", npy(header_text("'<f4'", "False", "(50, 3)"), std::string(600, '\1')));
  EXPECT_NE(error_of(npy(header_text("'<f4'", "False", "(50, 3)"), std::string(599, '\1'))), "");
}

}  // namespace
}  // namespace motes
