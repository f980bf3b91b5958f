// Attendance: determines whether somebody uses the wall; if nobody does, it runs the playlist. It
// also keeps the wall black or frozen, after the commands blank and freeze, until the next touch.
//
// A touch is anything by which a person acts on the wall: a push of the ball, a button, a finger
// that touches a touch surface, moves on it or leaves it, a turn of a mouse's wheel, a hand that
// moves while it holds an action, a command that changes what is shown. A finger that leaves ends
// the playlist, but does not undo blank and freeze.
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

// Thread-bound to the wall's thread, except for members whose comment says thread-safe.
class Attendance {
 public:
  explicit Attendance(const PlaylistSettings& playlist) : playlist_(playlist) {}

  // Thread-safe, like all functions up to nextOfPlaylist(); each takes effect with the next
  // update(). The first two show black or freeze the picture; a second call undoes this.
  void toggleBlank();
  void toggleFreeze();
  // Counts as a touch that also undoes blank and freeze. To be called when a command that changes
  // what is shown is executed.
  void touch();
  // Counts as a touch for the playlist only: ends it, but does not undo blank and freeze. To be
  // called when somebody uses the wall by other means than the devices' input.
  void attend();
  // See Playlist::on(), off() and next(). Beginning the playlist and its next content also undo
  // blank and freeze.
  void switchPlaylist(bool on);
  void nextOfPlaylist();

  // To be called once a frame with the devices' input. While the wall is black or frozen, the part
  // of `input` that moves the scene is removed; an input that ends this state moves the scene as
  // usual. While the playlist runs, the speed at which it turns the scene is set in `input`.
  // REQUIRES: `now` never decreases.
  struct Frame {
    Playlist::Wanted playlist;  // what the playlist wants; light is 0 while the wall is black
    bool held = false;          // black or frozen: nothing moves the scene
  };
  Frame update(WallInput& input, Timestamp now);

  // Replaces the playlist's settings: see Playlist::configure().
  void configure(const PlaylistSettings& playlist) { playlist_.configure(playlist); }

  using Shown = shm::WallInteraction::Shown;
  Shown shown() const noexcept;
  // Whether the picture is frozen; also true while the frozen picture is covered by black.
  bool isFrozen() const noexcept { return frozen_; }
  float light() const noexcept { return light_; }  // brightness as of the last update()
  Playlist::State playlist() const noexcept { return playlist_.state(); }
  // See Playlist::due(). While the wall is black or frozen, nothing is due, since no time passes
  // for the playlist then.
  Playlist::Due due() const noexcept;

  // While the wall is black or frozen, a motion, such as a push of the ball, ends this state only
  // after this time without motion, because a person who presses or releases a button of the ball
  // also pushes the ball.
  static constexpr Duration kPause = std::chrono::milliseconds(500);
  // Smallest motion of a hand that counts as a touch while the hand holds an action. It is greater
  // than the tracker's noise.
  static constexpr float kHandMoves_m = 0.02F;
  // Smallest motion of fingers that counts as a touch, in heights of the surface, or, for spreading
  // and turning, in the units of TouchMotion. It is greater than the noise of a finger at rest.
  static constexpr float kFingersMove = 0.005F;

 private:
  struct Asked {
    bool blank = false, freeze = false, touched = false, attended = false, next = false;
    std::optional<bool> playlist;  // true: on, false: off; nothing: not requested
  };
  Asked takeAsked(const WallInput& input, Timestamp now);
  struct Motion {
    bool touches = false;  // somebody acts, which ends the playlist
    bool wakes = false;    // somebody acts in a way that undoes blank and freeze
    bool lets_go = false;  // a finger leaves, or a button is released
  };
  Motion motionOf(const WallInput& input);
  bool isOfEndingTouch(const WallInput& input, Timestamp now);
  bool handMoves(const render::scene::SceneInput& input);
  Motion fingersMove(const render::scene::TouchMotion& touch);

  std::mutex mutex_;
  Asked asked_;  // guarded by mutex_: what was requested since the last update()
  Playlist playlist_;
  bool blank_ = false, frozen_ = false;
  float light_ = 1;
  std::optional<Timestamp> last_update_;
  std::optional<Timestamp> last_motion_;
  // State at the last frame: whether a hand held grab, fly and point_at; the pressed buttons of the
  // ball; and the position of the hand when its motion last counted as a touch.
  std::array<bool, 3> holding_{};
  std::uint32_t buttons_ = 0;
  std::array<float, 3> hand_m_{};
  // Number of fingers at the last frame, and their motion since it last counted as a touch.
  std::uint32_t fingers_ = 0;
  std::array<float, 4> fingers_moved_{};
  // Number of fingers that still touch since their gesture (pinch or spread) made the wall black or
  // frozen; 0 after another finger has touched.
  std::uint32_t of_gesture_ = 0;
  // State that the last touch has ended: see isOfEndingTouch().
  struct Ended {
    bool blank = false, frozen = false;
    std::uint32_t fingers = 0, buttons = 0;  // before the touch; all bits set: the touch is over
    Timestamp finger_last{}, button_last{};  // when a finger or button of the touch was last there
  };
  Ended ended_;
};

}  // namespace merlin::wall
