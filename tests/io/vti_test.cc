// VTI files: every way in which VTK stores an array.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <functional>

#include "core/base64.h"
#include "io/grid_fixture.h"
#include "io/text_fixture.h"
#include "support/scalar_bytes.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;

const std::vector<double> numbers{0, 1, 2, 3, 4, 100, 6, 7, 8, 9, 10, 11};
const std::string image =
    "<ImageData WholeExtent=\"0 1 0 2 0 1\" Origin=\"0 0 0\" Spacing=\"1 1 1\">\n"
    "<Piece Extent=\"0 1 0 2 0 1\">\n";

std::string file_attributes(bool big_endian, int header_bytes, bool compressed) {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
      "byte_order=\"{}\" header_type=\"{}\"{}>\n",
      big_endian ? "BigEndian" : "LittleEndian", header_bytes == 8 ? "UInt64" : "UInt32",
      compressed ? " compressor=\"vtkZLibDataCompressor\"" : "");
}

std::string header_numbers(const std::vector<double>& values, bool big_endian, int header_bytes) {
  return header_bytes == 8 ? scalar_bytes<std::uint64_t>(values, big_endian)
                           : scalar_bytes<std::uint32_t>(values, big_endian);
}

std::string deflated(const std::string& bytes) {
  std::string out(compressBound(bytes.size()), '\0');
  uLongf size = out.size();
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(out.data()), &size,
                     reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
            Z_OK);
  return out.substr(0, size);
}

/// An array's bytes as they stand in the file.
struct Storage {
  bool big_endian = false;
  int header_bytes = 4;
  std::size_t block_bytes = 0;  ///< 0: not compressed
  bool base64 = false;

  std::string encode(const std::string& bytes) const {
    const auto text = [&](const std::string& b) { return base64 ? encode_base64(b) : b; };
    if (block_bytes == 0) {
      const auto size = static_cast<double>(bytes.size());
      return text(header_numbers({size}, big_endian, header_bytes) + bytes);
    }
    std::vector<double> header{0, static_cast<double>(block_bytes),
                               static_cast<double>(bytes.size() % block_bytes)};
    std::string blocks;
    for (std::size_t at = 0; at < bytes.size(); at += block_bytes) {
      const std::string block = deflated(bytes.substr(at, block_bytes));
      header.push_back(static_cast<double>(block.size()));
      blocks += block;
      ++header[0];
    }
    // VTK encodes the two one by one.
    return text(header_numbers(header, big_endian, header_bytes)) + text(blocks);
  }
  std::string start() const { return file_attributes(big_endian, header_bytes, block_bytes > 0); }
};

std::string inline_file(const Storage& storage, const std::string& type, const std::string& bytes) {
  return storage.start() + image + "<PointData><DataArray type=\"" + type +
         "\" Name=\"f\" format=\"binary\">\n <InformationKey name=\"x\">1 2</InformationKey>\n" +
         storage.encode(bytes) + "\n</DataArray></PointData></Piece></ImageData></VTKFile>\n";
}

/// Two arrays, one behind the other.
std::string appended_file(const Storage& storage, const std::string& type,
                          const std::string& bytes) {
  const std::string data = storage.encode(bytes);
  return storage.start() + image +
         fmt::format(
             "<PointData><DataArray type=\"{0}\" Name=\"f\" format=\"appended\" "
             "offset=\"0\"/><DataArray type=\"{0}\" Name=\"g\" format=\"appended\" "
             "offset=\"{1}\"></DataArray></PointData></Piece></ImageData>\n"
             "<AppendedData encoding=\"{2}\">\n  _",
             type, data.size(), storage.base64 ? "base64" : "raw") +
         data + data + "\n</AppendedData>\n</VTKFile>\n";
}

struct TypeName {
  std::string name;
  std::function<std::string(bool big_endian)> bytes;
};

template <class T>
TypeName type_name(const std::string& name) {
  return {name, [](bool big_endian) { return scalar_bytes<T>(numbers, big_endian); }};
}

