// InputFeed: port (an interface) that reads the devices' input to the wall. Implemented by
// DeviceFeed and by a fake in tests.
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

// The input of one frame.
struct WallInput {
  render::scene::SceneInput scene;
  std::optional<TrackerSample> head;  // sample of the station on the viewer's head
  // How often each of these actions was requested since the last read().
  std::uint32_t next_content = 0, previous_content = 0, snapshot = 0, blank = 0, freeze = 0;
  std::uint32_t operator_panel = 0;
  bool panel_pushed = false;  // whether a push of the ball operates the operator's panel
  AlignInput align;
  std::array<char, 20> posture{};  // name of the current posture, NUL-terminated; empty: none
  bool by_fingers = false;         // whether fingers requested blank or freeze
};

// A station of a tracker whose samples are followed.
struct FollowedStation {
  std::string tracker;  // name of the tracker; empty: the first one
  int station = 0;      // 1 to 4; 0: none
};

// A device and the person to whom it belongs. People take turns: see Turns.
struct OwnedDevice {
  std::string device, person;
};

struct FollowedHand {
  std::string name, person;
  std::string glove;  // name of the glove that the hand wears; empty: the first one
  FollowedStation place;
  std::string buttons = {};  // name of the ball whose buttons the hand holds; empty: none
};

// Settings that say how the devices' input is read.
struct FeedSettings {
  std::vector<FollowedHand> hands;
  std::vector<OwnedDevice> devices;  // devices that are not listed belong to the person ""
  FollowedStation head;              // station on the viewer's head
  // Age from which on a sample of a tracker or a glove is no longer used; also the time after which
  // the samples of a device that does not work are no longer used.
  Duration stale_after{};
  // The time after a person's last action until other people's input counts again.
  Duration turn{};
};

// Thread-bound to the wall's thread.
class InputFeed {
 public:
  virtual ~InputFeed() = default;

  // Returns the newest input of the devices that work, and the actions since the last call. Never
  // waits.
  virtual WallInput read(Timestamp now) = 0;

  // Sets the time from the start of a frame until the frame is visible. From the next read() on,
  // the poses of hands are predicted for that time. Zero, the initial value: they are not
  // predicted.
  virtual void lookAhead(Duration until_visible) { static_cast<void>(until_visible); }

  // Replaces the settings from the next read() on.
  virtual void configure(const FeedSettings& settings) { static_cast<void>(settings); }

  // Sets whether the actions of the balls' buttons are ignored from the next read() on, except
  // operator_panel.
  virtual void leaveOutBall(bool leaves_out) { static_cast<void>(leaves_out); }

  // Returns the age that the newest sample had at the last read(); zero if there was no sample.
  virtual Duration age() const noexcept = 0;
};

}  // namespace merlin::wall
