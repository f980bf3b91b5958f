// Attendance: whether somebody uses the wall, and what it shows otherwise: the playlist. Maintains
// the effect of the commands blank and freeze until the next input.
//
// A touch is anything by which a visitor or an operator acts on the wall: a push of the ball, a
// button, a finger that comes to a touch surface, moves on it or leaves it, a turn of a mouse's
// wheel, a hand that moves while it holds an action, a command that changes what is shown. A finger
// that leaves is one to the playlist only: it does not undo blank and freeze.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>

#include "daemon/base/clock.h"
#include "daemon/shm/layout.h"
#include "daemon/wall/input_feed.h"
#include "daemon/wall/playlist.h"

namespace merlin::wall {

// Thread-bound to the wall's thread, except where it says thread-safe.
class Attendance {
 public:
  explicit Attendance(const PlaylistSettings& playlist) : playlist_(playlist) {}

  // Each is thread-safe and takes effect with the next update().
  // Shows black, or freezes the picture; a second call undoes it.
  void toggleBlank();
  void toggleFreeze();
  // To be called when a command that changes what is shown is executed; undoes both.
  void touch();
  // To be called when somebody uses the wall by other means than the devices' input; ends the
  // playlist.
  void attend();
  // See Playlist.
  void switchPlaylist(bool on);
  void nextOfPlaylist();

  // To be called once a frame, with the devices' input. REQUIRES: `now` never decreases. While the
  // wall is black or frozen, the part of `input` that moves the scene is removed; the input that
  // ends this state moves the scene as usual. While the playlist runs, it turns the scene.
  struct Frame {
    Playlist::Wanted playlist;  // its light is 0 while the wall is black
    bool held = false;          // black or frozen: nothing moves the scene
  };
  Frame update(WallInput& input, Timestamp now);

  // Replaces the playlist's settings: see Playlist.
  void configure(const PlaylistSettings& playlist) { playlist_.configure(playlist); }

  using Shown = shm::WallInteraction::Shown;
  Shown shown() const noexcept;
  // Whether the picture is to stay as it is; also true while black covers it.
  bool isFrozen() const noexcept { return frozen_; }
  float light() const noexcept { return light_; }  // as of the last update()
  Playlist::State playlist() const noexcept { return playlist_.state(); }
  // Nothing is due while the wall is black or frozen, since then no time passes for the playlist.
  Playlist::Due due() const noexcept;

  // A motion, such as a push of the ball, is a new touch only after this time without motion,
  // because whoever presses or releases a button of the ball also pushes the ball.
  static constexpr Duration kPause = std::chrono::milliseconds(500);
  // Least motion of a hand that is a touch while the hand holds an action; above the tracker's
  // noise.
  static constexpr float kHandMoves_m = 0.02F;
  // The same for fingers, above the noise of a finger at rest: in heights of the surface; for
  // spreading and turning, in the units of TouchMotion.
  static constexpr float kFingersMove = 0.005F;

 private:
  struct Asked {
    bool blank = false, freeze = false, touched = false, attended = false, next = false;
    std::optional<bool> playlist;  // on or off
  };
  Asked takeAsked(const WallInput& input, Timestamp now);
  struct Motion {
    bool touches = false;  // somebody acts
    bool wakes = false;    // in a way that undoes blank and freeze
    bool lets_go = false;  // a finger goes, or a button is released
  };
  Motion motionOf(const WallInput& input);
  bool isOfEndingTouch(const WallInput& input, Timestamp now);
  bool handMoves(const render::scene::SceneInput& input);
  Motion fingersMove(const render::scene::TouchMotion& touch);

  std::mutex mutex_;
  Asked asked_;  // guarded by mutex_: since the last update()
  Playlist playlist_;
  bool blank_ = false, frozen_ = false;
  float light_ = 1;
  std::optional<Timestamp> last_update_;
  std::optional<Timestamp> last_motion_;
  // At the last frame: actions held by a hand and pressed buttons; the hand's position when its
  // motion last counted.
  std::array<bool, 3> holding_{};
  std::uint32_t buttons_ = 0;
  std::array<float, 3> hand_m_{};
  // Number of fingers at the last frame, and their movement since a motion last counted.
  std::uint32_t fingers_ = 0;
  std::array<float, 4> fingers_moved_{};
  // Of the fingers that touched while their bound gesture made the wall black or frozen, those that
  // have not gone since; 0 once another one has come.
  std::uint32_t of_gesture_ = 0;
  // What the last touch has ended: see isOfEndingTouch().
  struct Ended {
    bool blank = false, frozen = false;
    std::uint32_t fingers = 0, buttons = 0;  // there before it; all bits: those that came are gone
    Timestamp finger_last{}, button_last{};  // when one that came with it was there last
  };
  Ended ended_;
};

}  // namespace merlin::wall
