// Control laws of other systems that hold a frame rate, for comparison. The published laws are
// implemented anew; the vendors' own code may do better. Each law observes the time of a frame and
// returns the number of triangles for the next one.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace merlin::bench {

// Thread-bound.
class Law {
 public:
  virtual ~Law() = default;
  virtual void observe(double work_s) = 0;
  double triangles() const noexcept { return triangles_; }

 protected:
  // Sets the number of triangles, clamped to the range that MERLIN's governor also has.
  void set(double triangles);
  double triangles_ = 10'000;
};

struct NamedLaw {
  std::string name;
  std::function<std::unique_ptr<Law>()> make;
};

// Returns MERLIN's law of 1998, Equalizer's DFR, Unreal's dynamic resolution and ParaView's two
// levels.
std::vector<NamedLaw> otherLaws();

}  // namespace merlin::bench
