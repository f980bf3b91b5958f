// LateBar: a progress bar for steps that work on pixels, shown once the work has taken two seconds.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>

#include "daemon/base/clock.h"
#include "daemon/cli/progress.h"
#include "render/range/work.h"

namespace merlin::cli {

// Thread-bound. Must outlive the Work that it returns.
class LateBar {
 public:
  // `listener`: receives the progress from the beginning on; may be empty.
  LateBar(const std::string& title, std::size_t pixels, const Clock& clock,
          ProgressListener listener = {})
      : title_(title),
        listener_(std::move(listener)),
        pixels_(pixels),
        clock_(clock),
        began_(clock.now()),
        bar_(title, "pixels", clock) {}

  // Returns the parameters for a step: the number of threads (0: all cores) and the progress
  // function.
  render::range::Work work(unsigned threads) {
    return {threadsOr(threads), [this](double share) {
              if (listener_) listener_(title_, share);
              shown_ = shown_ || clock_.now() - began_ > std::chrono::seconds(2);
              if (shown_) bar_.update(share, at(share));
            }};
  }
  void finish() {
    if (shown_) bar_.finish(pixels_);
  }

 private:
  std::size_t at(double share) const {
    return static_cast<std::size_t>(share * static_cast<double>(pixels_));
  }

  std::string title_;
  ProgressListener listener_;
  std::size_t pixels_;
  const Clock& clock_;
  Timestamp began_;
  ProgressBar bar_;
  bool shown_ = false;
};

}  // namespace merlin::cli
