// Ctrl-C.
#pragma once

#include <functional>

namespace motes {

/// From now on the program leaves at once when it is interrupted, asked to terminate or loses its
/// terminal: with a message, no file half written, and the exit status of the signal. To be called
/// before other threads are started.
void leave_when_interrupted();

/// While it lives, an interruption calls `stop` instead, once, on a thread of its own; the next one
/// ends the program as usual.
class StopWhenInterrupted {
 public:
  explicit StopWhenInterrupted(std::function<void()> stop);
  ~StopWhenInterrupted();
  StopWhenInterrupted(const StopWhenInterrupted&) = delete;
  StopWhenInterrupted& operator=(const StopWhenInterrupted&) = delete;
};

}  // namespace motes
