// Work in the background: reading files while the scene is looked at.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "core/report.h"

namespace motes::server {

/// Tells of progress at most some times a second, and ends the work once it is cancelled.
class LoadProgress : public Progress {
 public:
  using Report = std::function<void(std::string_view activity, double fraction)>;

  LoadProgress(Report report, const std::atomic<bool>& cancelled)
      : report_(std::move(report)), cancelled_(cancelled) {}

  /// Throws Cancelled.
  void update(std::string_view activity, double fraction) override;
  bool has_reported() const { return has_reported_; }

 private:
  Report report_;
  const std::atomic<bool>& cancelled_;
  std::string last_activity_;
  bool has_reported_ = false;
  std::chrono::steady_clock::time_point last_report_;
};

/// A thread that does one job after the other.
class Loader {
 public:
  /// Given whether it has been cancelled.
  using Job = std::function<void(const std::atomic<bool>& cancelled)>;

  Loader();
  /// Cancels what there is and waits for it.
  ~Loader();
  Loader(const Loader&) = delete;
  Loader& operator=(const Loader&) = delete;

  /// Does the job after those that are waiting. It throws nothing but Cancelled.
  void add(Job job);
  /// Cancels the job under way, if there is one, and forgets those that wait.
  void cancel();

 private:
  struct Waiting {
    Job job;
    std::shared_ptr<std::atomic<bool>> cancelled = std::make_shared<std::atomic<bool>>(false);
  };

  void run();

  std::mutex mutex_;
  std::condition_variable something_to_do_;
  std::deque<Waiting> waiting_;
  std::shared_ptr<std::atomic<bool>> current_;  ///< cancels what is under way; null: nothing
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace motes::server
