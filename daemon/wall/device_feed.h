// DeviceFeed: reads the wall's input from the shared-memory segment of the devices, which this
// process or another one writes. The slots of the devices are found by name when the segment is
// opened.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/actions/action_reader.h"
#include "daemon/base/clock.h"
#include "daemon/shm/segment.h"
#include "daemon/wall/input_feed.h"
#include "daemon/wall/turns.h"

namespace merlin::wall {

// Thread-bound. Never waits: it reads the newest samples and omits devices that do not work.
//
// Of several balls, the first one that is pushed counts, otherwise the first one. Of several hands,
// the one that holds an action acts, otherwise the first one. Of several touch surfaces, the one
// with the most fingers counts; the wheel of each mouse counts too. The actions of all devices
// count, but grab, fly and point_at only if they belong to the glove or the buttons of the acting
// hand. Of several people, only the input of the person who has the wall counts (Turns); other
// people's hands may still point.
class DeviceFeed final : public InputFeed {
 public:
  DeviceFeed(std::string segment_name, FeedSettings settings)
      : devices_(std::move(segment_name)), settings_(std::move(settings)), turns_(settings_.turn) {}

  WallInput read(Timestamp now) override;
  void lookAhead(Duration until_visible) override { until_visible_ = until_visible; }
  void configure(const FeedSettings& settings) override {
    settings_ = settings;
    turns_.setAfter(settings.turn);
  }
  void leaveOutBall(bool leaves_out) override { leaves_out_ball_ = leaves_out; }
  Duration age() const noexcept override { return age_.value_or(Duration::zero()); }

 private:
  // What all devices do at the time of a read().
  struct Acts {
    std::vector<std::optional<BallSample>> balls;     // index: DeviceSlots::balls
    std::vector<render::scene::TouchMotion> touches;  // index: DeviceSlots::touches
    actions::Actions actions;
  };
  template <typename T>
  std::optional<T> fresh(const shm::Channel<T>& channel, const shm::SeqSlot<DeviceHealth>& health,
                         Timestamp now);
  std::string personOf(const std::string& device) const;
  std::optional<TrackerSample> station(const shm::DeviceSlots& devices,
                                       const FollowedStation& place, Timestamp now);
  std::optional<BallSample> readBall(const shm::DeviceSlots::Ball& ball, Timestamp now);
  Acts readActs(const shm::DeviceSlots& devices, Timestamp now);
  bool counts(const std::string& device) const;
  void takeTurns(const shm::DeviceSlots& devices, const Acts& acts, Timestamp now);
  std::size_t handThatActs(const shm::DeviceSlots& devices, const actions::Actions& actions);
  std::optional<TrackerSample> predicted(const shm::DeviceSlots& devices, const FollowedHand& hand,
                                         Timestamp now);
  void readHand(const shm::DeviceSlots& devices, const actions::Actions& actions, Timestamp now,
                WallInput& input);
  void readPosture(const shm::DeviceSlots& devices, const std::string& glove, Timestamp now,
                   WallInput& input);
  void readTouches(const shm::DeviceSlots& devices, const Acts& acts,
                   render::scene::TouchMotion& used) const;
  void moveCorner(Duration since_last, bool held, WallInput& input) const;
  bool isOfAnotherHand(const shm::DeviceSlots& devices, const std::string& source) const;
  bool useActions(const shm::DeviceSlots& devices, const actions::Actions& actions,
                  WallInput& input);

  shm::SegmentFollower<shm::DevicesReader> devices_;
  FeedSettings settings_;
  Turns turns_;
  Duration until_visible_ = Duration::zero();
  std::optional<std::string> holder_;  // the person who has the wall; nothing: nobody
  std::size_t hand_ = 0;               // the hand that acted last, an index into settings_.hands
  bool other_hand_ = false;            // whether hand_ changed in the last read()
  bool moved_ = false;                 // whether grab or fly was held in the last read()
  bool leaves_out_ball_ = false;
  std::optional<Duration> age_;
  std::optional<Timestamp> last_read_;
  actions::ActionReader actions_;
  std::vector<render::scene::TouchFollower> touches_;  // index: DeviceSlots::touches
  std::uint64_t touches_of_ = 0;  // generation of the segment whose samples touches_ follow
};

}  // namespace merlin::wall
