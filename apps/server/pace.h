// How large a picture is rendered and how well it is encoded while somebody moves, so that enough
// pictures come: what is decided from times alone.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>

namespace motes::server {

/// The scale of the picture's sides that a budget of time allows, learnt from what frames took.
class Pace {
 public:
  static constexpr double smallest = 0.125;
  /// A move waits for the picture under way, then for its own: twice this, with what the way takes,
  /// is less than 80 ms.
  static constexpr double budget_ms = 36;

  /// In [smallest, 1], in steps.
  double scale() const;
  /// A frame at `scale` took that long, encoded; or, if it was broken off, at least that.
  void took(double scale, double ms);

 private:
  double wish_ = 0.5;  ///< before it is rounded to a step
};

/// What is known of the way to one client, from when frames were sent and acknowledged.
class Link {
 public:
  using Clock = std::chrono::steady_clock;

  /// So many frames may be under way: one is shown while the next travels.
  static constexpr std::size_t max_under_way = 2;

  bool has_room() const;
  bool is_under_way(std::uint32_t frame) const;
  void sent(std::uint32_t frame, std::size_t bytes, Clock::time_point now);
  /// What has not left of it will not come.
  void recalled(std::uint32_t frame);
  /// `frame` has arrived; those before have, too, or will not.
  void acknowledged(std::uint32_t frame, Clock::time_point now);

  /// The largest scale of a picture of so many pixels in full that comes in time, if encoded badly.
  double scale(std::size_t pixels) const;
  /// Quality of JPEG for a picture of so many pixels that is to take so long, 40 to 90, from what
  /// the last ones took.
  int quality(std::size_t pixels, double ms) const;
  /// How long a picture of so many pixels without loss takes; 0 if that is not known.
  double lossless_ms(std::size_t pixels) const;
  /// A picture of so many pixels came to so many bytes.
  void encoded(std::size_t pixels, std::size_t bytes, int quality);
  void encoded_lossless(std::size_t pixels, std::size_t bytes);

 private:
  /// Bytes that a picture may have which is to take so long; none known: as many as it likes.
  double byte_budget(double ms) const { return bytes_per_ms_ > 0 ? bytes_per_ms_ * ms : 1e12; }

  struct Sent {
    std::uint32_t frame = 0;
    std::size_t bytes = 0;
    Clock::time_point at;
    bool recalled = false;
  };

  std::deque<Sent> under_way_;
  Clock::time_point last_arrival_;
  double bytes_per_ms_ = 0;     ///< 0: not known
  double bytes_per_pixel_ = 0;  ///< at quality 90; 0: not known
  double lossless_bytes_per_pixel_ = 1;
};

}  // namespace motes::server
