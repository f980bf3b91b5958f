// Port (an interface): reads the devices' input to the wall. Implemented by DeviceFeed and by a
// fake in tests.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/wall/aligner.h"
#include "render/scene/scene.h"

namespace merlin::wall {

// Input of one frame.
struct WallInput {
  render::scene::SceneInput scene;
  std::optional<TrackerSample> head;  // sample of the tracker station on the viewer's head
  // How often each was requested since the last read.
  std::uint32_t next_content = 0, previous_content = 0, snapshot = 0, blank = 0, freeze = 0;
  std::uint32_t operator_panel = 0;
  bool panel_pushed = false;  // the ball is pushed, on the operator's panel
  AlignInput align;
  std::array<char, 20> posture{};  // name of the current posture, NUL-terminated; empty: none
  bool by_fingers = false;         // fingers on a touch surface requested blank or freeze
};

// A station of a tracker.
struct FollowedStation {
  std::string tracker;  // its name; empty: the first tracker
  int station = 0;      // 1 to 4; 0: none
};

// The person to whom a device belongs, since people take turns.
struct OwnedDevice {
  std::string device, person;
};

struct FollowedHand {
  std::string name, person;
  std::string glove;  // name of the glove whose postures are the hand's; empty: the first glove
  FollowedStation place;
  std::string buttons = {};  // name of the ball whose buttons the hand holds; empty: none
};

// How the devices' input is read.
struct FeedSettings {
  std::vector<FollowedHand> hands;
  std::vector<OwnedDevice> devices;  // those that are not listed are of the person ""
  FollowedStation head;              // on the viewer's head
  // Age at which samples of tracker and glove count as missing.
  Duration stale_after{};
  // While a person acts, and this long after, other people's input does not count.
  Duration turn{};
};

// Thread-bound to the wall's thread.
class InputFeed {
 public:
  virtual ~InputFeed() = default;

  // Reads the newest input of every device that works; never waits.
  virtual WallInput read(Timestamp now) = 0;

  // Sets the time from the start of a frame until it is visible, from the next read() on: poses of
  // hands are predicted for then. Zero, as at the start: they are not predicted.
  virtual void lookAhead(Duration until_visible) { static_cast<void>(until_visible); }

  // Replaces the settings, from the next read() on.
  virtual void configure(const FeedSettings& settings) { static_cast<void>(settings); }

  // Whether actions of the balls' buttons are left out from the next read() on, except
  // operator_panel.
  virtual void leaveOutBall(bool leaves_out) { static_cast<void>(leaves_out); }

  // Age of the newest sample that the last read() returned; zero if there was none.
  virtual Duration age() const noexcept = 0;
};

}  // namespace merlin::wall
