// Tables of text: separators, headers, roles of columns, faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/reader.h"
#include "support/truncation.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

ParticleSet read(const std::string& content, const ReadOptions& options = {}) {
  const TemporaryFile file("a.csv", content);
  return open_trajectory(file.path(), options)->read_frame(0);
}

std::string error_of(const std::string& content) {
  const TemporaryFile file("a.csv", content);
  return error_of_reading(file.path());
}

TEST(Csv, FindsColumnsByNameWhateverTheSeparator) {
  for (const std::string separator : {",", ";", "\t", " ", " , "}) {
    std::string content = "id|Z|species|x|y|mass|fixed\n7|3|Si|1|2|28|true\n\n8|6|O|4|5|16|false\n";
    for (std::size_t at; (at = content.find('|')) != std::string::npos;) {
      content.replace(at, 1, separator);
    }
    const ParticleSet particles = read(content);
    ASSERT_EQ(particles.size(), 2u) << separator;
    EXPECT_EQ(particles.position(0), Point3d(1, 2, 3));
    EXPECT_EQ(particles.position(1), Point3d(4, 5, 6));
    EXPECT_THAT(particles.ids, ElementsAre(7, 8));
    EXPECT_THAT(particles.species_names, ElementsAre("Si", "O"));
    EXPECT_THAT(particles.find_property("mass")->values, ElementsAre(28, 16));
    EXPECT_THAT(particles.find_property("fixed")->values, ElementsAre(1, 0));
  }
}

TEST(Csv, WithoutAHeaderTakesTheFirstThreeNumbers) {
  const ParticleSet particles = read("Si,1,2,3,9\nO,4,5,6,8\n");
  EXPECT_EQ(particles.position(1), Point3d(4, 5, 6));
  EXPECT_THAT(particles.species_names, ElementsAre("Si", "O"));
  EXPECT_THAT(particles.find_property("column5")->values, ElementsAre(9, 8));
}

TEST(Csv, TakesNamesFromTheCommentAboveTheRows) {
  const ParticleSet particles = read("# made by hand\n# z y x q\n1 2 3 4\n5 6 7 8\n");
  EXPECT_EQ(particles.position(0), Point3d(3, 2, 1));
  EXPECT_THAT(particles.find_property("q")->values, ElementsAre(4, 8));
}

TEST(Csv, SkipsCommentsAnywhere) {
  EXPECT_EQ(read("x,y,z\n# one\n1,2,3\n# two\n4,5,6\n").size(), 2u);
}

TEST(Csv, KeepsBlanksInQuotedNames) {
  const ParticleSet particles = read("x,y,z,species\n1,2,3,\"dark matter\"\n1,2,4,\"gas, hot\"\n");
  EXPECT_THAT(particles.species_names, ElementsAre("dark matter", "gas, hot"));
}

TEST(Csv, NamesNumericTypes) {
  ReadOptions options;
  options.types = {{1, "Si"}, {2, "O"}};
  const ParticleSet particles = read("x,y,z,type\n0,0,0,2\n0,0,1,1\n", options);
  EXPECT_EQ(particles.species_names[particles.species[0]], "O");
  EXPECT_EQ(particles.species_names[particles.species[1]], "Si");
}

TEST(Csv, ReadsWindowsLineEndsAndByteOrderMarks) {
  const ParticleSet particles = read("\xef\xbb\xbfx,y,z\r\n1,2,3\r\n");
  EXPECT_EQ(particles.position(0), Point3d(1, 2, 3));
}

TEST(Csv, FindsItsContentUnderAnyName) {
  const TemporaryFile file("points", "1 2 3\n4 5 6\n");
  EXPECT_EQ(open_trajectory(file.path(), {})->format(), "CSV");
}

TEST(Csv, NamesTheLineOfAFault) {
  EXPECT_THAT(error_of("x,y,z\n1,2,3\n1,2\n"), HasSubstr("a.csv:3: "));
  EXPECT_THAT(error_of("x,y,z\n1,2,3\n1,two,3\n"), HasSubstr("a.csv:3: "));
  EXPECT_THAT(error_of("x,y,z\n# note\n1,,3\n"), HasSubstr("a.csv:3: has an empty value"));
  EXPECT_THAT(error_of("x,y,z\n1,2,3,4\n"), HasSubstr("a.csv:2: has 4 values; expected 3"));
  EXPECT_THAT(error_of("x,y,q\n1,2,3\n"), HasSubstr("has not all of the columns x, y and z"));
  EXPECT_THAT(error_of("a,b\n1,2\n"), HasSubstr("fewer than three numbers"));
  EXPECT_THAT(error_of("x,y,z\n"), HasSubstr("ends here"));
  EXPECT_THAT(error_of(std::string("x,y,z\n1,2,3\0\n", 13)), HasSubstr("not a text"));
}

TEST(Csv, WarnsOfALastLineWithoutAnEnd) {
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  read("x,y,z\n1,2,3\n", options);
  EXPECT_THAT(warnings.lines(), IsEmpty());
  read("x,y,z\n1,2,3", options);
  EXPECT_THAT(warnings.lines(), ElementsAre(HasSubstr("may be cut short")));
}

TEST(Csv, CutShortIsAnErrorOfOneLineOrLess) {
  std::string content = "x,y,z,species\n";
  for (int i = 0; i < 100; ++i) content += std::to_string(i) + ".25,-3e-5,7.125,Si\n";
  expect_clear_errors_when_cut("a.csv", content);
}

}  // namespace
}  // namespace motes
