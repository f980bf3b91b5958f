// RemoteDevices: offers another machine's devices in shared memory of this machine, for its wall
// and its programs, which read them like the segment of local devices.
#pragma once

#include <memory>
#include <string>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/shm/segment.h"
#include "daemon/status/sample_link.h"
#include "daemon/status/services.h"

namespace merlin {

// To be used by the main thread; any thread may read slots().
class RemoteDevices {
 public:
  // Creates the segment, and connects to /wall/input/endpoint unless this process may not use the
  // network, which is reported to `services`. Errors: kBusy (a running daemon owns the segment),
  // kIo, those of status::readKeyPair() and SampleLink::start(). `threads` and `clock` must outlive
  // the object.
  static Result<std::unique_ptr<RemoteDevices>> make(const Settings& settings,
                                                     std::uint64_t generation,
                                                     status::Services& services,
                                                     ThreadWatch& threads, const Clock& clock);

  const shm::DeviceSlots& slots() const { return slots_; }
  void writeHeartbeat(Timestamp now) const { segment_.writeHeartbeat(now); }
  Result<std::string> mend() { return segment_.mend(); }  // SegmentWriter::mend()

 private:
  RemoteDevices(shm::SegmentWriter<shm::DevicesSegment> segment, shm::DeviceSlots slots)
      : segment_(std::move(segment)), slots_(std::move(slots)) {}

  shm::SegmentWriter<shm::DevicesSegment> segment_;
  shm::DeviceSlots slots_;                    // of segment_
  std::unique_ptr<status::SampleLink> link_;  // writes into segment_; null without a network
};

}  // namespace merlin
