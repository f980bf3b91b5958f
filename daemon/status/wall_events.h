// WallEvents: degradations and recoveries of the wall, and changes it made by itself, as sentences.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/event_kinds.h"
#include "daemon/shm/layout.h"

namespace merlin::status {

// Thread-bound.
class WallEvents {
 public:
  explicit WallEvents(const shm::WallSegment& segment) : segment_(segment) {}

  // The changes since the last call, such as "frame rate reduced to 15 of 30 Hz: ...".
  // Degradations and failures are faults.
  std::vector<Event> take();
  // The same for what the outputs were found to show, such as "output left is black instead of
  // ...". Outputs that have failed are left out, since take() reports them.
  std::vector<Event> takePictures();

 private:
  void takeOutputs(std::vector<Event>& events);

  const shm::WallSegment& segment_;
  std::uint32_t divisor_ = 1, scale_ = 1, operator_coarser_ = 0, held_ = 0, returned_ = 0;
  float asked_hz_ = 0;
  std::vector<std::string> faults_;    // of the outputs, by number; empty: it works
  std::vector<std::string> pictures_;  // what is wrong with theirs; empty: nothing
};

}  // namespace merlin::status
