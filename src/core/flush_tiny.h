// Arithmetic without numbers that are so small that processors are slow with them.
#pragma once

#include <xmmintrin.h>

namespace motes {

/// While it lives, this thread takes numbers below 1e-38 for zero: far from a kernel's centre its
/// factors are so small, and arithmetic with them takes the processor many times as long.
class FlushTinyToZero {
 public:
  FlushTinyToZero() : saved_(_mm_getcsr()) {
    constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
    _mm_setcsr(saved_ | flush_to_zero | denormals_are_zero);
  }
  ~FlushTinyToZero() { _mm_setcsr(saved_); }
  FlushTinyToZero(const FlushTinyToZero&) = delete;
  FlushTinyToZero& operator=(const FlushTinyToZero&) = delete;

 private:
  unsigned saved_;
};

}  // namespace motes
