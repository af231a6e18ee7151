// NRRD files: every type and encoding, and what is not to be read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>

#include "io/grid_fixture.h"
#include "io/scalars.h"
#include "io/text_fixture.h"
#include "support/compress.h"
#include "support/scalar_bytes.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;

const std::vector<double> numbers{0, 1, 2, 3, 4, 100, 6, 7, 8, 9, 10, 11};
const std::string sizes = "dimension: 3\nsizes: 2 3 2\n";

std::string header(const std::string& type, const std::string& encoding,
                   const std::string& more = "endian: little\n") {
  return "NRRD0004\n# a comment\n" + sizes + "type: " + type + "\nencoding: " + encoding + "\n" +
         more;
}

const std::string float_bytes = scalar_bytes<float>(numbers, false);

struct TypeName {
  std::string name;
  std::function<std::string(bool big_endian)> bytes;
};

template <class T>
TypeName type_name(const std::string& name) {
  return {name, [](bool big_endian) { return scalar_bytes<T>(numbers, big_endian); }};
}

TEST(Nrrd, ReadsEveryTypeInEveryEncoding) {
  const std::vector<TypeName> types{type_name<std::int8_t>("signed char"),
                                    type_name<std::uint8_t>("uchar"),
                                    type_name<std::int16_t>("short"),
                                    type_name<std::uint16_t>("unsigned short int"),
                                    type_name<std::int32_t>("int32_t"),
                                    type_name<std::uint32_t>("unsigned int"),
                                    type_name<std::int64_t>("longlong"),
                                    type_name<std::uint64_t>("uint64"),
                                    type_name<float>("float"),
                                    type_name<double>("Double")};
  for (const TypeName& type : types) {
    for (const bool big_endian : {false, true}) {
      SCOPED_TRACE(type.name + (big_endian ? " big" : " little"));
      const std::string endian = big_endian ? "endian: big\n" : "endian: little\n";
      const std::string bytes = type.bytes(big_endian);
      for (const auto& [encoding, stored] : {std::pair<std::string, std::string>{"raw", bytes},
                                             {"gzip", compress(bytes, "gzip")},
                                             {"bz2", compress(bytes, "bzip2")},
                                             {"ascii", "0 1 2\n3 4 100 6 7\n8\n9 1e1 11.0\n"}}) {
        const auto grids = grids_of("a.nrrd", header(type.name, encoding, endian) + "\n" + stored);
        ASSERT_EQ(grids.size(), 1u);
        EXPECT_THAT(grids[0].values, ElementsAreArray(numbers)) << encoding;
      }
    }
  }
}

TEST(Nrrd, WarnsOfTheOtherOrderOfBytes) {
  const auto warnings_of = [](const std::string& type, const std::string& bytes,
                              const std::string& encoding) {
    Warnings warnings;
    const std::string stored = encoding == "gzip" ? compress(bytes, "gzip") : bytes;
    EXPECT_EQ(grid_error("a.nrrd", header(type, encoding) + "\n" + stored, &warnings), "");
    return warnings.lines();
  };
  const std::vector<double> mask{0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0};
  const std::vector<double> tiny(12, 1e-30), huge(12, 1e38);
  for (const std::string encoding : {"raw", "gzip"}) {
    for (const auto& values : {numbers, mask}) {
      EXPECT_THAT(warnings_of("float", scalar_bytes<float>(values, true), encoding),
                  ElementsAre(HasSubstr("a.nrrd: has values that make no sense with 'endian: "
                                        "little', but would with 'endian: big'")));
      EXPECT_THAT(warnings_of("double", scalar_bytes<double>(values, true), encoding).size(), 1);
      EXPECT_THAT(warnings_of("float", scalar_bytes<float>(values, false), encoding),
                  ElementsAre());
    }
    // What is odd either way, or not real, is left alone.
    EXPECT_THAT(warnings_of("float", scalar_bytes<float>(tiny, false), encoding), ElementsAre());
    EXPECT_THAT(warnings_of("float", scalar_bytes<float>(huge, false), encoding), ElementsAre());
    EXPECT_THAT(warnings_of("short", scalar_bytes<std::int16_t>(numbers, true), encoding),
                ElementsAre());
  }
}

