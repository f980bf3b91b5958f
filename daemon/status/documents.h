// The JSON documents that MERLIN publishes: what the segments say, for programs. Names and units
// are a contract (README.md); a name is only ever added.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/net/server_keeper.h"
#include "daemon/shm/layout.h"

namespace merlin::status {

// Topic "status": how the devices are, and the posture. About 1 kB.
std::string devicesStatus(const shm::DevicesSegment& segment, Timestamp now,
                          const std::vector<net::ServerHealth>& servers = {});
// Topic "status": how the wall fares; with it `remote`, devices of another machine that it shows.
std::string wallStatus(const shm::WallSegment& segment, Timestamp now,
                       const std::vector<net::ServerHealth>& servers = {},
                       const shm::DevicesSegment* remote = nullptr);
// Topic "sample": the newest posture, glove, hand, tracker and ball.
std::string newestSamples(const shm::DevicesSegment& segment, Timestamp now);
// Topic "metrics": counters and gauges of either, flat, as a metrics collector wants them.
std::string devicesMetrics(const shm::DevicesSegment& segment);
std::string wallMetrics(const shm::WallSegment& segment);
// Topic "event": one thing that happened. `kind` is a word, `what` a sentence.
std::string event(std::string_view kind, std::string_view what, Timestamp now);

// A list of texts, as a command's reply.
std::string textList(const std::vector<std::string>& texts);

// "absent", "opening", "ok", "failed"; also "stale" where a health was not written for a second.
const char* healthName(const DeviceHealth& health, Timestamp now);

inline constexpr const char* kDeviceNames[] = {"glove", "tracker", "ball"};

}  // namespace merlin::status
