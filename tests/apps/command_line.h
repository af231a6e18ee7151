// What the tests of the commands share: small files, and runs of the program that are checked.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "apps/program.h"

namespace motes {

// Two silicon and one oxygen atom.
inline constexpr const char* three_atoms = "3\n\nSi 0 0 0\nO 2 0 0\nSi 4 0 0\n";
inline constexpr const char* one_atom = "1\n\nSi 0 0 0\n";

class CommandLine : public testing::Test {
 protected:
  CommandLine() {
    workspace_.write("a.xyz", three_atoms);
    workspace_.write("one.xyz", one_atom);
  }

  Outcome run(const std::string& arguments) { return workspace_.run(arguments); }

  /// The failure of `arguments` with that status: one line, returned.
  std::string failure(const std::string& arguments, int status) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, status) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_THAT(outcome.err, testing::StartsWith("motes: error: ")) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    return outcome.err;
  }
  void succeed(const std::string& arguments) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.err, "") << arguments;
  }

  /// The floats of an NPY picture.
  std::vector<float> pixels(const std::string& name) {
    const std::string bytes = workspace_.read(name);
    const auto data = bytes.find('\n');
    EXPECT_NE(data, std::string::npos);
    std::vector<float> values((bytes.size() - data - 1) / sizeof(float));
    std::memcpy(values.data(), bytes.data() + data + 1, values.size() * sizeof(float));
    return values;
  }

  Workspace workspace_;
};

}  // namespace motes
