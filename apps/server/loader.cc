// A queue and a thread.
#include "server/loader.h"

#include <utility>

namespace motes::server {

using namespace std::chrono_literals;

void LoadProgress::update(std::string_view activity, double fraction) {
  if (cancelled_) throw Cancelled();
  const auto now = std::chrono::steady_clock::now();
  if (activity == last_activity_ && now - last_report_ < 100ms) return;
  last_activity_ = activity;
  last_report_ = now;
  has_reported_ = true;
  report_(activity, fraction);
}

Loader::Loader() : thread_([this] { run(); }) {}

Loader::~Loader() {
  cancel();
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  something_to_do_.notify_one();
  thread_.join();
}

void Loader::add(Job job) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({std::move(job)});
  }
  something_to_do_.notify_one();
}

void Loader::cancel() {
  const std::lock_guard lock(mutex_);
  waiting_.clear();
  if (current_) *current_ = true;
}

void Loader::run() {
  while (true) {
    Waiting next;
    {
      std::unique_lock lock(mutex_);
      something_to_do_.wait(lock, [this] { return ended_ || !waiting_.empty(); });
      if (ended_) return;
      next = std::move(waiting_.front());
      waiting_.pop_front();
      current_ = next.cancelled;
    }
    try {
      next.job(*next.cancelled);
    } catch (const Cancelled&) {
      // Whoever cancelled it knows.
    }
    const std::lock_guard lock(mutex_);
    current_ = nullptr;
  }
}

}  // namespace motes::server
