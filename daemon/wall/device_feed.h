// DeviceFeed: the input of the wall from the devices' segment, which this process or another one
// writes.
#pragma once

#include "daemon/actions/action_reader.h"
#include "daemon/base/clock.h"
#include "daemon/shm/segment.h"
#include "daemon/wall/input_feed.h"

namespace merlin::wall {

// Thread-bound. Never waits: the newest is read, what is not well is left out.
class DeviceFeed final : public InputFeed {
 public:
  // `ahead`: from a frame's begin until it is seen; the hand's pose is predicted to then.
  DeviceFeed(std::string segment_name, int hand_station, Duration stale_after,
             Duration ahead = Duration::zero())
      : devices_(std::move(segment_name)),
        hand_station_(hand_station),
        stale_after_(stale_after),
        ahead_(ahead) {}

  WallInput read(Timestamp now) override;
  Duration age() const noexcept override { return age_.value_or(Duration::zero()); }

 private:
  template <typename T>
  std::optional<T> fresh(const shm::Channel<T>& channel, const shm::SeqSlot<DeviceHealth>& health,
                         Timestamp now);
  void readPosture(const shm::DevicesSegment& devices, Timestamp now, WallInput& input);
  void readActions(const shm::DevicesSegment& devices, Timestamp now, WallInput& input);

  shm::SegmentFollower<shm::DevicesSegment> devices_;
  int hand_station_;
  Duration stale_after_;
  Duration ahead_;
  std::optional<Duration> age_;
  actions::ActionReader actions_;
};

}  // namespace merlin::wall
