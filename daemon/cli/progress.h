// ProgressBar: shows the progress of a long operation, its rate and the remaining time.
#pragma once

#include <functional>
#include <string>

#include "daemon/base/clock.h"

namespace merlin::cli {

// Receives the progress of an operation: its title, as in the bar ("reducing"), and the share of
// the work that is done, 0 to 1. Is called often, by the thread that does the work.
using ProgressListener = std::function<void(const std::string& title, double share)>;

// On a terminal, redraws one line up to ten times a second; otherwise prints a line after each
// tenth of the work. Writes to stderr. Thread-bound.
class ProgressBar {
 public:
  ProgressBar(std::string title, std::string unit, const Clock& clock);

  // Draws the bar if it is due. `share`: part of the work that is done, 0 to 1. `count`: number of
  // items done so far, for the rate; the constructor's `unit` is their name in the plural, such as
  // "points".
  void update(double share, std::size_t count);
  // Draws the complete bar; to be called once the work is done. `count`: number of all items.
  void finish(std::size_t count);

 private:
  void draw(double share, std::size_t count);

  std::string title_, unit_;
  const Clock& clock_;
  bool terminal_;
  Timestamp began_, drawn_{};
  int tenths_ = 0;
};

}  // namespace merlin::cli
