// What the machine can do at best: the yardstick of `motes bench limit`.
#pragma once

#include <cstddef>

namespace motes {

/// Of all threads at once, in the instruction set in use.
struct MachinePeak {
  int threads = 0, lanes = 0;
  double ticks = 0;             ///< of the processor's time stamp, a second
  double unlit = 0, lit = 0;    ///< kernel evaluations a second
  double read = 0, copied = 0;  ///< bytes a second; copied ones count as read and as written
  std::size_t array_bytes = 0;  ///< of each of the two arrays that were read and copied

  double evaluations(bool is_lit) const { return is_lit ? lit : unlit; }
  /// Ticks that a thread takes for one evaluation.
  double ticks_each(bool is_lit) const { return ticks * threads / evaluations(is_lit); }
};

/// Takes about two seconds and at most `memory` bytes; each number is the best of several runs.
/// `threads`: 0 for all.
MachinePeak measure_peak(int threads, std::size_t memory);

}  // namespace motes
