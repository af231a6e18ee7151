// Two small controllers.
#include "server/pace.h"

#include <algorithm>
#include <cmath>

namespace motes::server {
namespace {

constexpr int best_quality = 90, worst_quality = 40;

/// Bytes of a JPEG over those at quality 90, roughly: photographs lose half by 75 and three
/// quarters by 40.
double relative_size(int quality) {
  return 0.25 + 0.75 * std::pow((quality - worst_quality) / 50.0, 2);
}

/// Eight steps an octave, 1, 0.92, 0.84, ..., so that small changes of time do not show.
double in_steps(double scale) {
  const double rounded = std::exp2(std::floor(8 * std::log2(scale) + 1e-9) / 8);
  return std::clamp(rounded, Pace::smallest, 1.0);
}

}  // namespace

double Pace::scale() const { return in_steps(wish_); }

void Pace::took(double scale, double ms) {
  // Time goes with the pixels at worst. Down at once; up by little, since what is left in the
  // budget may be luck.
  const double wish = scale * std::sqrt(budget_ms / std::max(ms, 0.1));
  wish_ = std::clamp(wish < wish_ ? wish : std::min(wish, wish_ * 1.15), smallest, 1.0);
}

void Link::sent(std::uint32_t frame, std::size_t bytes, Clock::time_point now) {
  under_way_.push_back({frame, bytes, now});
}

bool Link::has_room() const {
  const auto coming = std::count_if(under_way_.begin(), under_way_.end(),
                                    [](const Sent& sent) { return !sent.recalled; });
  return static_cast<std::size_t>(coming) < max_under_way;
}

bool Link::is_under_way(std::uint32_t frame) const {
  return std::any_of(under_way_.begin(), under_way_.end(),
                     [frame](const Sent& sent) { return sent.frame == frame; });
}

void Link::recalled(std::uint32_t frame) {
  for (Sent& sent : under_way_) sent.recalled = sent.recalled || sent.frame == frame;
}

void Link::acknowledged(std::uint32_t frame, Clock::time_point now) {
  while (!under_way_.empty() && under_way_.front().frame <= frame) {
    const Sent first = under_way_.front();
    under_way_.pop_front();
    // Those before the one that is named were dropped or recalled on the way. Small ones tell of
    // the delay, not of the bandwidth.
    if (first.frame < frame || first.recalled || first.bytes <= 8192) continue;
    // It could only start when the one before had arrived.
    const auto start = std::max(first.at, last_arrival_);
    const double ms = std::chrono::duration<double, std::milli>(now - start).count();
    const double rate = static_cast<double>(first.bytes) / std::max(ms, 0.5);
    bytes_per_ms_ = bytes_per_ms_ > 0 ? 0.7 * bytes_per_ms_ + 0.3 * rate : rate;
  }
  last_arrival_ = now;
}

double Link::scale(std::size_t pixels) const {
  const double at_worst =
      bytes_per_pixel_ * static_cast<double>(pixels) * relative_size(worst_quality);
  const double budget = byte_budget(Pace::budget_ms);
  return at_worst > budget ? in_steps(std::sqrt(budget / at_worst)) : 1;
}

int Link::quality(std::size_t pixels, double ms) const {
  const double at_best = bytes_per_pixel_ * static_cast<double>(pixels);
  for (int quality = best_quality; quality > worst_quality; quality -= 5) {
    if (at_best * relative_size(quality) <= byte_budget(ms)) return quality;
  }
  return worst_quality;
}

double Link::lossless_ms(std::size_t pixels) const {
  const double bytes = lossless_bytes_per_pixel_ * static_cast<double>(pixels);
  return bytes_per_ms_ > 0 ? bytes / bytes_per_ms_ : 0;
}

void Link::encoded_lossless(std::size_t pixels, std::size_t bytes) {
  lossless_bytes_per_pixel_ =
      static_cast<double>(bytes) / static_cast<double>(std::max<std::size_t>(pixels, 1));
}

void Link::encoded(std::size_t pixels, std::size_t bytes, int quality) {
  bytes_per_pixel_ = static_cast<double>(bytes) /
                     static_cast<double>(std::max<std::size_t>(pixels, 1)) / relative_size(quality);
}

}  // namespace motes::server
