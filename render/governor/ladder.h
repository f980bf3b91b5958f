// Ladder: when something gives way where not even the fewest triangles come in time: the size of
// the picture, then the rate; what each rung means is the caller's.
//
// Both rules are tests of the share of late frames, over frames and not over seconds. README.md
// says where the figures come from.
//   down  Page's cumulative sum: a late frame adds the logarithm of how much likelier it is when
//         25 % of the frames are late than when 8 % are; a frame in time takes its own away; the
//         sum is never below 0. At 11 the ladder goes one rung down.
//   up    300 frames in a row in time, if the model says that the fewest fit there.
#pragma once

namespace merlin::render {

// Pure; thread-bound.
class Ladder {
 public:
  // `most`: rungs that there are below the top, 0.
  explicit Ladder(int most) noexcept : most_(most) {}

  // A deadline passed while something moved. `least`: its frame had the fewest triangles there
  // are, or there was no time for one. `higher_fits`: these would fit the next higher rung.
  // Returns whether the rung is another one now.
  bool observe(bool late, bool least, bool higher_fits) noexcept;

  int rung() const noexcept { return rung_; }  // 0: nothing gave way

 private:
  bool go(int rung) noexcept;

  int most_;
  int rung_ = 0;
  double evidence_ = 0;  // cumulative sum of logarithms of likelihood ratios, >= 0
  int clean_ = 0;        // in a row
};

}  // namespace merlin::render
