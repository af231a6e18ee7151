// Lambdas of hot loops.
#pragma once

/// After a lambda's parameters: it is always inlined, so that what it captures may stay in
/// registers.
#define MOTES_INLINE __attribute__((always_inline))
