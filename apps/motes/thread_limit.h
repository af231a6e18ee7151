// How many threads a command may use.
#pragma once

#include <tbb/global_control.h>

#include <cstddef>
#include <optional>

namespace motes {

/// While it lives, parallel work takes no more than that many threads; 0: all of the machine's.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads) {
    if (threads <= 0) return;
    limit_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }

 private:
  std::optional<tbb::global_control> limit_;
};

}  // namespace motes
