// How many messages a client may send, and how many requests all of them.
#pragma once

#include <algorithm>
#include <chrono>

namespace motes::server {

/// A bucket of tokens, filled at a constant rate: each message or request takes one.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;

  RateLimit(double per_second, double burst)
      : per_second_(per_second), burst_(burst), tokens_(burst) {}

  /// Whether there is one left.
  bool take(Clock::time_point now) {
    const double passed = std::chrono::duration<double>(now - last_).count();
    tokens_ = std::min(burst_, tokens_ + passed * per_second_);
    last_ = now;
    if (tokens_ < 1) return false;
    tokens_ -= 1;
    return true;
  }

 private:
  double per_second_, burst_, tokens_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace motes::server
