// The order of pictures: something at once, then better ones.
#include "server/viewer.h"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "image/display.h"
#include "image/encode.h"
#include "server/frame_message.h"

namespace motes::server {

namespace {

/// A full picture that takes longer to arrive comes after one of all pixels that may take so long.
constexpr double long_ms = 500;

}  // namespace

void Viewer::resize(int width, int height) {
  width_ = width;
  height_ = height;
  invalidate();
}

void Viewer::look(const Camera& camera, bool moving, Clock::time_point now) {
  last_view_ = now;
  moving_ = moving;
  if (camera == camera_ && shown_ > 0) {
    recall_final();
    shown_final_ = false;  // the page waits for a picture with the number of this view
    return;
  }
  camera_ = camera;
  invalidate();
}

void Viewer::invalidate() {
  recall_final();
  shown_ = 0;
  shown_final_ = false;
}

void Viewer::recall_final() {
  if (!shown_final_ || !link_.is_under_way(last_frame_)) return;
  link_.recalled(last_frame_);
  outlet_->recall_frame(last_frame_);
}

void Viewer::look_anew(const Camera& camera) {
  camera_ = camera;
  moving_ = false;
  invalidate();
}

std::optional<FramePlan> Viewer::next(Clock::time_point now) const {
  if (width_ == 0 || !link_.has_room()) return {};
  if (shown_ == 0) {
    return FramePlan{std::min(pace_.scale(), link_.scale(num_pixels())), true, false};
  }
  if (is_moving(now) || shown_final_) return {};
  const double scale = std::min(1.0, 2 * shown_);
  const bool final = scale == 1 && (shown_ == 1 || link_.lossless_ms(num_pixels()) < long_ms);
  return FramePlan{scale, false, final};
}

std::optional<Viewer::Clock::time_point> Viewer::next_change(Clock::time_point now) const {
  if (!is_moving(now)) return {};
  return last_view_ + settle_time;
}

void Viewer::send(const FramePlan& plan, const Framebuffer& image, double termination_opacity,
                  const Color& background, double render_ms, const std::atomic<bool>* cancel) {
  const Stopwatch stopwatch;
  const DisplayImage shown = to_display(image, termination_opacity, background);
  const std::size_t pixels = image.num_pixels();
  FrameHeader header;
  std::string encoded;
  if (plan.final) {
    encoded = encode_png(shown, cancel);
    header.format = FrameFormat::png;
    link_.encoded_lossless(pixels, encoded.size());
  } else {
    const int quality = link_.quality(pixels, plan.moving ? Pace::budget_ms : long_ms);
    encoded = encode_jpeg(shown, quality);
    link_.encoded(pixels, encoded.size(), quality);
  }
  encode_ms_ = stopwatch.milliseconds();
  if (plan.moving) pace_.took(plan.scale, render_ms + encode_ms_);
  header.frame = ++last_frame_;
  header.view_sequence = view_sequence_;
  header.scene_sequence = scene_sequence_;
  header.final = plan.final;
  header.width = static_cast<std::uint32_t>(image.width);
  header.height = static_cast<std::uint32_t>(image.height);
  header.render_ms = static_cast<float>(render_ms);
  header.encode_ms = static_cast<float>(encode_ms_);
  link_.sent(header.frame, encoded.size(), Clock::now());
  shown_ = plan.scale;
  shown_final_ = plan.final;
  outlet_->send_frame(frame_message(header, encoded));
}

void Viewer::broken_off(const FramePlan& plan, double ms) {
  if (plan.moving) pace_.took(plan.scale, ms);
}

}  // namespace motes::server
