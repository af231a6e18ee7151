// Somebody who looks at a scene in a browser, with the mouse in the hand: drags, lets go, picks.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "server/background_server.h"
#include "server/client.h"

namespace motes {

/// What became of the mouse's moves. Times in ms.
struct DragTimes {
  /// From each move to the first picture that shows its view or a later one: come and decoded.
  std::vector<double> latencies;
  std::size_t frames = 0;                         ///< that came while the mouse moved
  double dragged = 0;                             ///< from the first move to the last
  std::vector<double> renders, encodes, decodes;  ///< of the pictures that show moves
  std::vector<double> pixels;  ///< of these, as parts of those of the full picture
  double full = 0;             ///< from rest until the full picture has come
};

class Hand {
 public:
  /// Waits until the full picture is there. Throws Error for a scene that cannot be shown, and
  /// boost::system::system_error as server::Client does.
  Hand(const server::BackgroundServer& server, int width, int height);

  std::size_t num_particles() const { return num_particles_; }
  /// Turns the scene for two seconds, with 60 moves in each, and lets go. Begins while the picture
  /// is being refined.
  DragTimes drag();
  /// Picks at nine places of the picture; how long answers take, where there is a particle.
  std::vector<double> pick();

 private:
  using Clock = server::Client::Clock;
  struct Drag;

  /// Takes all frames that come until then.
  void look_until(Clock::time_point time, Drag& drag);
  void show(const server::ReceivedFrame& frame, Drag& drag) const;
  /// The next frame, if one comes until then.
  std::optional<server::ReceivedFrame> next_frame(Clock::time_point deadline);

  server::Client client_;
  int width_, height_;
  std::size_t num_particles_ = 0;
  nlohmann::json camera_;
  std::uint32_t sequence_ = 0;
};

}  // namespace motes
