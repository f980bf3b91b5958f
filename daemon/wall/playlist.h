// Playlist: what the wall shows while nobody touches it: contents in turn, slowly turning, and
// dimmed after some time. Pure: the time that passes and touches are passed in.
#pragma once

#include <cstdint>

#include "daemon/base/clock.h"
#include "daemon/wall/settings.h"

namespace merlin::wall {

// Thread-bound. The caller decides which contents are shown; one place may have several parts
// (slides).
class Playlist {
 public:
  explicit Playlist(const PlaylistSettings& settings) : settings_(settings) {}

  // kOff: it does not begin by itself. kWaiting: it begins after_s after the last touch.
  enum class State : std::uint32_t { kOff = 0, kWaiting = 1, kRunning = 2 };
  State state() const noexcept;

  // Replaces the settings; a running playlist goes on, and the time that has passed counts.
  void configure(const PlaylistSettings& settings) { settings_ = settings; }

  // When the next thing will happen if nobody touches the wall, in seconds from the last update();
  // negative: not at all.
  struct Due {
    double begins_s = -1, next_s = -1, dims_s = -1;
  };
  Due due() const noexcept;

  // on(): begins at once, with the next update(), if it does not run. off(): ends, and neither it
  // nor dimming begins by itself until on(). next(): the next update() wants the next content,
  // whether it runs or not.
  void on() noexcept;
  void off() noexcept;
  void next() noexcept;

  struct Wanted {
    bool begins = false;   // it begins with this frame: from the content's initial view
    bool next = false;     // the next content of the playlist, from its initial view
    float turn_rad_s = 0;  // see turn_deg_per_s of the settings
    float light = 1;       // share of the full light
  };
  // To be called once a frame. `elapsed`: time since the last frame. A touch ends it.
  Wanted update(Duration elapsed, bool touched) noexcept;

  // Time in which the picture becomes darker; it becomes bright again at once.
  static constexpr Duration kDimming = std::chrono::seconds(3);

 private:
  float light() const noexcept;

  PlaylistSettings settings_;
  bool enabled_ = true;  // not switched off by off()
  bool starting_ = false, running_ = false, next_ = false;
  Duration idle_{};   // since the last touch
  Duration shown_{};  // since the content is shown, while it runs
};

}  // namespace merlin::wall
