// Selection expressions: values, precedence, errors with columns, hostile texts.
#include "particles/selection.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

#include "core/error.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Five particles: x = 0..4, y = 10 - x, z = -1, species Si O O Si H, ids 100..104.
ParticleSet five_particles() {
  ParticleSet particles;
  particles.origin = {1e6, 0, 0};
  particles.x = {-1e6f, 1 - 1e6f, 2 - 1e6f, 3 - 1e6f, 4 - 1e6f};
  particles.y = {10, 9, 8, 7, 6};
  particles.z = {-1, -1, -1, -1, -1};
  particles.species_names = {"Si", "O", "H"};
  particles.species = {0, 1, 1, 0, 2};
  particles.ids = {100, 101, 102, 103, 104};
  particles.properties = {{"charge", {0.5f, -0.5f, NAN, 2, 0}},
                          {"c_stress[1]", {1, 2, 3, 4, 5}},
                          {"two words", {5, 4, 3, 2, 1}}};
  return particles;
}

std::vector<std::uint32_t> select(std::string_view expression) {
  return select_where(five_particles(), expression);
}

std::string message_of(std::string_view expression) {
  try {
    select(expression);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SelectWhere, TakesPositionsInTheWorld) {
  EXPECT_THAT(select("x >= 3"), ElementsAre(3, 4));
  EXPECT_THAT(select("x + y == 10"), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(select("z > 0"), IsEmpty());
}

TEST(SelectWhere, KnowsEveryKindOfValue) {
  EXPECT_THAT(select("id == 102"), ElementsAre(2));
  EXPECT_THAT(select("index < 2"), ElementsAre(0, 1));
  EXPECT_THAT(select("species == 'Si'"), ElementsAre(0, 3));
  EXPECT_THAT(select("\"O\" == species"), ElementsAre(1, 2));
  EXPECT_THAT(select("species != 'Si' && species != 'Xe'"), ElementsAre(1, 2, 4));
  EXPECT_THAT(select("species == 'Xe'"), IsEmpty());
  EXPECT_THAT(select("c_stress[1] > 3"), ElementsAre(3, 4));
  EXPECT_THAT(select("`two words` > 3"), ElementsAre(0, 1));
}

TEST(SelectWhere, NaNComparesAsNothing) {
  EXPECT_THAT(select("charge > -10"), ElementsAre(0, 1, 3, 4));
  EXPECT_THAT(select("charge != charge"), ElementsAre(2));
  EXPECT_THAT(select("!(charge > 0)"), ElementsAre(1, 2, 4));
}

TEST(SelectWhere, FollowsTheUsualPrecedence) {
  EXPECT_THAT(select("x == 1 || x == 2 && y == 0"), ElementsAre(1));
  EXPECT_THAT(select("not x == 1 and x < 3"), ElementsAre(0, 2));
  EXPECT_THAT(select("x * 2 + 1 == 7"), ElementsAre(3));
  EXPECT_THAT(select("7 - 2 - 1 == x"), ElementsAre(4));
  EXPECT_THAT(select("-x^2 == -4"), ElementsAre(2));
  EXPECT_THAT(select("2^3^2 == 512 and x == 0"), ElementsAre(0));
  EXPECT_THAT(select("2^-1 == 0.5 and x == 0"), ElementsAre(0));
  EXPECT_THAT(select("12 / 3 / 2 == x"), ElementsAre(2));
  EXPECT_THAT(select("(x == 1) == (y == 9)"), ElementsAre(0, 1, 2, 3, 4));
}

TEST(SelectWhere, CallsFunctions) {
  EXPECT_THAT(select("abs(x - 2) <= 1"), ElementsAre(1, 2, 3));
  EXPECT_THAT(select("sqrt(x) == 2"), ElementsAre(4));
  EXPECT_THAT(select("log10(id - 100 + 99) == 2"), ElementsAre(1));
  EXPECT_THAT(select("exp(x) < 3"), ElementsAre(0, 1));
  EXPECT_THAT(select("min(x, y, 3) == 3"), ElementsAre(3, 4));
  EXPECT_THAT(select("max(x, 2) == 2"), ElementsAre(0, 1, 2));
}

TEST(SelectWhere, NamesColumnAndWhatWasExpected) {
  EXPECT_EQ(message_of("z >> 3"),
            "expression \"z >> 3\", column 4: expected a number, a name, a text in quotes or '(', "
            "found '>'");
  EXPECT_THAT(message_of(""), HasSubstr("column 1: expected a number"));
  EXPECT_THAT(message_of("z"), HasSubstr("the expression is a number; expected a condition"));
  EXPECT_THAT(message_of("(z > 3"), HasSubstr("column 7: expected ')', found the end"));
  EXPECT_THAT(message_of("z > 3)"), HasSubstr("column 6: expected an operator or the end"));
  EXPECT_THAT(message_of("z = 3"), HasSubstr("column 3: expected '=='"));
  EXPECT_THAT(message_of("0 < z < 3"), HasSubstr("comparisons do not chain"));
  EXPECT_THAT(message_of("z && x > 1"), HasSubstr("left of && is a number"));
  EXPECT_THAT(message_of("species == Si"),
              HasSubstr("column 12: unknown property 'Si'; text is written in quotes"));
  EXPECT_THAT(message_of("x == 'Si'"), HasSubstr("column 3: cannot compare a number with text"));
  EXPECT_THAT(message_of("species < 'Si'"), HasSubstr("expected numbers"));
  EXPECT_THAT(message_of("species == 'Si"), HasSubstr("closing '"));
  EXPECT_THAT(message_of("-species == 3"), HasSubstr("expected a number"));
  EXPECT_THAT(message_of("!z > 3"), HasSubstr("!(z > 3)"));
  EXPECT_THAT(message_of("sqrt(1, 2) > 3"), HasSubstr("takes one argument"));
  EXPECT_THAT(message_of("min(1) > 3"), HasSubstr("takes two arguments or more"));
  EXPECT_THAT(message_of("sqr(1) > 3"), HasSubstr("did you mean 'sqrt'?"));
  EXPECT_THAT(message_of("3z > 1"), HasSubstr("expected a number, found '3z'"));
  EXPECT_THAT(message_of("z > 1e999"), HasSubstr("fits a double"));
  EXPECT_THAT(message_of("z > 1 \xff"), HasSubstr("column 7"));
}

TEST(SelectWhere, NamesTheNearestProperty) {
  EXPECT_EQ(message_of("x > 1 && chrage > 0"),
            "expression \"x > 1 && chrage > 0\", column 10: unknown property 'chrage'; did you "
            "mean 'charge'?");
  for (const std::string wrong :
       {"specis == 'Si'", "specis < 'Si'", "specis == species", "`specis` != 'Si'"}) {
    EXPECT_THAT(message_of(wrong),
                HasSubstr("column 1: unknown property 'specis'; did you mean 'species'?"));
  }
  EXPECT_EQ(message_of("'Si' == specis"),
            "expression \"'Si' == specis\", column 9: unknown property 'specis'; did you mean "
            "'species'?");
  ParticleSet bare = five_particles();
  bare.ids.clear();
  bare.species.clear();
  EXPECT_THROW(select_where(bare, "id > 3"), Error);
  EXPECT_THROW(select_where(bare, "species == 'Si'"), Error);
}

TEST(CheckExpression, NeedsNoParticles) {
  EXPECT_NO_THROW(check_expression("whatever > 3"));
  EXPECT_THROW(check_expression("whatever >"), Error);
  // Whether a name is known, and holds a text, is seen with the particles.
  EXPECT_NO_THROW(check_expression("specis == 'Si'"));
  EXPECT_THROW(check_expression("specis < 'Si'"), Error);
  EXPECT_THROW(check_expression("specis == (z > 3)"), Error);
  EXPECT_THROW(check_expression("(specis == 'Si') > 3"), Error);
  EXPECT_THROW(check_expression("'Si' == 3"), Error);
}

TEST(CheckExpression, NestingIsLimitedNotFatal) {
  for (const std::string piece : {"(", "-", "!", "not ", "2^", "sqrt("}) {
    std::string deep;
    for (int i = 0; i < 200000; ++i) deep += piece;
    EXPECT_THROW(check_expression(deep + "1"), Error) << piece;
  }
  std::string flat = "x > 0";
  for (int i = 0; i < 2000; ++i) flat += " && x + 1 > 0";
  EXPECT_NO_THROW(check_expression(flat));
}

RC_GTEST_PROP(CheckExpression, AnyTextIsAnswered, (const std::string& text)) {
  try {
    check_expression(text);
  } catch (const Error&) {
  }
}

/// An expression's text, and what it is worth at (x, y).
struct Formula {
  std::string text;
  std::function<double(double, double)> value;
};

Formula random_formula(int depth) {
  const int kind = *rc::gen::inRange(0, depth > 0 ? 8 : 3);
  if (kind == 0) return {"x", [](double x, double) { return x; }};
  if (kind == 1) return {"y", [](double, double y) { return y; }};
  if (kind == 2) {
    const double number = *rc::gen::inRange(0, 100) / 8.0;
    return {fmt::format("{}", number), [number](double, double) { return number; }};
  }
  const Formula a = random_formula(depth - 1), b = random_formula(depth - 1);
  const auto f = a.value, g = b.value;
  switch (kind) {
    case 3:
      return {fmt::format("({} + {})", a.text, b.text),
              [=](double x, double y) { return f(x, y) + g(x, y); }};
    case 4:
      return {fmt::format("({}-{})", a.text, b.text),
              [=](double x, double y) { return f(x, y) - g(x, y); }};
    case 5:
      return {fmt::format("({} *{})", a.text, b.text),
              [=](double x, double y) { return f(x, y) * g(x, y); }};
    case 6:
      return {fmt::format("min( {},{})", a.text, b.text),
              [=](double x, double y) { return std::min(f(x, y), g(x, y)); }};
    default:
      return {fmt::format("-{}", a.text), [=](double x, double y) { return -f(x, y); }};
  }
}

RC_GTEST_PROP(SelectWhere, AgreesWithDirectEvaluation, ()) {
  const Formula left = random_formula(4), right = random_formula(4);
  const ParticleSet particles = five_particles();
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    const Point3d p = particles.position(i);
    if (left.value(p.x, p.y) <= right.value(p.x, p.y)) expected.push_back(i);
  }
  RC_ASSERT(select_where(particles, left.text + " <= " + right.text) == expected);
}

TEST(SelectWhere, KeepsOrderOverManyBlocks) {
  ParticleSet many;
  for (int i = 0; i < 300000; ++i) many.x.push_back(static_cast<float>(i % 7));
  many.y = many.z = many.x;
  const auto selected = select_where(many, "x == 3");
  ASSERT_EQ(selected.size(), 42857u);
  for (std::size_t k = 0; k < selected.size(); ++k) EXPECT_EQ(selected[k], 7 * k + 3);
}

}  // namespace
}  // namespace motes
