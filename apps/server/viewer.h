// One who looks: what a client sees, and which picture it should get next.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/color.h"
#include "image/framebuffer.h"
#include "scene/camera.h"
#include "server/messages.h"
#include "server/outlet.h"
#include "server/pace.h"

namespace motes::server {

/// A picture to make for a client.
struct FramePlan {
  double scale = 1;     ///< of the picture's sides
  bool moving = false;  ///< only to keep up with the hand: no more than that is spent on it
  bool final = false;   ///< in full, and without loss
};

/// For the studio's thread alone.
class Viewer {
 public:
  using Clock = std::chrono::steady_clock;

  /// Somebody who says nothing for so long has come to rest.
  static constexpr std::chrono::milliseconds settle_time{250};

  explicit Viewer(std::shared_ptr<Outlet> outlet) : outlet_(std::move(outlet)) {}

  Outlet& outlet() { return *outlet_; }
  const Camera& camera() const { return camera_; }
  int width() const { return width_; }
  int height() const { return height_; }
  std::optional<ClientId> following() const { return following_; }

  void resize(int width, int height);
  /// The camera is moved by this client, by whom it follows, or by the scene.
  void look(const Camera& camera, bool moving, Clock::time_point now);
  /// It looks through the scene's own camera.
  void look_anew(const Camera& camera);
  void took_view(std::uint32_t sequence) { view_sequence_ = sequence; }
  void took_scene(std::uint32_t sequence) { scene_sequence_ = sequence; }
  void follow(std::optional<ClientId> client) { following_ = client; }
  /// What is shown is no longer what there is.
  void invalidate();
  void acknowledged(std::uint32_t frame, Clock::time_point now) { link_.acknowledged(frame, now); }

  /// Whether its hand is on the view.
  bool is_moving(Clock::time_point now) const { return moving_ && now < last_view_ + settle_time; }
  /// What to render next; nullopt: nothing now.
  std::optional<FramePlan> next(Clock::time_point now) const;
  /// When next() may have another answer though nothing has happened; nullopt: never.
  std::optional<Clock::time_point> next_change(Clock::time_point now) const;

  /// The picture of a plan, over `background` as it is shown. Encodes and sends it. Throws
  /// Cancelled soon after `cancel`, which may be null, becomes true.
  void send(const FramePlan& plan, const Framebuffer& image, double termination_opacity,
            const Color& background, double render_ms, const std::atomic<bool>* cancel);
  /// The picture of a plan was broken off after so long.
  void broken_off(const FramePlan& plan, double ms);
  /// The present view cannot be rendered: it is let be until something changes.
  void give_up() {
    shown_ = 1;
    shown_final_ = true;
  }
  /// Of the last picture that was sent.
  double encode_ms() const { return encode_ms_; }

 private:
  std::size_t num_pixels() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  /// The full picture, which is large, need not come any more if it has not yet.
  void recall_final();

  std::shared_ptr<Outlet> outlet_;
  Camera camera_;
  int width_ = 0, height_ = 0;  ///< 0: not told yet
  std::uint32_t view_sequence_ = 0, scene_sequence_ = 0, last_frame_ = 0;
  std::optional<ClientId> following_;
  bool moving_ = false;
  Clock::time_point last_view_;
  double shown_ = 0;  ///< scale of what is shown; 0: nothing of the present view
  bool shown_final_ = false;
  double encode_ms_ = 0;
  Pace pace_;
  Link link_;
};

}  // namespace motes::server
