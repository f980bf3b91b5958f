// DeviceFeed: reads the wall's input from the shared-memory segment of the devices, which this
// process or another one writes. The devices' slots are found by name when the segment is opened.
#pragma once

#include "daemon/actions/action_reader.h"
#include "daemon/base/clock.h"
#include "daemon/shm/segment.h"
#include "daemon/wall/input_feed.h"

namespace merlin::wall {

// Thread-bound. Never waits: reads the newest samples and omits devices that do not work.
class DeviceFeed final : public InputFeed {
 public:
  // `ahead`: time from a frame's begin until it is visible; the hand's pose is predicted for that
  // time. `stale_after`: age at which samples of tracker and glove count as missing.
  // `head_station`: the tracker station on the viewer's head; 0: none.
  DeviceFeed(std::string segment_name, int hand_station, Duration stale_after,
             Duration ahead = Duration::zero(), int head_station = 0)
      : devices_(std::move(segment_name)),
        hand_station_(hand_station),
        head_station_(head_station),
        stale_after_(stale_after),
        ahead_(ahead) {}

  WallInput read(Timestamp now) override;
  void configure(const FeedSettings& settings) override {
    hand_station_ = settings.hand_station;
    stale_after_ = settings.stale_after;
    ahead_ = settings.ahead;
  }
  void leaveOutBall(bool leaves_out) override { leaves_out_ball_ = leaves_out; }
  Duration age() const noexcept override { return age_.value_or(Duration::zero()); }

 private:
  template <typename T>
  std::optional<T> fresh(const shm::Channel<T>& channel, const shm::SeqSlot<DeviceHealth>& health,
                         Timestamp now);
  std::optional<TrackerSample> station(const shm::DeviceSlots& devices, int number, Timestamp now);
  void readPosture(const shm::DeviceSlots& devices, Timestamp now, WallInput& input);
  void moveCorner(Duration since_last, bool held, WallInput& input) const;
  bool readActions(const shm::DeviceSlots& devices, Timestamp now, WallInput& input);

  shm::SegmentFollower<shm::DevicesReader> devices_;
  int hand_station_, head_station_;
  Duration stale_after_;
  Duration ahead_;
  bool leaves_out_ball_ = false;
  std::optional<Duration> age_;
  std::optional<Timestamp> last_read_;
  actions::ActionReader actions_;
};

}  // namespace merlin::wall
