// How long work tells its user what it is doing: progress, and warnings that are not errors.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace motes {

/// Receives the progress of long work. Called from one thread at a time, seldom enough to be cheap.
class Progress {
 public:
  virtual ~Progress() = default;
  /// `activity` is a phrase such as "reading silica.dump"; `fraction` lies in [0, 1].
  virtual void update(std::string_view activity, double fraction) = 0;
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
