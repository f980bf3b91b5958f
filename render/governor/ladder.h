// Ladder: when something gives way where not even the fewest triangles come in time: the size of
// the picture, then the rate; what each rung means is the caller's.
//
// Counts of frames, not times: 10 late of the last 60 that had the fewest triangles lead one rung
// down, 300 in a row in time lead back up, if the model says that the fewest fit there. After US
// patent 7,450,130 (a compositor's rate by counts of missed, late and early frames).
#pragma once

#include <cstdint>

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
  std::uint64_t late_ = 0;  // of the last frames, a bit each, the newest lowest
  int clean_ = 0;           // in a row
};

}  // namespace merlin::render