TEST(Vti, ReadsEveryTypeInEveryStorage) {
  const std::vector<TypeName> types{
      type_name<std::int8_t>("Int8"),   type_name<std::uint8_t>("UInt8"),
      type_name<std::int16_t>("Int16"), type_name<std::uint16_t>("UInt16"),
      type_name<std::int32_t>("Int32"), type_name<std::uint32_t>("UInt32"),
      type_name<std::int64_t>("Int64"), type_name<std::uint64_t>("UInt64"),
      type_name<float>("Float32"),      type_name<double>("Float64")};
  for (const TypeName& type : types) {
    for (const bool big_endian : {false, true}) {
      for (const int header_bytes : {4, 8}) {
        for (const std::size_t block_bytes : {0, 32, 32768}) {
          SCOPED_TRACE(fmt::format("{} big {} header {} blocks {}", type.name, big_endian,
                                   header_bytes, block_bytes));
          const std::string bytes = type.bytes(big_endian);
          Storage storage{big_endian, header_bytes, block_bytes, false};
          for (const Grid& grid : grids_of("a.vti", appended_file(storage, type.name, bytes))) {
            EXPECT_THAT(grid.values, ElementsAreArray(numbers));
          }
          storage.base64 = true;
          const auto appended = grids_of("a.vti", appended_file(storage, type.name, bytes));
          ASSERT_EQ(appended.size(), 2u);
          for (const Grid& grid : appended) EXPECT_THAT(grid.values, ElementsAreArray(numbers));
          const auto grids = grids_of("a.vti", inline_file(storage, type.name, bytes));
          ASSERT_EQ(grids.size(), 1u);
          EXPECT_EQ(grids[0].name, "f");
          EXPECT_THAT(grids[0].values, ElementsAreArray(numbers));
        }
      }
    }
  }
}

std::string ascii_file(const std::string& image_attributes, const std::string& piece,
                       const std::string& arrays) {
  return "<VTKFile type=\"ImageData\">\n<ImageData " + image_attributes + ">\n<Piece " + piece +
         ">\n" + arrays + "\n</Piece></ImageData></VTKFile>\n";
}

const std::string ascii_array =
    "<DataArray type=\"Float32\" Name=\"f &lt; 1\" format=\"ascii\">\n0 1 2 3 4 5\n6 7 8 9 10 11\n"
    "</DataArray>";

TEST(Vti, PlacesSamples) {
  const auto grids = grids_of(
      "a.vti", ascii_file("WholeExtent=\"2 3 -1 1 0 1\" Origin=\"10 20 30\" Spacing=\"1 2 4\" "
                          "Direction=\"0 -1 0 1 0 0 0 0 1\"",
                          "Extent=\"2 3 -1 1 0 1\"",
                          "<PointData>" + ascii_array +
                              "</PointData><CellData><DataArray type=\"Int8\" Name=\"c\">5 6"
                              "</DataArray></CellData>"));
  ASSERT_EQ(grids.size(), 2u);
  EXPECT_EQ(grids[0].name, "f < 1");
  EXPECT_THAT(grids[0].dims, ElementsAre(2, 3, 2));
  // The columns of the matrix: x goes along y, y against x.
  EXPECT_EQ(grids[0].steps[0], Vector3d(0, 1, 0));
  EXPECT_EQ(grids[0].steps[1], Vector3d(-2, 0, 0));
  EXPECT_EQ(grids[0].steps[2], Vector3d(0, 0, 4));
  EXPECT_EQ(grids[0].origin, Point3d(12, 22, 30)) << "of the first sample of the extent";
  EXPECT_EQ(grids[0].length_unit, "unknown");
  EXPECT_FALSE(grids[0].periodic);
  EXPECT_THAT(grids[0].values, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11));
  // Cells: the samples are their middles.
  EXPECT_THAT(grids[1].dims, ElementsAre(1, 2, 1));
  EXPECT_EQ(grids[1].origin, Point3d(11, 22.5, 32));
  EXPECT_THAT(grids[1].values, ElementsAre(5, 6));
}

TEST(Vti, LeavesOutWhatIsNoScalar) {
  const std::string vectors =
      "<DataArray type=\"Float32\" Name=\"v\" NumberOfComponents=\"3\">1 2 3</DataArray>";
  const std::string other = "<DataArray type=\"String\" Name=\"s\">a</DataArray>";
  const std::string extent = "Extent=\"0 1 0 2 0 1\"";
  Warnings warnings;
  const auto grids = grids_of(
      "a.vti",
      ascii_file("Whole" + extent, extent,
                 "<FieldData><DataArray type=\"Float32\" Name=\"t\">7</DataArray></FieldData>"
                 "<PointData>" +
                     vectors + ascii_array + other + "</PointData>"),
      &warnings);
  ASSERT_EQ(grids.size(), 1u);
  EXPECT_THAT(warnings.lines(),
              ElementsAre(HasSubstr("a.vti:4: array 'v' has 3 values of type Float32 a sample"),
                          HasSubstr("array 's' has 1 values of type String")));
  EXPECT_THAT(grid_error("a.vti", ascii_file("Whole" + extent, extent,
                                             "<PointData>" + vectors + "</PointData>")),
              HasSubstr("a.vti: has no array with one number a sample"));
}

