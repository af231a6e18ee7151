// Ctrl-C.
#pragma once

namespace motes {

/// From now on the program leaves at once when it is interrupted, asked to terminate or loses its
/// terminal: with a message, no file half written, and the exit status of the signal. To be called
/// before other threads are started.
void leave_when_interrupted();

}  // namespace motes
