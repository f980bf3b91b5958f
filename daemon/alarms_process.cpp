#include "daemon/alarms_process.h"

#include <algorithm>
#include <csignal>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

#include "daemon/alarms/alarm_queue.h"
#include "daemon/alarms/child_program.h"
#include "daemon/alarms/role_state.h"
#include "daemon/alarms/told_events.h"
#include "daemon/base/event_kinds.h"
#include "daemon/base/fixed_text.h"
#include "daemon/base/log.h"
#include "daemon/page/event_log.h"
#include "daemon/page/role_watch.h"
#include "daemon/role_signals.h"
#include "daemon/status/command_queue.h"
#include "daemon/wall/wall_contents.h"

namespace merlin {
namespace {

constexpr Duration kWatchdogPing = std::chrono::seconds(1);
// The events of a run's start are requested only if the run began less than this time ago.
constexpr Duration kStartIsNews = std::chrono::minutes(10);
constexpr const char* kTest = "this is a test, asked for by SIGUSR1";
constexpr Duration kAskAgain = std::chrono::seconds(3);
constexpr Duration kAnswerWithin = std::chrono::seconds(2);

// Whether the configuration has work for the role wall, or for the role devices, on this machine.
bool hasWall(const Settings& settings) {
  const auto contents = wall::contentsOf(settings.wall);
  return std::ranges::any_of(contents, [](const auto& entry) { return !entry.path.empty(); });
}
bool hasDevices(const Settings& settings) {
  const DevicesSettings& devices = settings.devices;
  const bool reads = std::ranges::any_of(
      devices.list, [](const auto& device) { return !device.line.port.empty(); });
  return reads || !devices.gpio.chip.empty() || !devices.projectors.empty();
}

const shm::Header& headerOf(const shm::WallSegment& segment) { return segment.header; }
const shm::Header& headerOf(const shm::DeviceSlots& slots) { return *slots.header; }

// Whether the sentence reports only that a device works.
bool saysThatItWorks(std::string_view sentence, const shm::DeviceSlots* devices) {
  if (!devices) return false;
  return std::ranges::any_of(devices->health, [&](const auto& device) {
    const auto health = device.slot->read();
    return health &&
           sentence == fmt::format("{}: ok ({})", device.device, textIn(health->identity));
  });
}

// Blocks SIGUSR1 instead of ignoring it as the other roles do, so that it stays pending until
// askedBySignal() takes it.
void waitForTests() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  ::signal(SIGUSR1, SIG_DFL);
}

using Tell = std::function<void(const alarms::AlarmEvent&)>;

// Follows one role of merlind across its restarts: reports when the role is missing, and requests
// the events that it published before it was followed.
template <typename Watch>
class FollowedRole {
 public:
  FollowedRole(const std::string& instance, const char* role, bool expected, Timestamp now,
               page::EventLog& events)
      : events_(events), watch_(instance, role, events), state_(role, expected, now) {}

  // Never waits. `tell` is called with each event in the role's answer to the command `events`.
  void update(Timestamp now, const Tell& tell) {
    watch_.update(now);
    if (const auto said = state_.update(watch_.generation(), now))
      events_.add("alarms", kRoleEvent.name, *said);
    askForStart(now, tell);
  }
  const auto* segment() const noexcept { return watch_.segment(); }

 private:
  // Requests the events of a newly started run twice. The second answer also has the events that
  // the role published after the first answer and before its events reach us by subscription.
  void askForStart(Timestamp now, const Tell& tell) {
    if (std::exchange(generation_, watch_.generation()) != watch_.generation()) {
      answers_due_ = isStarting(now) ? 2 : 0;
      ask_at_ = now;
    }
    if (answers_due_ > 0 && now >= ask_at_) {
      queue_.add({generation_, "events", "", now + kAnswerWithin});
      ask_at_ = now + kAskAgain;
    }
    queue_.update(watch_.commandEndpoint(), now, [&](std::uint64_t of, const auto& answer) {
      if (!answer || of != generation_) return;  // failed, or of an earlier run
      if (answers_due_ > 0) --answers_due_;
      for (const alarms::AlarmEvent& event : alarms::eventsOf(watch_.role(), *answer)) tell(event);
    });
  }
  bool isStarting(Timestamp now) const {
    return segment() && now - fromNanoseconds(headerOf(*segment()).started_ns) < kStartIsNews;
  }

