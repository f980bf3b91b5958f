// DevicesRole: the devices of a configuration, each on its own thread, into shared memory.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/devices/posture_sink.h"
#include "daemon/shm/segment.h"
#include "daemon/shm/shm_sink.h"
#include "drivers/loop/device_loop.h"
#include "drivers/registry.h"

namespace merlin::devices {

class DevicesRole {
 public:
  // Makes the segment; nothing runs yet. Errors: kBusy (a living daemon has the segment), kIo; what
  // is wrong with the posture network's file.
  static Result<std::unique_ptr<DevicesRole>> make(const Settings& settings,
                                                   std::uint64_t generation,
                                                   const shm::Endpoints& endpoints, Clock& clock);
  ~DevicesRole();  // stops and joins the device threads
  DevicesRole(const DevicesRole&) = delete;
  DevicesRole& operator=(const DevicesRole&) = delete;

  // Starts a thread for each device that has a port. Real-time priority where the system allows it.
  void start();

  void beat(Timestamp now) const { segment_.beat(now); }
  const shm::DevicesSegment& segment() const { return *segment_; }

 private:
  DevicesRole(shm::SegmentWriter<shm::DevicesSegment> segment, Clock& clock);
  Result<Ok> add(const LineSettings& line, SampleKind kind, shm::DeviceIndex index,
                 const Settings& settings);

  shm::SegmentWriter<shm::DevicesSegment> segment_;
  Clock& clock_;
  shm::ShmSink sink_;
  std::unique_ptr<PostureSink> posture_sink_;
  std::vector<std::unique_ptr<shm::ShmHealthSink>> health_;
  std::vector<std::unique_ptr<DeviceLoop>> loops_;
  std::vector<std::jthread> threads_;
};

}  // namespace merlin::devices