TEST(Vti, IsKnownByItsContent) {
  const TemporaryFile file(
      "density", inline_file({.base64 = true}, "Float32", scalar_bytes<float>(numbers, false)));
  EXPECT_TRUE(is_grid_file(file.path()));
  const TemporaryFile mesh("mesh", "<VTKFile type=\"PolyData\">\n");
  EXPECT_FALSE(is_grid_file(mesh.path()));
}

TEST(Vti, CutShortIsRefused) {
  const std::string bytes = scalar_bytes<float>(numbers, false);
  for (const std::size_t block_bytes : {std::size_t{0}, std::size_t{32}}) {
    expect_refused_when_cut("a.vti", appended_file({.block_bytes = block_bytes}, "Float32", bytes));
    expect_refused_when_cut(
        "a.vti", inline_file({.block_bytes = block_bytes, .base64 = true}, "Float32", bytes));
  }
}

/// A file of raw appended bytes, of an array of the type Float32.
std::string appended_bytes(const std::string& bytes, bool compressed) {
  return file_attributes(false, 4, compressed) + image +
         "<PointData><DataArray type=\"Float32\" Name=\"f\" format=\"appended\" offset=\"0\"/>"
         "</PointData></Piece></ImageData><AppendedData encoding=\"raw\">_" +
         bytes + "</AppendedData></VTKFile>";
}

std::string blocks(const std::vector<double>& header, const std::string& bytes) {
  return appended_bytes(header_numbers(header, false, 4) + bytes, true);
}

class BadVti : public testing::TestWithParam<BadText> {};

TEST_P(BadVti, IsRefusedWithTheLine) {
  EXPECT_THAT(grid_error("a.vti", GetParam().text), HasSubstr(GetParam().message));
}

const std::string zeros = deflated(std::string(48, '\0'));

