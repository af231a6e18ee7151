// The studio without a network: events as fast as they can come.
#include "server/studio.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "document/document.h"
#include "document/input.h"
#include "image/encode.h"
#include "server/frame_message.h"

namespace motes::server {
namespace {

/// A client that remembers the last frame, and what was recalled.
class FrameOutlet : public Outlet {
 public:
  void send_text(std::string /*text*/) override {}
  void send_frame(std::string message) override {
    const FrameHeader header = parse_frame_header(message).value();
    if (is_fast(header)) studio_.handle(1, AckMessage{header.frame});
    const std::lock_guard lock(mutex_);
    stale_ = stale_ || header.view_sequence < last_.view_sequence;
    last_ = header;
    image_ = message.substr(frame_header_bytes);
    changed_.notify_all();
  }
  void recall_frame(std::uint32_t frame) override {
    const std::lock_guard lock(mutex_);
    recalled_.push_back(frame);
  }
  struct Final {
    std::uint32_t frame = 0;
    std::string image;
  };
  /// Waits for the full picture of that view; without an image: it took too long.
  Final wait_for_final(std::uint32_t view) {
    std::unique_lock lock(mutex_);
    const bool came = changed_.wait_for(lock, std::chrono::seconds(60),
                                        [&] { return last_.final && last_.view_sequence == view; });
    EXPECT_TRUE(came);
    return came ? Final{last_.frame, image_} : Final{};
  }
  bool was_stale() {
    const std::lock_guard lock(mutex_);
    return stale_;
  }
  std::vector<std::uint32_t> recalled() {
    const std::lock_guard lock(mutex_);
    return recalled_;
  }

 protected:
  explicit FrameOutlet(Studio& studio) : studio_(studio) {}

 private:
  /// Whether it acknowledges such a frame.
  virtual bool is_fast(const FrameHeader& header) const = 0;

  Studio& studio_;
  std::mutex mutex_;
  std::condition_variable changed_;
  FrameHeader last_;
  std::string image_;
  bool stale_ = false;
  std::vector<std::uint32_t> recalled_;
};

/// Acknowledges at once.
class EagerOutlet : public FrameOutlet {
 public:
  explicit EagerOutlet(Studio& studio) : FrameOutlet(studio) {}

 private:
  bool is_fast(const FrameHeader& /*header*/) const override { return true; }
};

constexpr const char* zeolite = MOTES_SOURCE_DIR "/data/demo/zeolite_mfi_3494.xyz";

/// The file of the full picture, made without a studio.
std::string picture_of(const Scene& scene, const Camera& camera, int width, int height) {
  Warnings warnings;
  const Document document = Document::open(zeolite, scene, nullptr, warnings);
  Framebuffer image;
  document.render(camera, width, height, {}, nullptr, image);
  const RenderSettings& settings = document.scene().render;
  return encode_png(to_display(image, settings.termination_opacity, settings.background));
}

/// A studio that shows a scene to its client 1, in pictures of `side` pixels.
struct OpenStudio {
  Scene scene = open_scene(zeolite);
  Studio studio;
  std::shared_ptr<EagerOutlet> outlet = std::make_shared<EagerOutlet>(studio);

