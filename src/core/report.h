// How long work tells its user what it is doing: progress, and warnings that are not errors.
#pragma once

#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace motes {

/// Receives the progress of long work. Called from one thread at a time, seldom enough to be cheap.
/// What it throws, such as Cancelled, ends the work.
class Progress {
 public:
  virtual ~Progress() = default;
  /// `activity` is a phrase such as "reading silica.dump"; `fraction` lies in [0, 1].
  virtual void update(std::string_view activity, double fraction) = 0;
};

/// Work was given up because it was asked to: not an Error, nobody need hear of it.
class Cancelled : public std::exception {
 public:
  const char* what() const noexcept override { return "cancelled"; }
};

/// Things that the user should know although the work went on: one line each, in order.
/// A line that is already there is not added again.
class Warnings {
 public:
  void add(std::string line);
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

}  // namespace motes
