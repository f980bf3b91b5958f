// DegradationLadder: decides when quality other than detail is reduced, and when it is restored, if
// even frames of the coarsest detail miss their deadlines. The caller decides what each step means
// (the wall: smaller tiles, then lower frame rates).
//
// Both rules are statistical tests of the share of late frames and count frames, not seconds.
// README.md says where the figures come from.
//   down  Page's cumulative sum of log-likelihood ratios, for a share of 25 % late frames against
//         8 %: a late frame adds ln(0.25 / 0.08), a frame in time subtracts ln(0.92 / 0.75), and
//         the sum is never below 0. When it reaches 11 the ladder goes one step down.
//   up    after 300 frames in time in a row, if the coarsest detail is expected to fit there.
#pragma once

namespace merlin::render::governor {

// Pure; thread-bound.
class DegradationLadder {
 public:
  // `most`: number of the lowest step, i.e. of the worst quality; step 0 is full quality.
  explicit DegradationLadder(int most) noexcept : most_(most) {}

  // To be called after each deadline that passed while something moved, with the frame that had
  // this deadline. `late`: the frame was late. `least`: it had the coarsest detail, or there was no
  // time to draw it at all. `higher_fits`: the coarsest detail is expected to fit at the next
  // higher step. Returns whether the step has changed.
  bool observe(bool late, bool least, bool higher_fits) noexcept;

  int step() const noexcept { return step_; }  // 0: full quality

  // Replaces the number of the lowest step; if the ladder is further down, it goes up to that step.
  // Returns whether the step has changed. REQUIRES: most >= 0.
  bool setMost(int most) noexcept;

 private:
  bool go(int step) noexcept;

  int most_;
  int step_ = 0;
  double evidence_ = 0;  // cumulative sum of log-likelihood ratios, >= 0
  int clean_ = 0;        // number of frames in time in a row
};

}  // namespace merlin::render::governor