TEST(Nrrd, TellsTheOrderOfBytesOfSmoothFields) {
  for (const double width : {0.5, 2., 8., 1e6}) {
    std::vector<double> gaussian;
    for (int n = 0; n < 11 * 11 * 11; ++n) {
      const int x = n % 11 - 5, y = n / 11 % 11 - 5, z = n / 121 - 5;
      gaussian.push_back(std::exp(-0.5 * (x * x + y * y + z * z) / (width * width)));
    }
    const std::string bytes = scalar_bytes<float>(gaussian, true);
    EXPECT_FALSE(looks_swapped(bytes, ScalarType::float32, true)) << width;
    // The narrowest has values beyond all use itself.
    EXPECT_EQ(looks_swapped(bytes, ScalarType::float32, false), width > 1) << width;
  }
}

TEST(Nrrd, PlacesSamplesInSpace) {
  const Grid grid = grids_of("a.nrrd", header("float", "raw") +
                                           "space dimension: 3\nspace directions: (1,2,0) (0, 3, 4)"
                                           "(-1e-1,0,5)\nspace origin: (7,8,-9)\nkinds: domain "
                                           "domain domain\nspace units: \"nm\" \"nm\" \"nm\"\n"
                                           "content: the field\nowner:=me: myself\n\n" +
                                           float_bytes)[0];
  EXPECT_EQ(grid.name, "the field");
  EXPECT_EQ(grid.length_unit, "nm");
  EXPECT_THAT(grid.dims, ElementsAre(2, 3, 2));
  EXPECT_EQ(grid.origin, Point3d(7, 8, -9));
  EXPECT_EQ(grid.steps[0], Vector3d(1, 2, 0));
  EXPECT_EQ(grid.steps[1], Vector3d(0, 3, 4));
  EXPECT_EQ(grid.steps[2], Vector3d(-0.1, 0, 5));
  EXPECT_FALSE(grid.periodic);
}

TEST(Nrrd, PlacesSamplesByAxes) {
  const auto place = [](const std::string& fields) {
    return grids_of("a.nrrd", header("float", "raw") + fields + "\n" + float_bytes)[0];
  };
  const Grid unit = place("");
  EXPECT_EQ(unit.origin, Point3d());
  EXPECT_EQ(unit.steps[2], Vector3d(0, 0, 1));
  EXPECT_EQ(unit.name, "value");
  EXPECT_EQ(unit.length_unit, "unknown");
  const Grid spaced = place("spacings: 0.5 NaN 2\nunits: \"mm\" \"mm\" \"mm\"\n");
  EXPECT_EQ(spaced.origin, Point3d());
  EXPECT_EQ(spaced.steps[0], Vector3d(0.5, 0, 0));
  EXPECT_EQ(spaced.steps[1], Vector3d(0, 1, 0));
  EXPECT_EQ(spaced.length_unit, "mm");
  // The middle of the first cell, or the first node.
  const Grid cells = place("axis mins: 1 1 1\naxis maxs: 2 4 3\ncenters: cell node node\n");
  EXPECT_EQ(cells.origin, Point3d(1.25, 1, 1));
  EXPECT_EQ(cells.steps[0], Vector3d(0.5, 0, 0));
  EXPECT_EQ(cells.steps[1], Vector3d(0, 1.5, 0));
  EXPECT_EQ(cells.steps[2], Vector3d(0, 0, 2));
}

