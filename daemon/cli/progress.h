// ProgressBar: shows the progress of a long operation, its rate and the remaining time.
#pragma once

#include <string>

#include "daemon/base/clock.h"

namespace merlin::cli {

// On a terminal, one line that is redrawn ten times a second; otherwise a line for each tenth of
// the work. Writes to stderr. Thread-bound.
class ProgressBar {
 public:
  ProgressBar(std::string title, std::string unit, const Clock& clock);

  // `share`: part of the work that is done, 0..1; `count`: number of `unit` so far, for the rate.
  void update(double share, std::size_t count);
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
