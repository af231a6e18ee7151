// The studio's thread: tasks, then the picture that is wanted most, then long work.
#include "server/studio.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "core/stopwatch.h"
#include "server/answers.h"

namespace motes::server {
namespace {

using namespace std::chrono_literals;

/// A moving picture that has taken so long is not worth waiting for when there is a newer view.
constexpr auto late = 120ms;
/// What insists may keep others waiting for so long.
constexpr auto insistence = 1s;
/// One ray a pixel meets balls, sticks and isosurfaces, and little light is traced.
const FrameQuality preview{1, 1, 4, false, 0};

}  // namespace

Studio::Studio() : thread_([this] { run(); }) {}

Studio::~Studio() { stop(); }

void Studio::stop() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    break_off_ = true;
  }
  something_to_do_.notify_one();
  loader_.cancel();
  lookahead_.cancel();
  if (thread_.joinable()) thread_.join();
  if (encoding_) *encoding_->request.abandoned = true;
  encoder_.reset();
  // Nothing is left that would answer when the network is gone.
  viewers_.clear();
  tasks_.clear();
  pictures_.clear();
  encoding_.reset();
}

void Studio::post(Task task, bool breaks_off) {
  {
    const std::lock_guard lock(mutex_);
    if (ended_) return;
    tasks_.push_back(std::move(task));
    if (breaks_off) break_off_if_late();
  }
  something_to_do_.notify_one();
}

void Studio::break_off_if_late() {
  const auto time = Clock::now() - under_way_since_;
  if (under_way_ == UnderWay::resting || (under_way_ == UnderWay::moving && time > late) ||
      (under_way_ == UnderWay::insisting && time > insistence)) {
    break_off_ = true;
  }
}

void Studio::post_for(ClientId client, std::function<void(Viewer&)> task, bool breaks_off) {
  post(
      [this, client, task = std::move(task)] {
        const auto viewer = viewers_.find(client);
        if (viewer != viewers_.end()) task(viewer->second);
      },
      breaks_off);
}

void Studio::run() {
  while (run_tasks()) {
    // What has been decided for one moment is waited for from that same moment.
    const auto now = Clock::now();
    if (!make_next_picture(now) && !do_long_task()) wait(now);
  }
}

bool Studio::run_tasks() {
  while (true) {
    Task task;
    {
      const std::lock_guard lock(mutex_);
      if (ended_) return false;
      if (tasks_.empty()) return true;
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    // What one client asks for, such as more memory than there is, must not end the others.
    try {
      task();
    } catch (const std::exception& error) {
      send_to_all(error_text({}, error.what()));
    }
  }
}

void Studio::wait(Clock::time_point now) {
  std::optional<Clock::time_point> until;
  for (const auto& [id, viewer] : viewers_) {
    const auto change = viewer.next_change(now);
    if (change && (!until || *change < *until)) until = change;
  }
  std::unique_lock lock(mutex_);
  const auto ready = [this] { return ended_ || !tasks_.empty(); };
  if (until) {
    something_to_do_.wait_until(lock, *until, ready);
  } else {
    something_to_do_.wait(lock, ready);
  }
}

bool Studio::begin(UnderWay what) {
  const std::lock_guard lock(mutex_);
  if (ended_ || (what != UnderWay::moving && !tasks_.empty())) return false;
  under_way_ = what;
  under_way_since_ = Clock::now();
  break_off_ = false;
  return true;
}

void Studio::end() {
  const std::lock_guard lock(mutex_);
  under_way_ = UnderWay::nothing;
}

bool Studio::make_next_picture(Clock::time_point now) {
  if (!document_) return false;
  // In turn, those that move before those that do not.
  Viewers::iterator best = viewers_.end();
  std::optional<FramePlan> plan;
  const auto consider = [&](Viewers::iterator it) {
    const auto next = it->second.next(now);
    if (next && (!plan || (next->moving && !plan->moving))) {
      plan = next;
      best = it;
    }
  };
  const auto after = viewers_.upper_bound(last_served_);
  for (auto it = after; it != viewers_.end(); ++it) consider(it);
  for (auto it = viewers_.begin(); it != after; ++it) consider(it);
  const bool somebody_moves = std::any_of(viewers_.begin(), viewers_.end(),
                                          [now](const auto& v) { return v.second.is_moving(now); });
  if (!plan || (somebody_moves && !plan->moving)) return false;
  last_served_ = best->first;
  make_picture(best->second, *plan);
  return true;
}

void Studio::make_picture(Viewer& viewer, const FramePlan& plan) {
  if (!begin(plan.moving ? UnderWay::moving : UnderWay::resting)) return;
  const Stopwatch stopwatch;
  const auto scaled = [&plan](int side) {
    return std::max(1, static_cast<int>(std::lround(side * plan.scale)));
  };
  try {
    // A moving picture that cannot be smaller is waited for, however late.
    const bool breakable = !plan.moving || plan.scale > Pace::smallest;
    const std::atomic<bool>* cancel = breakable ? &break_off_ : nullptr;
    document_->render(viewer.camera(), scaled(viewer.width()), scaled(viewer.height()),
                      plan.final ? FrameQuality{} : preview, cancel, image_, &statistics_);
    const RenderSettings& settings = document_->scene().render;
    viewer.send(plan, image_, settings.termination_opacity, settings.background,
                stopwatch.milliseconds(), cancel);
    end();
  } catch (const Cancelled&) {
    end();
    viewer.broken_off(plan, stopwatch.milliseconds());
  } catch (const std::exception& error) {  // Error, or not enough memory
    end();
    viewer.give_up();
    viewer.outlet().send_text(error_text({}, error.what()));
  }
}

void Studio::send_to_all(const std::string& text) {
  for (auto& [id, viewer] : viewers_) viewer.outlet().send_text(text);
}

void Studio::send_clients() {
  std::map<ClientId, std::optional<ClientId>> following;
  for (const auto& [id, viewer] : viewers_) following[id] = viewer.following();
  send_to_all(clients_text(following));
}

void Studio::send_scene(const SceneAnswer& answer) {
  send_to_all(scene_text(*document_, frames_, answer));
}

void Studio::send_warnings(const Warnings& warnings) {
  if (!warnings.lines().empty()) send_to_all(warnings_text(warnings));
}

}  // namespace motes::server