INSTANTIATE_TEST_SUITE_P(
    Texts, BadVti,
    testing::Values(
        BadText{"NoXml", "<VTKFile type=\"ImageData\">\n<ImageData\n<Piece>",
                "a.vti:3: is no good XML: "},
        BadText{"OtherRoot", "<VTK/>\n", "a.vti:1: expected VTKFile, found 'VTK'"},
        BadText{"OtherType", "<VTKFile type=\"PolyData\">", "a.vti:1: expected type of ImageData"},
        BadText{"Endian", "<VTKFile type=\"ImageData\" byte_order=\"Middle\">",
                "expected byte_order of LittleEndian or BigEndian, found 'Middle'"},
        BadText{"HeaderType", "<VTKFile type=\"ImageData\" header_type=\"Int32\">",
                "expected header_type of UInt32 or UInt64, found 'Int32'"},
        BadText{"Compressor", "<VTKFile type=\"ImageData\" compressor=\"vtkLZ4DataCompressor\">",
                "expected compressor of vtkZLibDataCompressor"},
        BadText{"NoPiece", "<VTKFile type=\"ImageData\"></VTKFile>",
                "a.vti: has 0 pieces of an image; expected 1"},
        BadText{"Backwards", ascii_file("WholeExtent=\"0 1 2 0 0 1\"", "", ""),
                "a.vti:2: expected an extent of 6 integers"},
        BadText{"HugeExtent", ascii_file("WholeExtent=\"0 9999999999 0 1 0 1\"", "", ""),
                "a.vti:2: expected an extent of 6 integers"},
        BadText{"OtherPiece",
                ascii_file("WholeExtent=\"0 1 0 2 0 1\"", "Extent=\"0 1 0 1 0 1\"", ""),
                "a.vti:3: expected one piece of the WholeExtent"},
        BadText{"TooLarge",
                ascii_file("WholeExtent=\"1 10000 1 10000 1 10000\"",
                           "Extent=\"1 10000 1 10000 1 10000\"",
                           "<PointData>" + ascii_array + "</PointData>"),
                "a.vti: samples, 10000 x 10000 x 10000 of them, of more than"},
        BadText{"Spacing",
                ascii_file("WholeExtent=\"0 1 0 2 0 1\" Spacing=\"1 2\"", "Extent=\"\"", ""),
                "a.vti:2: expected 3 numbers in Spacing, found '1 2'"},
        BadText{"Flat",
                ascii_file("WholeExtent=\"0 1 0 2 0 1\" Spacing=\"1 0 1\"",
                           "Extent=\"0 1 0 2 0 1\"", ""),
                "a.vti: has steps between its samples that span no volume"},
        BadText{
            "FewNumbers",
            ascii_file("WholeExtent=\"0 1 0 2 0 2\"", "Extent=\"0 1 0 2 0 2\"",
                       "<PointData>" + ascii_array + "</PointData>"),
            "a.vti:7: array 'f < 1' of 2 x 3 x 3 points by the Extent ends after 12 of 18 values"},
        BadText{
            "ManyNumbers",
            ascii_file("WholeExtent=\"0 1 0 2 0 0\"", "Extent=\"0 1 0 2 0 0\"",
                       "<PointData>" + ascii_array + "</PointData>"),
            "a.vti:6: expected the end of array 'f < 1' of 2 x 3 x 1 points by the Extent after 6 "
            "values, found '6'"},
        BadText{"NoOffset",
                ascii_file("WholeExtent=\"0 1 0 2 0 1\"", "Extent=\"0 1 0 2 0 1\"",
                           "<PointData><DataArray type=\"Int8\" format=\"appended\"/></PointData>"),
                "a.vti:4: expected the attribute offset of DataArray"},
        BadText{
            "NoAppended",
            ascii_file("WholeExtent=\"0 1 0 2 0 1\"", "Extent=\"0 1 0 2 0 1\"",
                       "<PointData><DataArray type=\"Int8\" format=\"appended\" "
                       "offset=\"9\"/></PointData>"),
            "a.vti:4: array 'value': begins at byte 9 of the appended data; expected at most 0"},
        BadText{
            "OtherSize",
            appended_bytes(header_numbers({44}, false, 4) + std::string(44, ' '), false),
            "array 'f': holds 44 bytes; expected 48 for 12 samples of 4 bytes, 2 x 3 x 2 points by "
            "the Extent"},
        BadText{
            "WrongEndian",
            appended_bytes(header_numbers({48}, true, 4) + std::string(48, ' '), false),
            "array 'f': holds 805306368 bytes; expected 48 for 12 samples of 4 bytes, 2 x 3 x 2 "
            "points by the Extent; with byte_order=\"BigEndian\" it holds these"},
        BadText{"Cut", appended_bytes(header_numbers({48}, false, 4), false),
                "array 'f': ends after 4 of 52 bytes"},
        BadText{"Junk", inline_file({.base64 = true}, "Float32", "") + "x",
                "a.vti:9: is no good XML: junk"},
        BadText{"BadBase64",
                file_attributes(false, 4, false) + image +
                    "<PointData><DataArray type=\"Int8\" Name=\"f\" format=\"binary\">Zm9$"
                    "</DataArray></PointData></Piece></ImageData></VTKFile>",
                "a.vti:5: array 'f': is no good base64"},
        BadText{"NoBlocks", blocks({0, 48, 0}, zeros), "array 'f': holds 0 bytes; expected 48"},
        BadText{"ManyBlocks", blocks({4e9, 4e9, 0, 1, 1}, zeros),
                "array 'f': holds 16000000000000000000 bytes; expected 48"},
        BadText{"EmptyBlocks", blocks({4e9, 0, 48, 1, 1}, zeros), "array 'f': has no blocks"},
        BadText{"ManySmallBlocks", blocks({48, 1, 0}, zeros),
                "array 'f': has blocks of 1 bytes; expected whole values of 4"},
        BadText{"NoTable", blocks({12, 4, 0}, ""), "array 'f': ends after 12 of 60 bytes"},
        BadText{"LongBlock", blocks({1, 48, 0, 4e9}, zeros),
                "array 'f': ends before block 1 of 1 is whole"},
        BadText{"BadBlock", blocks({1, 48, 0, 20}, std::string(20, 'x')),
                "array 'f': block 1 of 1 cannot be decompressed"},
        BadText{
            "ShortBlock",
            blocks({1, 48, 0, static_cast<double>(zeros.size())}, deflated(std::string(47, '\0'))),
            "array 'f': block 1 of 1 cannot be decompressed"}),
    [](const auto& bad) { return bad.param.name; });

