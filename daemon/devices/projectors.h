// Projectors: switches all projectors of the wall together, those at the panel's GPIO line and
// those that speak PJLink, on command and by a schedule.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"
#include "daemon/base/watched_thread.h"
#include "drivers/pjlink/projector_loop.h"
#include "drivers/pjlink/schedule.h"
#include "drivers/port/byte_stream.h"

namespace merlin::devices {

// A switching of all projectors by a person: the state, and the local time at which it was.
struct PersonsSwitch {
  bool on = false;
  pjlink::LocalMinute at = 0;
};

// Returns the present local time in minutes since 1970-01-01 00:00 of the local calendar, by the
// system's clock and time zone.
pjlink::LocalMinute localMinute();

class Projectors {
 public:
  // The functions and the clock that Projectors uses. `clock` must outlive this object.
  struct Parts {
    // Executes the command "projector_on" or "projector_off" at the panel's GPIO line; empty: no
    // line is configured. Must be thread-safe.
    std::function<Result<Ok>(const std::string& command)> panel;
    // Connects to a PJLink projector; called on the projector's thread.
    std::function<Result<std::unique_ptr<ByteStream>>(const TcpAddress&)> connect;
    std::function<pjlink::LocalMinute()> local_minute;
    Clock& clock;
  };
  // REQUIRES: the settings are valid, including the address of each projector.
  Projectors(const DevicesSettings& settings, Parts parts);

  // Restores the last switching by a person before merlind was restarted (nothing: there was none);
  // it stays in effect until the schedule's next switching point. `keep` is called for each further
  // switching by a person, on the thread that calls switchAll(). To be called before start() and
  // tend().
  void remember(std::optional<PersonsSwitch> last, std::function<void(const PersonsSwitch&)> keep);

  // Starts a thread for each PJLink projector and adds it to `threads`.
  void start(ThreadWatch& watch, std::vector<WatchedThread>& threads);

  // Switches all projectors at a person's request; this stays in effect until the schedule's next
  // switching point. Returns at once: the threads of the PJLink projectors switch them.
  // Thread-safe. Errors: if some projectors cannot be switched now, the message has the reason for
  // each of them; they are switched as soon as possible, and the others at once. The code is that
  // of the panel, e.g. kBusy (its projectors are cooling down or were just switched), or kIo if
  // only PJLink projectors cannot be switched.
  Result<Ok> switchAll(bool on);

  // Switches the projectors when the schedule requires it; the first call sets the state that is in
  // effect at that time, by the schedule or by a person's later switching (remember()). Repeats a
  // command that the panel refused once a second. To be called several times a second, always by
  // the same thread.
  void tend();

  // Makes one connection to each PJLink projector for which a connection is due. For tests without
  // threads.
  void round();

  // Returns when and how the schedule switches next; nothing if it never does. Thread-safe.
  std::optional<pjlink::Schedule::Switching> nextSwitching() const {
    return schedule_.next(parts_.local_minute());
  }

  // Returns the states of the PJLink projectors. Thread-safe.
  std::vector<pjlink::ProjectorState> states() const;

  // Returns the events since the last call, each a sentence such as "projector left: warming, ok"
  // or "projectors: switched off by the schedule". To be called by one thread only.
  std::vector<Event> takeEvents();

 private:
  struct Entry {
    std::unique_ptr<pjlink::ProjectorLoop> loop;
    Progress* progress = nullptr;  // set by its thread when that starts
    std::string name;
    std::string last;        // text of its last event
    bool was_fault = false;  // whether the last event was a fault
  };
  Entry& add(const PjlinkSettings& settings);
  Result<Ok> switchPanel(bool on);
  std::optional<bool> due();

  Parts parts_;
  std::vector<std::unique_ptr<Entry>> entries_;
  pjlink::Schedule schedule_;
  Timestamp panel_due_;
  std::function<void(const PersonsSwitch&)> keep_ = [](const PersonsSwitch&) {};
  bool follows_schedule_ = false;     // whether due() has applied the schedule before
  mutable std::mutex mutex_;          // guards all members below; held while the panel is switched
  std::optional<bool> panel_wanted_;  // state that the panel has not accepted yet
  std::optional<PersonsSwitch> by_person_;  // the last switching by a person
  std::vector<Event> notices_;
};

}  // namespace merlin::devices