  page::EventLog& events_;
  Watch watch_;
  alarms::RoleState state_;
  status::CommandQueue queue_;
  std::uint64_t generation_ = 0;
  int answers_due_ = 0;  // answers that the present run still has to give
  Timestamp ask_at_{};
};

// One alarm: its queue of events, and its program, which runs at most once at a time.
class Alarm {
 public:
  Alarm(const AlarmSettings& settings, std::string instance)
      : settings_(settings), instance_(std::move(instance)), queue_(settings) {}

  void add(const alarms::AlarmEvent& event) { queue_.add(event); }

  void tend(Timestamp now) {
    if (program_) {
      const auto ended = program_->ended(now);
      if (!ended) return;
      for (const std::string& line : program_->written())
        logInfo("the alarm {} wrote: {}", settings_.run.front(), line);
      if (!ended->empty()) logWarning("the alarm {} {}", settings_.run.front(), *ended);
      program_.reset();
    }
    const auto next = queue_.next(now);
    if (!next) return sayWhatWaits();
    logInfo("the alarm {} is told: {}", settings_.run.front(), next->event.what);
    auto started = alarms::ChildProgram::start(
        settings_.run, alarms::alarmText(instance_, next->event, next->left_out),
        now + fromSeconds(settings_.time_limit_s));
    if (started)
      program_.emplace(*std::move(started));
    else
      logWarning("an alarm's program was not started: {}", started.error().what);
  }

 private:
  // Logs that events wait, and again only after the queue was empty. REQUIRES: queue_.next() has
  // returned nothing.
  void sayWhatWaits() {
    const bool waits = queue_.waiting() > 0;
    if (waits && !told_that_some_wait_) {
      logWarning(
          "the alarm {} has been started as often as its setting most_per_hour ({}) allows; "
          "further events wait, and faults are told first",
          settings_.run.front(), settings_.most_per_hour);
    }
    told_that_some_wait_ = waits;
  }

  AlarmSettings settings_;
  std::string instance_;
  alarms::AlarmQueue queue_;
  bool told_that_some_wait_ = false;
  std::optional<alarms::ChildProgram> program_;
};

class AlarmsProcess {
 public:
  AlarmsProcess(const Settings& settings, Clock& clock)
      : clock_(clock),
        wall_(settings.instance, "wall", hasWall(settings), clock.now(), events_),
        devices_(settings.instance, "devices", hasDevices(settings), clock.now(), events_) {
    for (const AlarmSettings& alarm : settings.alarms)
      alarms_.emplace_back(alarm, settings.instance);
  }

  Asked run(const std::function<bool()>& is_valid) {
    ::sd_notify(0, "READY=1");
    logInfo("ready");
    Asked asked = Asked::kNothing;
    while (!ends(asked = askedBySignal(kSignalBeat, is_valid))) {
      if (asked == Asked::kTest) events_.add("alarms", alarms::kTestKind, kTest);
      const Timestamp now = clock_.now();
      tend(now);
      if (now - pinged_ < kWatchdogPing) continue;
      pinged_ = now;
      ::sd_notify(0, "WATCHDOG=1");
    }
    tellEnd(asked);
    return asked;
  }

 private:
  static bool ends(Asked asked) { return asked == Asked::kStop || asked == Asked::kStartAgain; }

  void tend(Timestamp now) {
    const Tell tell = [this](const alarms::AlarmEvent& event) { add(event); };
    wall_.update(now, tell);
    devices_.update(now, tell);
    for (const page::LoggedEvent& event : events_.after(seen_)) {
      seen_ = event.number;
      if (event.role == "page") continue;  // RoleWatch's report; RoleState waits before its own
      add({event.role, event.time_utc, event.kind, event.what, event.severity});
    }
    for (Alarm& alarm : alarms_) alarm.tend(now);
  }

  void add(const alarms::AlarmEvent& event) {
    if (!told_.take(event, saysThatItWorks(event.what, devices_.segment()))) return;
    for (Alarm& alarm : alarms_) alarm.add(event);
  }

  Clock& clock_;
  page::EventLog events_{1};
  FollowedRole<page::WallWatch> wall_;
  FollowedRole<page::DevicesWatch> devices_;
  std::vector<Alarm> alarms_;
  std::uint64_t seen_ = 0;  // number of the last event of events_ that was looked at
  alarms::ToldEvents told_;
  Timestamp pinged_{};
};

}  // namespace

Asked runAlarms(const Settings& settings, Clock& clock, const std::function<bool()>& is_valid) {
  waitForTests();
  return AlarmsProcess(settings, clock).run(is_valid);
}

}  // namespace merlin