// A size of 8 bytes reads the same as one of 4, whose values then begin 4 bytes early, and the
// other way round where the first value is 0.
TEST(Vti, ToldTheWrongHeaderTypeIsRefused) {
  const auto replaced = [](std::string text, int header_bytes) {
    const std::string right = header_bytes == 8 ? "UInt64" : "UInt32";
    return text.replace(text.find(right), 6, header_bytes == 8 ? "UInt32" : "UInt64");
  };
  // (zeros at the end are no padding)
  std::vector<double> values = numbers;
  values.back() = 0;
  const std::string bytes = scalar_bytes<float>(values, false);
  for (const int header_bytes : {4, 8}) {
    for (const bool base64 : {false, true}) {
      const Storage storage{.header_bytes = header_bytes, .base64 = base64};
      const std::string message = fmt::format(
          "array 'f': does not end behind its 48 bytes; with header_type=\"UInt{}\" it would",
          8 * header_bytes);
      const std::string appended = appended_file(storage, "Float32", bytes);
      EXPECT_EQ(grid_error("a.vti", appended), "");
      EXPECT_THAT(grid_error("a.vti", replaced(appended, header_bytes)), HasSubstr(message));
      if (!base64) continue;
      const std::string inside = inline_file(storage, "Float32", bytes);
      EXPECT_EQ(grid_error("a.vti", inside), "");
      EXPECT_THAT(grid_error("a.vti", replaced(inside, header_bytes)), HasSubstr(message));
    }
  }
}

// Numbers of the other width that make no sense.
TEST(Vti, NamesTheHeaderTypeThatWouldFit) {
  for (const std::size_t block_bytes : {std::size_t{0}, std::size_t{16}}) {
    for (const int header_bytes : {4, 8}) {
      const Storage storage{.header_bytes = header_bytes, .block_bytes = block_bytes};
      std::vector<double> values = numbers;
      values[0] = 1;
      std::string text = appended_file(storage, "Float32", scalar_bytes<float>(values, false));
      const std::string right = header_bytes == 8 ? "UInt64" : "UInt32";
      text.replace(text.find(right), 6, header_bytes == 8 ? "UInt32" : "UInt64");
      EXPECT_THAT(grid_error("a.vti", text),
                  HasSubstr(fmt::format("with header_type=\"{}\" it", right)))
          << block_bytes;
    }
  }
}

// Values in another order of bytes than the sizes in front of them.
TEST(Vti, WarnsOfValuesInTheOtherOrderOfBytes) {
  for (const std::size_t block_bytes : {std::size_t{0}, std::size_t{16}}) {
    const Storage storage{.block_bytes = block_bytes, .base64 = true};
    const auto warnings_of = [&](bool big_endian) {
      Warnings warnings;
      EXPECT_EQ(
          grid_error("a.vti",
                     inline_file(storage, "Float32", scalar_bytes<float>(numbers, big_endian)),
                     &warnings),
          "");
      return warnings.lines();
    };
    EXPECT_THAT(warnings_of(false), ElementsAre());
    EXPECT_THAT(warnings_of(true),
                ElementsAre(HasSubstr("a.vti:5: array 'f' has values that make no sense with "
                                      "byte_order=\"LittleEndian\"")));
  }
}

// A million of bytes cannot come from a few.
TEST(Vti, TakesNoMemoryForWhatCannotBeThere) {
  const std::string extent = "Extent=\"1 1000 1 1000 1 100\"";
  const std::string text =
      file_attributes(false, 8, true) + "<ImageData Whole" + extent + "><Piece " + extent +
      "><PointData><DataArray type=\"UInt8\" Name=\"f\" format=\"appended\" offset=\"0\"/>"
      "</PointData></Piece></ImageData><AppendedData encoding=\"raw\">_" +
      header_numbers({1, 1e8, 0, 50}, false, 8) + std::string(50, 'x') +
      "</AppendedData></VTKFile>";
  EXPECT_THAT(grid_error("a.vti", text),
              HasSubstr("array 'f': has 50 compressed bytes, which cannot be 100000000 values"));
}

}  // namespace
}  // namespace motes
