// Runs tests on all that the machine has.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "render/render_tile.h"

namespace motes {

/// Runs `f` on every instruction set that this machine has.
template <class F>
void on_all_instruction_sets(F&& f) {
  for (const std::string& name : instruction_sets()) {
    SCOPED_TRACE(name);
    force_instruction_set(name);
    f();
  }
  force_instruction_set("");
}

}  // namespace motes
