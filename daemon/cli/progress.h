// ProgressBar: shows the progress of a long operation, its rate and the remaining time.
#pragma once

#include <functional>
#include <string>

#include "daemon/base/clock.h"

namespace merlin::cli {

// Receives the progress of an operation: its title, as in the bar ("reducing"), and the share that
// is done, 0..1. Called often, on the thread that works.
using ProgressListener = std::function<void(const std::string& title, double share)>;

// On a terminal, redraws one line up to ten times a second; otherwise prints a line after each
// tenth of the work. Writes to stderr. Thread-bound.
class ProgressBar {
 public:
  ProgressBar(std::string title, std::string unit, const Clock& clock);

  // `share`: part of the work that is done, 0..1. `count`: items done so far, for the rate; `unit`
  // of the constructor is their name in the plural, such as "points".
  void update(double share, std::size_t count);
  void finish(std::size_t count);  // the work is done: `count` items

 private:
  void draw(double share, std::size_t count);

  std::string title_, unit_;
  const Clock& clock_;
  bool terminal_;
  Timestamp began_, drawn_{};
  int tenths_ = 0;
};

}  // namespace merlin::cli
