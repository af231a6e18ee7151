// The studio without a network: events as fast as they can come.
#include "server/studio.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>

#include "document/input.h"
#include "server/running_server.h"

namespace motes::server {
namespace {

/// A client that acknowledges at once and remembers the last frame.
class EagerOutlet : public Outlet {
 public:
  explicit EagerOutlet(Studio& studio) : studio_(studio) {}

  void send_text(std::string /*text*/) override {}
  void send_frame(std::string message) override {
    studio_.handle(1, AckMessage{TestClient::number(message, 4)});
    const std::lock_guard lock(mutex_);
    const std::uint32_t view = TestClient::number(message, 8);
    stale_ = stale_ || view < view_;
    view_ = view;
    final_ = TestClient::number(message, 18, 2) == 1;
    ++frames_;
    changed_.notify_all();
  }
  /// Waits until the full picture of that view is there; false: it took too long.
  bool wait_for_final(std::uint32_t view) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(60),
                             [&] { return final_ && view_ == view; });
  }
  bool was_stale() {
    const std::lock_guard lock(mutex_);
    return stale_;
  }

 private:
  Studio& studio_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint32_t view_ = 0;
  int frames_ = 0;
  bool final_ = false, stale_ = false;
};

TEST(Studio, KeepsUpWithTwoHoursOfEvents) {
  const std::string data = MOTES_SOURCE_DIR "/data/demo/zeolite_mfi_3494.xyz";
  Scene scene = open_scene(data);
  Studio studio;
  const auto outlet = std::make_shared<EagerOutlet>(studio);
  studio.open({"zeolite", [scene] { return scene; }});
  studio.connect(1, outlet);
  studio.handle(1, SizeMessage{32, 32});
  constexpr std::uint32_t num_events = 2 * 3600 * 60;
  for (std::uint32_t i = 1; i <= num_events; ++i) {
    Camera camera;
    camera.eye = {20 + 0.001 * (i % 1000), 20, 120};
    camera.target = {20, 20, 20};
    studio.handle(1, ViewMessage{i, camera, i != num_events});
    if (i % 100 == 0) studio.handle(1, PickMessage{i, 16, 16});
    if (i % 1000 == 0) studio.handle(1, HistogramMessage{});
  }
  EXPECT_TRUE(outlet->wait_for_final(num_events));
  EXPECT_FALSE(outlet->was_stale());
}

TEST(Studio, StopsWhileItOpens) {
  const std::string data = MOTES_SOURCE_DIR "/data/demo/zeolite_mfi_3494.xyz";
  for (int i = 0; i < 20; ++i) {
    Studio studio;
    studio.open({"zeolite", [data] { return open_scene(data); }});
    studio.connect(1, std::make_shared<EagerOutlet>(studio));
    studio.handle(1, SizeMessage{64, 64});
    if (i % 2 == 0) studio.handle(1, CancelMessage{});
  }
}

}  // namespace
}  // namespace motes::server
