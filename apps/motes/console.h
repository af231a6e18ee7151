// What the program says on standard error: progress on a terminal, warnings.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "core/report.h"

namespace motes {

/// A bar on a terminal for work that takes over half a second, erased when the work is done; silent
/// elsewhere. Warnings are written out by print_warnings() or, at the latest, by the destructor.
class Console : public Progress {
 public:
  Console();
  ~Console() override;
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  void update(std::string_view activity, double fraction) override;
  /// The work is done: erases the bar.
  void finish();

  Warnings& warnings() { return warnings_; }
  /// Writes the warnings that are new, one line each.
  void print_warnings();

 private:
  using Clock = std::chrono::steady_clock;

  const bool on_terminal_;
  std::string activity_;
  Clock::time_point start_, last_drawn_;
  bool drawn_ = false;
  Warnings warnings_;
  std::size_t printed_ = 0;
};

}  // namespace motes
