// Frames as text of each format, to be read back.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/vec.h"

namespace motes {

/// A frame to be written: what all text formats can hold.
struct TestFrame {
  std::vector<Point3d> positions;  ///< multiples of 1/100, within 100 of zero
  std::vector<std::string> species;
  std::vector<float> values;  ///< a property "f", where the format has such
};

inline std::string to_dump(const std::vector<TestFrame>& frames) {
  std::string out;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const TestFrame& frame = frames[t];
    out +=
        fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\n", t, frame.positions.size());
    out +=
        "ITEM: BOX BOUNDS pp pp pp\n-100 100\n-100 100\n-100 100\nITEM: ATOMS id element x y z f\n";
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      const Point3d& p = frame.positions[i];
      out += fmt::format("{} {} {} {} {} {}\n", i + 1, frame.species[i], p.x, p.y, p.z,
                         frame.values[i]);
    }
  }
  return out;
}

inline std::string to_extxyz(const std::vector<TestFrame>& frames) {
  std::string out;
  for (const TestFrame& frame : frames) {
    out += fmt::format("{}\nProperties=species:S:1:pos:R:3:f:R:1\n", frame.positions.size());
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      const Point3d& p = frame.positions[i];
      out += fmt::format("{} {} {} {} {}\n", frame.species[i], p.x, p.y, p.z, frame.values[i]);
    }
  }
  return out;
}

inline std::string to_gro(const std::vector<TestFrame>& frames) {
  std::string out;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const TestFrame& frame = frames[t];
    out += fmt::format("Test, t= {}\n{}\n", t, frame.positions.size());
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      const Point3d& p = frame.positions[i];
      out += fmt::format("{:5}{:<5}{:>5}{:5}{:8.3f}{:8.3f}{:8.3f}\n", i + 1, "RES",
                         frame.species[i], i + 1, p.x / 10, p.y / 10, p.z / 10);
    }
    out += "  20.0  20.0  20.0\n";
  }
  return out;
}

/// The first frame, with types instead of species, and a chain of bonds.
inline std::string to_lammps_data(const std::vector<TestFrame>& frames) {
  const TestFrame& frame = frames.front();
  const std::size_t n = frame.positions.size(), num_bonds = n == 0 ? 0 : n - 1;
  std::string out = fmt::format(
      "LAMMPS data file\n\n{} atoms\n2 atom types\n{} bonds\n1 bond types\n\n-100 100 xlo xhi\n"
      "-100 100 ylo yhi\n-100 100 zlo zhi\n\nMasses\n\n1 15.9994 # O\n2 28.0855 # Si\n\n"
      "Atoms # full\n\n",
      n, num_bonds);
  for (std::size_t i = 0; i < n; ++i) {
    const Point3d& p = frame.positions[i];
    out += fmt::format("{} 1 {} {} {} {} {} 0 0 0\n", i + 1, frame.species[i] == "O" ? 1 : 2,
                       frame.values[i], p.x, p.y, p.z);
  }
  out += "\nBonds\n\n";
  for (std::size_t i = 1; i < n; ++i) out += fmt::format("{} 1 {} {}\n", i, i, i + 1);
  return out;
}

}  // namespace motes