TEST(Nrrd, FindsValuesInAFileOfTheirOwn) {
  const TemporaryDirectory directory;
  const auto write = [&](const std::string& name, const std::string& content) {
    std::ofstream(directory / name, std::ios::binary) << content;
  };
  const auto read = [&](const std::string& head) {
    write("a.nhdr", head);
    return read_grids(directory / "a.nhdr", {})[0].values;
  };
  write("a.raw", "two\nlines\nxyz" + float_bytes);
  EXPECT_THAT(read(header("float", "raw") + "data file: a.raw\nline skip: 2\nbyteskip: 3\n"),
              ElementsAreArray(numbers));
  EXPECT_THAT(read(header("float", "raw") + "datafile: a.raw\nbyte skip: -1"),
              ElementsAreArray(numbers));
  write("a.raw.gz", compress("xyz" + float_bytes, "gzip"));
  EXPECT_THAT(read(header("float", "gz") + "data file: a.raw.gz\nbyte skip: 3\n\nand more"),
              ElementsAreArray(numbers));
  write("a.raw.xz", compress(float_bytes, "xz"));
  EXPECT_THAT(read(header("float", "raw") + "data file: a.raw.xz\n"), ElementsAreArray(numbers));
  write("a.txt", "title\n0 1 2 3 4 100 6 7 8 9 10 11\n");
  EXPECT_THAT(read(header("float", "text") + "data file: " + (directory / "a.txt").string() +
                   "\nline skip: 1\n"),
              ElementsAreArray(numbers));
  EXPECT_THAT([&] { read(header("float", "raw") + "data file: b.raw\n"); },
              testing::ThrowsMessage<Error>(HasSubstr("b.raw: there is no such file")));
  EXPECT_THAT([&] { read(header("float", "raw") + "data file: a.raw\nline skip: 99\n"); },
              testing::ThrowsMessage<Error>(HasSubstr("a.raw:")));
}

TEST(Nrrd, MayBeCompressedAsAWhole) {
  const std::string content = header("float", "raw") + "\n" + float_bytes;
  for (const char* filter : {"gzip", "bzip2", "xz", "zstd"}) {
    const TemporaryFile file("a.bin", compress(content, filter));
    EXPECT_TRUE(is_grid_file(file.path()));
    EXPECT_THAT(read_grids(file.path(), {})[0].values, ElementsAreArray(numbers)) << filter;
  }
}

// More than a block of the stream.
TEST(Nrrd, ReadsLargeCompressedValues) {
  std::vector<double> many(130 * 70 * 50);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<double>(i % 1000);
  const Grid grid = grids_of("a.nrrd",
                             "NRRD0005\ndimension: 3\nsizes: 130 70 50\ntype: double\n"
                             "endian: big\nencoding: gzip\n\n" +
                                 compress(scalar_bytes<double>(many, true), "gzip"))[0];
  EXPECT_THAT(grid.values, ElementsAreArray(many));
}

TEST(Nrrd, CutShortIsRefused) {
  expect_refused_when_cut("a.nrrd", header("float", "raw") + "\n" + float_bytes);
  expect_refused_when_cut("a.nrrd", header("float", "gzip") + "\n" + compress(float_bytes, "gzip"));
  expect_refused_when_cut("a.nrrd", header("float", "ascii") + "\n0 1 2 3 4 5 6 7 8 9 10 11\n");
}

class BadNrrd : public testing::TestWithParam<BadText> {};

TEST_P(BadNrrd, IsRefusedWithTheLine) {
  EXPECT_THAT(grid_error("a.nrrd", GetParam().text), HasSubstr(GetParam().message));
}

