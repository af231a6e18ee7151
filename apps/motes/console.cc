// Draws the progress bar, prints the warnings.
#include "motes/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "core/error.h"

namespace motes {
namespace {

using namespace std::chrono_literals;

constexpr auto patience = 500ms;  // shorter work needs no bar
constexpr auto redraw = 100ms;
constexpr int bar_width = 30;

}  // namespace

Console::Console() : on_terminal_(isatty(STDERR_FILENO) == 1) {}

Console::~Console() {
  finish();
  print_warnings();
}

void Console::update(std::string_view activity, double fraction) {
  if (!on_terminal_) return;
  const auto now = Clock::now();
  if (activity != activity_) {
    finish();
    activity_ = activity;
    start_ = now;
  }
  if (now - start_ < patience || (drawn_ && now - last_drawn_ < redraw)) return;
  const int done = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * bar_width);
  fmt::print(stderr, "\r\x1b[K{} [{:#<{}}{:.<{}}] {:3.0f} %", printable(activity_, 40), "", done,
             "", bar_width - done, 100 * std::clamp(fraction, 0.0, 1.0));
  std::fflush(stderr);
  drawn_ = true;
  last_drawn_ = now;
}

void Console::finish() {
  if (drawn_) {
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
  }
  drawn_ = false;
  activity_.clear();
}

void Console::print_warnings() {
  finish();
  for (; printed_ < warnings_.lines().size(); ++printed_) {
    fmt::print(stderr, "motes: warning: {}\n", printable(warnings_.lines()[printed_], 4096));
  }
}

}  // namespace motes
