// The table of elements and what counts as the name of one.
#include "particles/elements.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace motes {
namespace {

std::string symbol_of(std::string_view name) {
  const Element* element = find_element(name);
  return element == nullptr ? "" : std::string(element->symbol);
}

TEST(Elements, TableIsInOrderOfAtomicNumber) {
  for (int number = 1; number <= 96; ++number) {
    const Element* element = element_by_number(number);
    ASSERT_NE(element, nullptr);
    EXPECT_EQ(element->number, number);
    EXPECT_EQ(find_element(element->symbol), element);
    EXPECT_GT(element->covalent_radius, 0.2F);
    EXPECT_LT(element->covalent_radius, 2.7F);
  }
  EXPECT_EQ(element_by_number(0), nullptr);
  EXPECT_EQ(element_by_number(97), nullptr);
}

TEST(Elements, KnowsTheValuesOfTheSource) {
  EXPECT_FLOAT_EQ(find_element("Si")->covalent_radius, 1.11F);
  EXPECT_FLOAT_EQ(find_element("O")->covalent_radius, 0.66F);
  EXPECT_FLOAT_EQ(find_element("C")->covalent_radius, 0.76F);
  EXPECT_DOUBLE_EQ(find_element("Si")->mass, 28.085);
}

TEST(Elements, HaveVanDerWaalsRadii) {
  const auto radius = [](const char* name) { return van_der_waals_radius(*find_element(name)); };
  EXPECT_EQ(radius("H"), 1.20F);
  EXPECT_EQ(radius("C"), 1.70F);
  EXPECT_EQ(radius("Fe"), 2.44F);
  EXPECT_EQ(radius("Cm"), 3.05F);
  // No metal of the d and f blocks is smaller than carbon.
  for (int number = 1; number <= 96; ++number) {
    const Element& element = *element_by_number(number);
    EXPECT_GT(van_der_waals_radius(element), 1) << element.symbol;
    if ((number > 20 && number <= 30) || (number > 38 && number <= 48) ||
        (number > 56 && number <= 80) || number > 88) {
      EXPECT_GT(van_der_waals_radius(element), 2) << element.symbol;
      EXPECT_TRUE(is_metal(element)) << element.symbol;
    }
  }
}

TEST(Elements, KnowsMetals) {
  for (const char* name : {"Li", "Al", "Fe", "Sn", "U"}) {
    EXPECT_TRUE(is_metal(*find_element(name))) << name;
  }
  for (const char* name : {"H", "C", "Si", "Ge", "Sb", "Te", "Xe"}) {
    EXPECT_FALSE(is_metal(*find_element(name))) << name;
  }
}

TEST(Elements, ReadsNamesWithCaseDigitsAndCharges) {
  EXPECT_EQ(symbol_of("SI"), "Si");
  EXPECT_EQ(symbol_of("si12"), "Si");
  EXPECT_EQ(symbol_of("O2-"), "O");
  EXPECT_EQ(symbol_of("Fe3+"), "Fe");
  EXPECT_EQ(symbol_of("C_R"), "C");
  EXPECT_EQ(symbol_of("D"), "H");
}

TEST(Elements, LeavesOtherWordsAlone) {
  for (const char* word : {"", "gas", "water", "W2O", "Xx", "1", "+", "dark matter", "A", "C R"}) {
    EXPECT_EQ(find_element(word), nullptr) << word;
  }
}

TEST(Elements, FindsRoundedMasses) {
  EXPECT_EQ(element_by_mass(28)->symbol, "Si");
  EXPECT_EQ(element_by_mass(15.9994)->symbol, "O");
  EXPECT_EQ(element_by_mass(56)->symbol, "Fe");
  EXPECT_EQ(element_by_mass(1)->symbol, "H");
  EXPECT_EQ(element_by_mass(3), nullptr);
  EXPECT_EQ(element_by_mass(1000), nullptr);
  EXPECT_EQ(element_by_mass(std::nan("")), nullptr);
}

}  // namespace
}  // namespace motes
