// DeviceFeed: reads the wall's input from the shared-memory segment of the devices, which this
// process or another one writes. The devices' slots are found by name when the segment is opened.
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

// Thread-bound. Never waits: reads the newest samples and omits devices that do not work.
//
// Among several balls the one that is pushed counts, among several hands the one that holds an
// action, otherwise the first of each; among several touch surfaces the one that is touched, and
// each mouse's wheel. The actions of all devices count, but only the hand that acts grabs, flies
// and points by its glove and by the buttons that it holds. Among several people, only the input of
// the one who has the wall counts (Turns); the hands of the others may still point.
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
  // What the devices of one person do now.
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
  std::optional<std::string> holder_;  // who has the wall
  std::size_t hand_ = 0;               // the hand that acted last: index of settings_.hands
  bool other_hand_ = false;            // hand_ changed at the last read
  bool moved_ = false;                 // something was grabbed, or flown, at the last read
  bool leaves_out_ball_ = false;
  std::optional<Duration> age_;
  std::optional<Timestamp> last_read_;
  actions::ActionReader actions_;
  std::vector<render::scene::TouchFollower> touches_;  // index: DeviceSlots::touches
  std::uint64_t touches_of_ = 0;  // generation of the devices' process that touches_ follow
};

}  // namespace merlin::wall