  explicit OpenStudio(int side) {
    studio.open({"zeolite", [scene = scene] { return scene; }});
    studio.connect(1, outlet);
    studio.handle(1, SizeMessage{side, side});
    // What is opened is looked at anew, whatever was looked at before.
    EXPECT_NE(outlet->wait_for_final(0).image, "");
  }
};

TEST(Studio, KeepsUpWithTwoHoursOfEvents) {
  OpenStudio open(32);
  Studio& studio = open.studio;
  constexpr std::uint32_t num_events = 2 * 3600 * 60;
  Camera camera;
  for (std::uint32_t i = 1; i <= num_events; ++i) {
    camera.eye = {20 + 0.001 * (i % 1000), 20, 120};
    camera.target = {20, 20, 20};
    studio.handle(1, ViewMessage{i, camera, i != num_events});
    if (i % 100 == 0) studio.handle(1, PickMessage{i, 16, 16});
    if (i % 1000 == 0) studio.handle(1, HistogramMessage{});
  }
  EXPECT_EQ(open.outlet->wait_for_final(num_events).image, picture_of(open.scene, camera, 32, 32));
  EXPECT_FALSE(open.outlet->was_stale());
}

TEST(Studio, GivesUpPicturesThatNobodyWaitsFor) {
  OpenStudio open(16);
  Studio& studio = open.studio;
  std::atomic<int> abandoned = 0;
  for (const bool before : {true, false}) {
    const PictureRequest huge{1, 16384, 16384};
    if (before) studio.abandon(huge);
    studio.picture(huge, [&](const auto&, const auto&) { ++abandoned; });
    if (!before) studio.abandon(huge);
    std::promise<bool> made;
    studio.picture({1, 16, 16}, [&](const std::optional<std::string>& file, const std::string&) {
      made.set_value(file.has_value());
    });
    EXPECT_TRUE(made.get_future().get());
  }
  EXPECT_EQ(abandoned, 0);
}

/// Remembers what it is told.
class TextOutlet : public Outlet {
 public:
  void send_text(std::string text) override {
    const std::lock_guard lock(mutex_);
    texts_ += text;
    changed_.notify_all();
  }
  void send_frame(std::string /*message*/) override {}
  void recall_frame(std::uint32_t /*frame*/) override {}
  bool hears(const std::string& part) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(60),
                             [&] { return texts_.find(part) != std::string::npos; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string texts_;
};

TEST(Studio, ShowsFramesWhileAPictureIsMade) {
  OpenStudio open(16);
  Studio& studio = open.studio;
  const PictureRequest huge{1, 5000, 5000};
  std::atomic<bool> made = false;
  studio.picture(huge, [&](const auto&, const auto&) { made = true; });
  Camera camera;
  camera.target = {20, 20, 20};
  for (std::uint32_t view = 1; view <= 10; ++view) {  // more than it can be patient with
    camera.eye = {20.0 + view, 20, 120};
    studio.handle(1, ViewMessage{view, camera, false});
    EXPECT_NE(open.outlet->wait_for_final(view).image, "");
  }
  EXPECT_FALSE(made);
  studio.abandon(huge);
}

TEST(Studio, FinishesPicturesThatAreBrokenOff) {
  OpenStudio open(16);
  Studio& studio = open.studio;
  Camera camera;
  camera.target = {20, 20, 20};
  camera.eye = {21, 20, 120};
  studio.handle(1, ViewMessage{1, camera, false});
  EXPECT_NE(open.outlet->wait_for_final(1).image, "");
  const std::string expected = picture_of(open.scene, camera, 400, 400);
  std::promise<std::string> made;
  studio.picture({1, 400, 400}, [&](const std::optional<std::string>& file, const std::string&) {
    made.set_value(file.value());
  });
  auto picture = made.get_future();
  Camera other = camera;
  for (std::uint32_t view = 2;
       picture.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready; ++view) {
    other.eye.y += 1;
    studio.handle(1, ViewMessage{view, other, false});
  }
  EXPECT_EQ(picture.get(), expected);
}

/// A client to which a full picture takes for ever.
class SlowOutlet : public FrameOutlet {
 public:
  explicit SlowOutlet(Studio& studio) : FrameOutlet(studio) {}

 private:
  bool is_fast(const FrameHeader& header) const override { return !header.final; }
};

TEST(Studio, RecallsFullPicturesThatAreOutdated) {
  Studio studio;
  const auto outlet = std::make_shared<SlowOutlet>(studio);
  studio.open({"zeolite", [] { return open_scene(zeolite); }});
  studio.connect(1, outlet);
  studio.handle(1, SizeMessage{32, 32});
  std::vector<std::uint32_t> outdated;
  Camera camera;
  camera.target = {20, 20, 20};
  for (std::uint32_t view = 1; view <= 5; ++view) {  // more than may be under way
    camera.eye = {20.0 + view, 20, 120};
    studio.handle(1, ViewMessage{view, camera, false});
    const std::uint32_t frame = outlet->wait_for_final(view).frame;
    EXPECT_EQ(outlet->recalled(), outdated);
    outdated.push_back(frame);
  }
}

TEST(Studio, TellsWhoComesLaterWhyNothingIsOpen) {
  Studio studio;
  std::promise<std::string> failed;
  studio.open({.name = "nothing",
               .scene = []() -> Scene { throw Error("it is not there"); },
               .failed = [&](const auto& error) { failed.set_value(error.value()); }});
  EXPECT_EQ(failed.get_future().get(), "it is not there");
  const auto outlet = std::make_shared<TextOutlet>();
  studio.connect(1, outlet);
  EXPECT_TRUE(outlet->hears("it is not there"));
}

TEST(Studio, StopsWhileItOpens) {
  for (int i = 0; i < 20; ++i) {
    Studio studio;
    studio.open({"zeolite", [] { return open_scene(zeolite); }});
    studio.connect(1, std::make_shared<EagerOutlet>(studio));
    studio.handle(1, SizeMessage{64, 64});
    if (i % 2 == 0) studio.handle(1, CancelMessage{});
  }
}

}  // namespace
}  // namespace motes::server
