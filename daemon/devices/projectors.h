// Projectors: all projectors of the wall, those at the panel's GPIO line and those that speak
// PJLink; commands and the schedule switch them together.
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

// A switching of all projectors by a person, and when it was.
struct PersonsSwitch {
  bool on = false;
  pjlink::LocalMinute at = 0;
};

// The minute that the local calendar shows now, by the system's clock and time zone.
pjlink::LocalMinute localMinute();

class Projectors {
 public:
  // What it switches and reads; all must outlive this object.
  struct Parts {
    // Executes "projector_on" or "projector_off" at the panel's line; empty: no line is configured.
    // Thread-safe.
    std::function<Result<Ok>(const std::string& command)> panel;
    // Connects to a projector; called on its thread.
    std::function<Result<std::unique_ptr<ByteStream>>(const TcpAddress&)> connect;
    std::function<pjlink::LocalMinute()> local_minute;
    Clock& clock;
  };
  // REQUIRES: the settings' faults have been found; every address is valid.
  Projectors(const DevicesSettings& settings, Parts parts);

  // Restores the last switching by a person before merlind was restarted, which stays in force
  // until the schedule's next switching point. `keep` is called with each further switching by a
  // person, on the thread that calls switchAll(). To be called before start() and tend().
  void remember(std::optional<PersonsSwitch> last, std::function<void(const PersonsSwitch&)> keep);

  // Adds a thread for each PJLink projector.
  void start(ThreadWatch& watch, std::vector<WatchedThread>& threads);

  // Switches all projectors for a person; this stays in force until the schedule's next switching
  // point. Returns at once: PJLink projectors are switched by their threads. Thread-safe. Errors: a
  // sentence for each projector that cannot be switched now, with the reason; it is switched as
  // soon as it can be, and the others are switched anyway. kBusy: the panel's projectors are
  // cooling down or were just switched. kIo: otherwise.
  Result<Ok> switchAll(bool on);

  // Follows the schedule, which is applied at once by the first call; once a second, repeats a
  // command that the panel refused. To be called by one thread, several times a second.
  void tend();

  // Makes one connection to each PJLink projector for which one is due. For tests without threads.
  void round();

  // When the schedule switches next. Thread-safe.
  std::optional<pjlink::Schedule::Switching> nextSwitching() const {
    return schedule_.next(parts_.local_minute());
  }

  // The PJLink projectors. Thread-safe.
  std::vector<pjlink::ProjectorState> states() const;

  // What has happened since the last call, a sentence each: "projector left: warming, ok",
  // "projectors: switched off by the schedule". For one thread.
  std::vector<Event> takeEvents();

 private:
  struct Entry {
    std::unique_ptr<pjlink::ProjectorLoop> loop;
    Progress* progress = nullptr;  // set when its thread starts
    std::string name;
    std::string last;        // its last event
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
  bool follows_schedule_ = false;           // since the first tend() with a schedule
  mutable std::mutex mutex_;                // guards all below; held while the panel is switched
  std::optional<bool> panel_wanted_;        // the state that the panel has refused so far
  std::optional<PersonsSwitch> by_person_;  // the last switching by a person
  std::vector<Event> notices_;
};

}  // namespace merlin::devices
