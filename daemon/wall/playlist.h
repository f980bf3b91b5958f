// Playlist: decides what the wall shows while nobody touches it: contents in turn, slowly turning,
// and dimmed after some time. Pure: the elapsed time and touches are passed in.
#pragma once

#include <cstdint>

#include "daemon/base/clock.h"
#include "daemon/wall/settings.h"

namespace merlin::wall {

// Thread-bound. The caller decides which content is the next one; the slides of one content may
// follow each other.
class Playlist {
 public:
  explicit Playlist(const PlaylistSettings& settings) : settings_(settings) {}

  // kOff: the playlist does not begin by itself. kWaiting: it begins after_s after the last touch.
  // kRunning: it runs.
  enum class State : std::uint32_t { kOff = 0, kWaiting = 1, kRunning = 2 };
  State state() const noexcept;

  // Replaces the settings. A running playlist continues, and the time that has passed still counts.
  void configure(const PlaylistSettings& settings) { settings_ = settings; }

  // Times in seconds from the last update() until the playlist begins, shows its next content, and
  // dims the picture if nobody touches the wall. Negative: this will not happen.
  struct Due {
    double begins_s = -1, next_s = -1, dims_s = -1;
  };
  Due due() const noexcept;

  // on(): the next update() begins the playlist if it does not run. off(): the playlist ends, and
  // neither the playlist nor dimming begins by itself until on(). next(): the next update() returns
  // Wanted::next, whether the playlist runs or not.
  void on() noexcept;
  void off() noexcept;
  void next() noexcept;

  struct Wanted {
    bool begins = false;   // it begins with this frame, from the content's initial view
    bool next = false;     // show the playlist's next content, from its initial view
    float turn_rad_s = 0;  // speed at which the scene turns
    float light = 1;       // brightness, as a share of the full light
  };
  // To be called once a frame. `elapsed`: time since the last call. `touched`: somebody has touched
  // the wall since the last call, which ends the playlist and dimming.
  Wanted update(Duration elapsed, bool touched) noexcept;

  // Time in which the picture becomes darker. After a touch it becomes bright again at once.
  static constexpr Duration kDimming = std::chrono::seconds(3);

 private:
  float light() const noexcept;

  PlaylistSettings settings_;
  bool enabled_ = true;  // false from off() until on()
  bool starting_ = false, running_ = false, next_ = false;
  Duration idle_{};   // time since the last touch
  Duration shown_{};  // how long the content has been shown while the playlist runs
};

}  // namespace merlin::wall
