// DeviceFeed: what the scene is told of the devices, from their segment, in this process or
// another.
#pragma once

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

  render::SceneInput read(Timestamp now) override;
  Duration age() const noexcept override { return age_.value_or(Duration::zero()); }

 private:
  template <typename T>
  std::optional<T> fresh(const shm::Channel<T>& channel, const shm::SeqSlot<DeviceHealth>& health,
                         Timestamp now);

  shm::SegmentFollower<shm::DevicesSegment> devices_;
  int hand_station_;
  Duration stale_after_;
  Duration ahead_;
  std::optional<Duration> age_;
};

}  // namespace merlin::wall
