// PictureChecks: reads back what a wall's outputs show, one output at a time on a thread of its
// own, and compares it with what they were handed.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/watched_thread.h"
#include "daemon/shm/seq_slot.h"
#include "render/out/output.h"
#include "render/out/picture/picture_judge.h"

namespace merlin::render::out {

// The result of checking one output. A trivial type, so that a SeqSlot can hold it: initialise it
// with PictureState{}.
struct PictureState {
  PictureVerdict verdict;
  float took_ms;   // duration of the last check
  char says[112];  // what is wrong: "is black instead of what was meant, at HDMI-A-1"
};

class PictureChecks {
 public:
  struct Checked {
    Output* output = nullptr;  // outlives this
    Duration every{};          // time between two checks; 0: never checked
  };
  // `outputs`: in the order of their numbers. `clock` outlives this.
  PictureChecks(const std::vector<Checked>& outputs, const Clock& clock);

  // Starts the thread, unless nothing is to be checked. `watch` outlives this.
  void start(ThreadWatch& watch);
  void stop() { thread_.stop(); }

  // Records that output i is handed this picture. Called on the wall's thread; never waits. Cost:
  // digestOf().
  void meant(std::size_t i, const Signal& signal);
  // Returns true after output i was found to show something else, until the next meant() for it.
  // Thread-safe.
  bool wantsFrame(std::size_t i) const { return entries_[i].wants_frame.load(); }
  // Returns the result of the last check of output i. Thread-safe; never waits.
  PictureState state(std::size_t i) const {
    return entries_[i].state.read().value_or(PictureState{});
  }

  // Checks the output whose turn it is, if it is due. An output that was found to show something
  // else is checked every half second. After the second such result in a row its state is wrong,
  // and it is set up again, at most once every Checked::every. Returns when the next check is due;
  // nothing if no output is ever checked. Called by the thread, or by a test without one.
  std::optional<Timestamp> step();

 private:
  static constexpr std::size_t kRemembered = 16;  // frames
  struct Meant {
    std::int64_t handed_over_ns;
    PictureDigest digest;
  };
  struct Entry {
    Checked checked{};
    // Written by the wall's thread; `written` is the number of frames put into `slots` so far.
    PictureDigest last{};
    std::array<shm::SeqSlot<Meant>, kRemembered> slots{};
    std::atomic<std::uint64_t> written{0};
    // Used by the thread that checks; other threads use only the last two.
    Timestamp due{}, mend_at{};
    SteadyVerdict steady{};
    PictureState last_state{};
    std::map<std::string, PictureDigest> last_right{};  // last right digest of each display
    shm::SeqSlot<PictureState> state{};
    std::atomic<bool> wants_frame{false};
  };
  static std::vector<MeantPicture> meantOf(const Entry& entry);
  void check(Entry& entry);
  static PictureState judge(Entry& entry, const std::vector<DisplayReading>& readings,
                            Timestamp began);

  const Clock& clock_;
  std::deque<Entry> entries_;  // a deque, since an Entry cannot be moved
  std::mutex idle_mutex_;
  std::condition_variable_any idle_;
  WatchedThread thread_;
};

}  // namespace merlin::render::out
