// The studio: one scene, those who look at it, and the thread that makes their pictures.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/report.h"
#include "document/document.h"
#include "image/framebuffer.h"
#include "image/write_image.h"
#include "scene/scene.h"
#include "server/answers.h"
#include "server/loader.h"
#include "server/messages.h"
#include "server/outlet.h"
#include "server/viewer.h"

namespace motes::server {

/// Something to look at.
struct Opening {
  std::string name;                            ///< for people
  std::function<Scene()> scene;                ///< called on the loader's thread; throws Error
  std::optional<ClientId> client = {};         ///< who asked for it
  std::optional<std::uint32_t> sequence = {};  ///< by which "scene" message, if by one
  /// Told that nothing came of it, and what was wrong with it, unless it was cancelled, on the
  /// studio's thread; may be null.
  std::function<void(const std::optional<std::string>& error)> failed = nullptr;
};

/// A picture to be saved.
struct PictureRequest {
  ClientId client = 0;  ///< whose view
  int width = 0, height = 0;
  ImageFormat format = ImageFormat::png;
  /// Becomes true when nobody waits for it any more: Studio::abandon().
  std::shared_ptr<std::atomic<bool>> abandoned = std::make_shared<std::atomic<bool>>(false);
};

/// The picture's file, or nullopt and why there is none. Called on one of the studio's threads.
using PictureAnswer = std::function<void(std::optional<std::string> file, std::string error)>;

/// All public functions are safe from any thread and return at once. One thread renders, for one
/// client after the other: moving views first, then better pictures for those at rest, then what
/// takes long. What clients do breaks off the work for those at rest, which is begun anew, but for
/// pictures to be saved, which go on.
class Studio {
 public:
  Studio();
  ~Studio();
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  /// Ends the threads and lets go of all outlets. Waits for what is being done.
  void stop();

  void connect(ClientId client, std::shared_ptr<Outlet> outlet);
  void disconnect(ClientId client);
  /// Any message but those about files and scenes.
  void handle(ClientId client, const Message& message);
  /// A client's scene, by its message `sequence`.
  void set_scene(ClientId client, std::uint32_t sequence, Scene scene);
  /// Opens something; what there is stays until it is ready.
  void open(Opening opening);
  /// The files of what is shown and of what is being opened.
  std::vector<std::filesystem::path> files_in_use();
  void picture(const PictureRequest& request, PictureAnswer answer);
  /// There may be no answer then.
  void abandon(const PictureRequest& request);

 private:
  using Clock = Viewer::Clock;
  using Task = std::function<void()>;
  using Viewers = std::map<ClientId, Viewer>;

  /// What is being rendered, for those who may want to break it off: what was broken off too often
  /// insists on some time.
  enum class UnderWay { nothing, moving, resting, insisting };

  /// A picture to be saved, on its way.
  struct PictureJob {
    PictureRequest request;
    PictureAnswer answer;
    std::uint64_t version = 0;  ///< of the scene; 0: not begun
    Camera camera;
    Framebuffer image;
    std::vector<std::uint8_t> tiles_done;
    int restarts = 0;  ///< since the scene was changed
  };
  struct WantedHistogram {
    ClientId client = 0;
    int broken_off = 0;
  };

  /// Has the studio's thread do something, before the next picture.
  void post(Task task, bool breaks_off);
  void post_for(ClientId client, std::function<void(Viewer&)> task, bool breaks_off);
  void break_off_if_late();

  // All that follows is for the studio's thread.
  void run();
  /// Does what others have asked for; false: the studio ends.
  bool run_tasks();
  /// Makes the picture that is wanted most; false: none is.
  bool make_next_picture(Clock::time_point now);
  /// A histogram or a piece of a picture to be saved; false: nobody waits for any.
  bool do_long_task();
  void wait(Clock::time_point now);
  void make_picture(Viewer& viewer, const FramePlan& plan);
  /// Says what is being rendered; false if there is something to be done before.
  bool begin(UnderWay what);
  void end();

  void send_to_all(const std::string& text);
  void send_clients();
  void send_scene(const SceneAnswer& answer);
  void send_warnings(const Warnings& warnings);

  void look(ClientId client, const Camera& camera, bool moving);
  void answer(ClientId client, Viewer& viewer, const Message& message);
  void change_scene(ClientId client, std::uint32_t sequence, const Scene& scene);
  void start_opening(const Opening& opening);
  void end_opening(const Opening& opening, std::shared_ptr<Document> document,
                   const std::optional<std::string>& error, const Warnings& warnings);
  void adopt(const Opening& opening, std::shared_ptr<Document> document, const Warnings& warnings);
  void make_histogram(Viewer& viewer, WantedHistogram& wanted);
  /// Renders what is missing of the first picture, until that is broken off.
  void go_on_with_picture();
  bool prepare_picture(PictureJob& job);
  void encode(std::shared_ptr<PictureJob> job);
  /// The document is another one, or shows another scene.
  void document_has_changed();
  void count_frames();
  void prefetch(std::uint64_t frame);

  std::mutex mutex_;
  std::condition_variable something_to_do_;
  std::deque<Task> tasks_;
  UnderWay under_way_ = UnderWay::nothing;
  Clock::time_point under_way_since_;
  std::atomic<bool> break_off_ = false;
  bool ended_ = false;
  std::vector<std::filesystem::path> shown_files_, opening_files_;

  std::shared_ptr<Document> document_;  ///< null: nothing opened yet
  Viewers viewers_;
  ClientId last_served_ = 0;
  bool fitted_ = false;        ///< the document's camera was fitted to its data
  std::uint64_t version_ = 0;  ///< of what the document shows
  std::deque<WantedHistogram> histograms_;
  std::deque<std::shared_ptr<PictureJob>> pictures_;
  std::shared_ptr<PictureJob> encoding_;  ///< until it is done no other is begun: they may be large
  Framebuffer image_;
  RenderStatistics statistics_;

  /// The frame after the present one, read while that is looked at.
  struct Prefetched {
    std::uint64_t frame = 0;
    ParticleSet particles;
  };
  std::optional<Prefetched> prefetched_;
  std::optional<std::uint64_t> prefetching_;
  std::optional<std::size_t> frames_;      ///< of the document's file, once they are counted
  std::shared_ptr<FrameReader> reader_;    ///< for the lookahead's thread alone
  std::atomic<bool> cancel_edit_ = false;  ///< of the scene, while it reads
  std::string opening_error_;  ///< why there is no document, for those who connect later
  std::uint64_t opening_ = 0;  ///< counts openings: what an older one brings is dropped

  Loader loader_;                                 ///< opens
  Loader lookahead_;                              ///< reads what may be wanted next
  std::optional<Loader> encoder_{std::in_place};  ///< makes files of pictures
  std::thread thread_;
};

}  // namespace motes::server
