// Text of a selection expression -> a program for a stack machine (selection.cc runs it).
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace motes {

enum class Operation {
  // Push a value.
  number,
  variable,
  text,
  // Replace the uppermost value.
  negate,
  logical_not,
  abs,
  sqrt,
  log10,
  exp,
  // Replace the two uppermost values by one.
  add,
  subtract,
  multiply,
  divide,
  power,
  min,
  max,
  less,
  less_equal,
  greater,
  greater_equal,
  equal,
  not_equal,
  logical_and,
  logical_or,
};

/// How many values an operation takes from the stack; each leaves one there.
int arity(Operation operation);

struct Instruction {
  Operation operation;
  double number = 0;       ///< of Operation::number
  std::string name;        ///< of a variable or text
  std::size_t column = 0;  ///< in the expression, from 1
};

/// Throws Error for a variable that is not there.
using CheckVariable = std::function<void(const Instruction&)>;

/// Instructions in postfix order; the last one leaves a condition. Throws Error that names the
/// column and what was expected. `check` sees each variable before it is held against what it is
/// compared with; without it, variables may be compared with texts too.
std::vector<Instruction> parse_expression(std::string_view expression,
                                          const CheckVariable& check = nullptr);

/// "expression '...', column N: what".
[[noreturn]] void throw_at_column(std::string_view expression, std::size_t column,
                                  std::string_view what);

}  // namespace motes