std::string with_sizes(const std::string& dims) {
  return "NRRD0004\ndimension: 3\nsizes: " + dims +
         "\ntype: float\nencoding: raw\nendian: little\n\n" + float_bytes;
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BadNrrd,
    testing::Values(
        BadText{"Version", "NRRD0009\n\n", "a.nrrd:1: expected NRRD0001 to NRRD0005"},
        BadText{"NoField", "NRRD0004\ntype float\n\n", "a.nrrd:2: expected 'FIELD: VALUE'"},
        BadText{"UnknownField", "NRRD0004\nspacing: 1 1 1\n\n",
                "a.nrrd:2: unknown field of the header 'spacing'; did you mean 'spacings'?"},
        BadText{"NoType", "NRRD0004\n" + sizes + "encoding: raw\n\n",
                "a.nrrd: has a header without 'type:'"},
        BadText{"Block", header("block", "raw") + "\n", "a.nrrd:5: expected a type of numbers"},
        BadText{"Hex", header("float", "hex") + "\n",
                "a.nrrd:6: expected the encoding raw, gzip, bzip2 or ascii, found 'hex'"},
        BadText{"Endian", header("float", "raw", "endian: middle\n") + "\n",
                "a.nrrd:7: expected the byte order little or big, found 'middle'"},
        BadText{"NoEndian", header("float", "raw", "") + "\n" + float_bytes,
                "a.nrrd: has a header without 'endian:'"},
        BadText{"FourAxes",
                "NRRD0004\ndimension: 4\nsizes: 3 2 3 2\ntype: uchar\nencoding: raw\n\n",
                "a.nrrd:2: expected 3 axes of space and one number a sample, found '4'"},
        BadText{"Vectors", header("float", "raw") + "kinds: vector domain domain\n\n",
                "a.nrrd:8: expected axes of the kind domain or space"},
        BadText{"FewSizes", with_sizes("2 3"), "a.nrrd:3: expected 3 sizes, found '2 3'"},
        BadText{"ZeroSize", with_sizes("2 0 3"), "a.nrrd:3: expected 3 sizes of at least 1"},
        BadText{"NegativeSize", with_sizes("2 -3 3"), "a.nrrd:3: expected 3 sizes of at least 1"},
        BadText{"HugeSize", with_sizes("10000 10000 10000"), "a.nrrd: samples, 10000 x 10000 x"},
        BadText{"Overflow",
                with_sizes("6000000000000000000 6000000000000000000 6000000000000000000"),
                "a.nrrd: samples, 6000000000000000000 x"},
        BadText{"LargeSize", with_sizes("1000 1000 100"),
                "a.nrrd: holds 48 bytes of values; expected 400000000 for 1000 x 1000 x 100"},
        BadText{"ManyBytes", with_sizes("2 2 2"), "holds 48 bytes of values; expected 32"},
        BadText{"PlaneDirections", header("float", "raw") + "space directions: (1,0) (0,1)\n\n",
                "a.nrrd:8: expected 3 vectors (x,y,z), one an axis"},
        BadText{"NoDirections",
                header("float", "raw") + "space directions: none (0,1,0) (0,0,1)\n\n",
                "a.nrrd:8: expected 3 vectors"},
        BadText{"FlatDirections",
                header("float", "raw") + "space directions: (1,0,0) (0,1,0) (1,1,0)\n\n",
                "a.nrrd: has steps between its samples that span no volume"},
        BadText{"Spacings", header("float", "raw") + "spacings: 1 1\n\n",
                "a.nrrd:8: expected 3 numbers, found '1 1'"},
        BadText{"FourSpaces", header("float", "raw") + "space dimension: 4\n\n",
                "a.nrrd:8: expected a space of 3 dimensions"},
        BadText{"Files", header("float", "raw") + "data file: a%03d.raw 1 2 1\n",
                "a.nrrd:8: expected one file of values"},
        BadText{"NotCompressed", header("float", "gzip") + "\n" + float_bytes,
                "a.nrrd: has values that are not compressed"},
        BadText{"FewCompressed",
                header("float", "gzip") + "\n" + compress(float_bytes.substr(5), "gzip"),
                "a.nrrd: holds 43 bytes of values; expected 48"},
        BadText{"ManyCompressed",
                header("float", "gzip") + "\n" + compress(float_bytes + "x", "gzip"),
                "a.nrrd: holds 49 bytes of values; expected 48"},
        BadText{"FewNumbers", header("float", "ascii") + "\n1 2 3\n",
                "a.nrrd:10: the file ends after 3 of 12 values"},
        BadText{"ManyNumbers", header("float", "ascii") + "\n0 1 2 3 4 5 6 7 8 9 10 11\n12\n",
                "a.nrrd:10: expected the end of the file after 12 values, found '12'"}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace motes
