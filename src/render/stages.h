// What the time of a frame goes into.
#pragma once

#include <x86intrin.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace motes {

/// Parts of the work on a tile. For the paper's way all of pass 1 is `sums`.
enum class Stage {
  setup,      ///< rays before their first sample, surfaces in their way, pixels after their last
  traverse,   ///< kernels that reach an area of tiles
  cull,       ///< what those of them reach of the area
  sums,       ///< kernels' values, added to samples
  integrate,  ///< pass 2
};
inline constexpr std::size_t num_stages = 5;
inline constexpr const char* stage_names[num_stages] = {"setup", "traverse", "cull", "sums",
                                                        "integrate"};

/// Ticks of the processor's time stamp, one number a stage.
struct StageTicks {
  std::array<std::uint64_t, num_stages> ticks{};

  void add(const StageTicks& other) {
    for (std::size_t s = 0; s < num_stages; ++s) ticks[s] += other.ticks[s];
  }
  double fraction(Stage stage) const {
    const auto all = std::accumulate(ticks.begin(), ticks.end(), std::uint64_t{0});
    return all == 0 ? 0
                    : static_cast<double>(ticks[static_cast<std::size_t>(stage)]) /
                          static_cast<double>(all);
  }
};

/// Books the time since it was last asked on a stage. One lap takes about 30 cycles: none is
/// taken for less than some groups of pixels.
class StageClock {
 public:
  explicit StageClock(StageTicks& out) : out_(out), last_(__rdtsc()) {}
  void lap(Stage stage) {
    const std::uint64_t now = __rdtsc();
    out_.ticks[static_cast<std::size_t>(stage)] += now - last_;
    last_ = now;
  }

 private:
  StageTicks& out_;
  std::uint64_t last_;
};

}  // namespace motes
