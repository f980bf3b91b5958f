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

  // Returns an event for each change since the last call, such as "frame rate reduced to 15 of 30
  // Hz: ...". Only the failure of an output is a fault; a reduced rate or detail is news.
  std::vector<Event> take();
  // Returns an event for each change of what an output was found to show when it was read back,
  // such as "output left is black instead of ..."; a wrong picture is a fault. take() reports
  // outputs that have failed.
  std::vector<Event> takePictures();

 private:
  void takeOutputs(std::vector<Event>& events);

  const shm::WallSegment& segment_;
  std::uint32_t divisor_ = 1, scale_ = 1, operator_coarser_ = 0, held_ = 0, returned_ = 0;
  float asked_hz_ = 0;
  std::vector<std::string> faults_;    // fault of each output; empty: it works
  std::vector<std::string> pictures_;  // what is wrong with each output's picture; empty: nothing
};

}  // namespace merlin::status
