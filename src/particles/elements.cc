// The table of elements and the look-ups in it.
#include "particles/elements.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <gemmi/elem.hpp>
#include <string>

namespace motes {

namespace {

// Atomic weights: IUPAC (2021), abridged. Covalent radii: Cordero et al., Dalton Trans. 2008, 2832,
// doi:10.1039/b801115j (C for sp3, Mn, Fe and Co for low spin); they end at curium, and so does the
// table. Colours: those of the Jmol viewer.
// clang-format off
constexpr Element elements[] = {
    {"H", 1, 1.008, 0.31F, {0xFF, 0xFF, 0xFF}},
    {"He", 2, 4.0026, 0.28F, {0xD9, 0xFF, 0xFF}},
    {"Li", 3, 6.94, 1.28F, {0xCC, 0x80, 0xFF}},
    {"Be", 4, 9.01218, 0.96F, {0xC2, 0xFF, 0x00}},
    {"B", 5, 10.81, 0.84F, {0xFF, 0xB5, 0xB5}},
    {"C", 6, 12.011, 0.76F, {0x90, 0x90, 0x90}},
    {"N", 7, 14.007, 0.71F, {0x30, 0x50, 0xF8}},
    {"O", 8, 15.999, 0.66F, {0xFF, 0x0D, 0x0D}},
    {"F", 9, 18.9984, 0.57F, {0x90, 0xE0, 0x50}},
    {"Ne", 10, 20.1797, 0.58F, {0xB3, 0xE3, 0xF5}},
    {"Na", 11, 22.9898, 1.66F, {0xAB, 0x5C, 0xF2}},
    {"Mg", 12, 24.305, 1.41F, {0x8A, 0xFF, 0x00}},
    {"Al", 13, 26.9815, 1.21F, {0xBF, 0xA6, 0xA6}},
    {"Si", 14, 28.085, 1.11F, {0xF0, 0xC8, 0xA0}},
    {"P", 15, 30.9738, 1.07F, {0xFF, 0x80, 0x00}},
    {"S", 16, 32.06, 1.05F, {0xFF, 0xFF, 0x30}},
    {"Cl", 17, 35.45, 1.02F, {0x1F, 0xF0, 0x1F}},
    {"Ar", 18, 39.948, 1.06F, {0x80, 0xD1, 0xE3}},
    {"K", 19, 39.0983, 2.03F, {0x8F, 0x40, 0xD4}},
    {"Ca", 20, 40.078, 1.76F, {0x3D, 0xFF, 0x00}},
    {"Sc", 21, 44.9559, 1.70F, {0xE6, 0xE6, 0xE6}},
    {"Ti", 22, 47.867, 1.60F, {0xBF, 0xC2, 0xC7}},
    {"V", 23, 50.9415, 1.53F, {0xA6, 0xA6, 0xAB}},
    {"Cr", 24, 51.9961, 1.39F, {0x8A, 0x99, 0xC7}},
    {"Mn", 25, 54.938, 1.39F, {0x9C, 0x7A, 0xC7}},
    {"Fe", 26, 55.845, 1.32F, {0xE0, 0x66, 0x33}},
    {"Co", 27, 58.9332, 1.26F, {0xF0, 0x90, 0xA0}},
    {"Ni", 28, 58.6934, 1.24F, {0x50, 0xD0, 0x50}},
    {"Cu", 29, 63.546, 1.32F, {0xC8, 0x80, 0x33}},
    {"Zn", 30, 65.38, 1.22F, {0x7D, 0x80, 0xB0}},
    {"Ga", 31, 69.723, 1.22F, {0xC2, 0x8F, 0x8F}},
    {"Ge", 32, 72.63, 1.20F, {0x66, 0x8F, 0x8F}},
    {"As", 33, 74.9216, 1.19F, {0xBD, 0x80, 0xE3}},
    {"Se", 34, 78.971, 1.20F, {0xFF, 0xA1, 0x00}},
    {"Br", 35, 79.904, 1.20F, {0xA6, 0x29, 0x29}},
    {"Kr", 36, 83.798, 1.16F, {0x5C, 0xB8, 0xD1}},
    {"Rb", 37, 85.4678, 2.20F, {0x70, 0x2E, 0xB0}},
    {"Sr", 38, 87.62, 1.95F, {0x00, 0xFF, 0x00}},
    {"Y", 39, 88.9059, 1.90F, {0x94, 0xFF, 0xFF}},
    {"Zr", 40, 91.224, 1.75F, {0x94, 0xE0, 0xE0}},
    {"Nb", 41, 92.9064, 1.64F, {0x73, 0xC2, 0xC9}},
    {"Mo", 42, 95.95, 1.54F, {0x54, 0xB5, 0xB5}},
    {"Tc", 43, 98.0, 1.47F, {0x3B, 0x9E, 0x9E}},
    {"Ru", 44, 101.07, 1.46F, {0x24, 0x8F, 0x8F}},
    {"Rh", 45, 102.906, 1.42F, {0x0A, 0x7D, 0x8C}},
    {"Pd", 46, 106.42, 1.39F, {0x00, 0x69, 0x85}},
    {"Ag", 47, 107.868, 1.45F, {0xC0, 0xC0, 0xC0}},
    {"Cd", 48, 112.411, 1.44F, {0xFF, 0xD9, 0x8F}},
    {"In", 49, 114.818, 1.42F, {0xA6, 0x75, 0x73}},
    {"Sn", 50, 118.71, 1.39F, {0x66, 0x80, 0x80}},
    {"Sb", 51, 121.76, 1.39F, {0x9E, 0x63, 0xB5}},
    {"Te", 52, 127.6, 1.38F, {0xD4, 0x7A, 0x00}},
    {"I", 53, 126.904, 1.39F, {0x94, 0x00, 0x94}},
    {"Xe", 54, 131.293, 1.40F, {0x42, 0x9E, 0xB0}},
    {"Cs", 55, 132.905, 2.44F, {0x57, 0x17, 0x8F}},
    {"Ba", 56, 137.327, 2.15F, {0x00, 0xC9, 0x00}},
    {"La", 57, 138.905, 2.07F, {0x70, 0xD4, 0xFF}},
    {"Ce", 58, 140.116, 2.04F, {0xFF, 0xFF, 0xC7}},
    {"Pr", 59, 140.908, 2.03F, {0xD9, 0xFF, 0xC7}},
    {"Nd", 60, 144.242, 2.01F, {0xC7, 0xFF, 0xC7}},
    {"Pm", 61, 145.0, 1.99F, {0xA3, 0xFF, 0xC7}},
    {"Sm", 62, 150.36, 1.98F, {0x8F, 0xFF, 0xC7}},
    {"Eu", 63, 151.964, 1.98F, {0x61, 0xFF, 0xC7}},
    {"Gd", 64, 157.25, 1.96F, {0x45, 0xFF, 0xC7}},
    {"Tb", 65, 158.925, 1.94F, {0x30, 0xFF, 0xC7}},
    {"Dy", 66, 162.5, 1.92F, {0x1F, 0xFF, 0xC7}},
    {"Ho", 67, 164.93, 1.92F, {0x00, 0xFF, 0x9C}},
    {"Er", 68, 167.259, 1.89F, {0x00, 0xE6, 0x75}},
    {"Tm", 69, 168.934, 1.90F, {0x00, 0xD4, 0x52}},
    {"Yb", 70, 173.05, 1.87F, {0x00, 0xBF, 0x38}},
    {"Lu", 71, 174.967, 1.87F, {0x00, 0xAB, 0x24}},
    {"Hf", 72, 178.49, 1.75F, {0x4D, 0xC2, 0xFF}},
    {"Ta", 73, 180.948, 1.70F, {0x4D, 0xA6, 0xFF}},
    {"W", 74, 183.84, 1.62F, {0x21, 0x94, 0xD6}},
    {"Re", 75, 186.207, 1.51F, {0x26, 0x7D, 0xAB}},
    {"Os", 76, 190.23, 1.44F, {0x26, 0x66, 0x96}},
    {"Ir", 77, 192.217, 1.41F, {0x17, 0x54, 0x87}},
    {"Pt", 78, 195.084, 1.36F, {0xD0, 0xD0, 0xE0}},
    {"Au", 79, 196.967, 1.36F, {0xFF, 0xD1, 0x23}},
    {"Hg", 80, 200.59, 1.32F, {0xB8, 0xB8, 0xD0}},
    {"Tl", 81, 204.383, 1.45F, {0xA6, 0x54, 0x4D}},
    {"Pb", 82, 207.2, 1.46F, {0x57, 0x59, 0x61}},
    {"Bi", 83, 208.98, 1.48F, {0x9E, 0x4F, 0xB5}},
    {"Po", 84, 209.0, 1.40F, {0xAB, 0x5C, 0x00}},
    {"At", 85, 210.0, 1.50F, {0x75, 0x4F, 0x45}},
    {"Rn", 86, 222.0, 1.50F, {0x42, 0x82, 0x96}},
    {"Fr", 87, 223.0, 2.60F, {0x42, 0x00, 0x66}},
    {"Ra", 88, 226.0, 2.21F, {0x00, 0x7D, 0x00}},
    {"Ac", 89, 227.0, 2.15F, {0x70, 0xAB, 0xFA}},
    {"Th", 90, 232.038, 2.06F, {0x00, 0xBA, 0xFF}},
    {"Pa", 91, 231.036, 2.00F, {0x00, 0xA1, 0xFF}},
    {"U", 92, 238.029, 1.96F, {0x00, 0x8F, 0xFF}},
    {"Np", 93, 237.0, 1.90F, {0x00, 0x80, 0xFF}},
    {"Pu", 94, 244.0, 1.87F, {0x00, 0x6B, 0xFF}},
    {"Am", 95, 243.0, 1.80F, {0x54, 0x5C, 0xF2}},
    {"Cm", 96, 247.0, 1.69F, {0x78, 0x5C, 0xE3}},
};
// clang-format on

// Of the elements of the d and f blocks: Alvarez, Dalton Trans. 2013, 42, 8617,
// doi:10.1039/c3dt50599e, which has none of promethium: the mean of its neighbours'.
struct AtomicRadius {
  int number;
  float radius;
};
constexpr AtomicRadius alvarez_radii[] = {
    {21, 2.58F}, {22, 2.46F}, {23, 2.42F}, {24, 2.45F}, {25, 2.45F}, {26, 2.44F}, {27, 2.40F},
    {28, 2.40F}, {29, 2.38F}, {30, 2.39F}, {39, 2.75F}, {40, 2.52F}, {41, 2.56F}, {42, 2.45F},
    {43, 2.44F}, {44, 2.46F}, {45, 2.44F}, {46, 2.15F}, {47, 2.53F}, {48, 2.49F}, {57, 2.98F},
    {58, 2.88F}, {59, 2.92F}, {60, 2.95F}, {61, 2.93F}, {62, 2.90F}, {63, 2.87F}, {64, 2.83F},
    {65, 2.79F}, {66, 2.87F}, {67, 2.81F}, {68, 2.83F}, {69, 2.79F}, {70, 2.80F}, {71, 2.74F},
    {72, 2.63F}, {73, 2.53F}, {74, 2.57F}, {75, 2.49F}, {76, 2.48F}, {77, 2.41F}, {78, 2.29F},
    {79, 2.32F}, {80, 2.45F}, {89, 2.80F}, {90, 2.93F}, {91, 2.88F}, {92, 2.71F}, {93, 2.82F},
    {94, 2.81F}, {95, 2.83F}, {96, 3.05F}};

constexpr int num_elements = static_cast<int>(std::size(elements));

/// `letters` in the case of a symbol: "SI" becomes "Si".
std::string symbol_case(std::string_view letters) {
  std::string symbol(letters);
  for (std::size_t i = 0; i < symbol.size(); ++i) {
    const auto c = static_cast<unsigned char>(symbol[i]);
    symbol[i] = static_cast<char>(i == 0 ? std::toupper(c) : std::tolower(c));
  }
  return symbol;
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

}  // namespace

const Element* find_element(std::string_view name) {
  std::size_t num_letters = 0;
  while (num_letters < name.size() && is_letter(name[num_letters])) ++num_letters;
  if (num_letters == 0 || num_letters > 2) return nullptr;
  const std::string_view suffix = name.substr(num_letters);
  if (suffix.substr(0, suffix.find('_')).find_first_not_of("0123456789+-*\'") !=
      std::string_view::npos) {
    return nullptr;
  }
  const std::string symbol = symbol_case(name.substr(0, num_letters));
  if (symbol == "D" || symbol == "T") return &elements[0];
  for (const Element& element : elements) {
    if (element.symbol == symbol) return &element;
  }
  return nullptr;
}

const Element* element_by_number(int number) {
  return number >= 1 && number <= num_elements ? &elements[number - 1] : nullptr;
}

const Element* element_by_mass(double mass) {
  constexpr double tolerance = 0.2;
  const Element* nearest = nullptr;
  double nearest_distance = tolerance;
  for (const Element& element : elements) {
    const double distance = std::abs(element.mass - mass);
    if (distance <= nearest_distance) {
      nearest = &element;
      nearest_distance = distance;
    }
  }
  return nearest;
}

float van_der_waals_radius(const Element& element) {
  const auto* const found =
      std::find_if(std::begin(alvarez_radii), std::end(alvarez_radii),
                   [&](const AtomicRadius& each) { return each.number == element.number; });
  if (found != std::end(alvarez_radii)) return found->radius;
  return gemmi::vdw_radius(static_cast<gemmi::El>(element.number));
}

bool is_metal(const Element& element) {
  const auto el = static_cast<gemmi::El>(element.number);
  return gemmi::is_metal(el) && el != gemmi::El::Ge && el != gemmi::El::Sb;
}

}  // namespace motes
