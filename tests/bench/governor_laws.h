// How other systems hold a rate, for comparison: their published laws, re-written here; the
// vendors' own code may do better. Each takes a frame's work and says what the next may have.
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
  // Within what MERLIN's governor is also held to.
  void set(double triangles);
  double triangles_ = 10'000;
};

struct NamedLaw {
  std::string name;
  std::function<std::unique_ptr<Law>()> make;
};

// MERLIN's own of 1998, Equalizer's DFR, Unreal's dynamic resolution, ParaView's two levels.
std::vector<NamedLaw> otherLaws();

}  // namespace merlin::bench
