#include "daemon/alarms_process.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

#include "daemon/alarms/alarm_queue.h"
#include "daemon/alarms/child_program.h"
#include "daemon/base/event_kinds.h"
#include "daemon/base/log.h"
#include "daemon/page/event_log.h"
#include "daemon/page/role_watch.h"
#include "daemon/stop_asked.h"

namespace merlin {
namespace {

constexpr Duration kBeat = std::chrono::milliseconds(100);
constexpr Duration kWatchdogPing = std::chrono::seconds(1);
// A merlind reads large models and compiles shaders before it runs.
constexpr Duration kFirstStart = std::chrono::minutes(3);
// A role that is back within this time was restarted, and nobody is told.
constexpr Duration kRestart = std::chrono::seconds(15);

// Tells that a role ended, and that it is back. A role that has never run is not missed.
class RoleState {
 public:
  explicit RoleState(std::string role) : role_(std::move(role)) {}

  std::optional<std::string> update(bool running, Timestamp now) {
    if (running) {
      last_ran_ = now;
      if (!std::exchange(missing_, false)) return std::nullopt;
      return fmt::format("the role {} runs again", role_);
    }
    if (!last_ran_ || missing_ || now - *last_ran_ < kRestart) return std::nullopt;
    missing_ = true;
    return fmt::format("the role {} has not run for {:.0f} s", role_, toSeconds(kRestart));
  }

 private:
  std::string role_;
  std::optional<Timestamp> last_ran_;
  bool missing_ = false;
};

// One alarm: its events and its program, of which one runs at a time.
class Alarm {
 public:
  Alarm(const AlarmSettings& settings, std::string instance)
      : settings_(settings), instance_(std::move(instance)), queue_(settings) {}

  void add(const alarms::AlarmEvent& event) { queue_.add(event); }

  void tend(Timestamp now) {
    if (program_) {
      const auto ended = program_->ended(now);
      if (!ended) return;
      if (!ended->empty()) logWarning("the alarm {} {}", settings_.run.front(), *ended);
      program_.reset();
    }
    const auto next = queue_.next(now);
    if (!next) return;
    logInfo("the alarm {} is told: {}", settings_.run.front(), next->event.what);
    auto started = alarms::ChildProgram::start(
        settings_.run, alarms::alarmText(instance_, next->event, next->left_out),
        now + fromSeconds(settings_.time_limit_s));
    if (started)
      program_.emplace(*std::move(started));
    else
      logWarning("the alarm {}", started.error().what);
  }

 private:
  AlarmSettings settings_;
  std::string instance_;
  alarms::AlarmQueue queue_;
  std::optional<alarms::ChildProgram> program_;
};

class AlarmsProcess {
 public:
  AlarmsProcess(const Settings& settings, Clock& clock)
      : clock_(clock),
        wall_(settings.instance, "wall", events_),
        devices_(settings.instance, "devices", events_) {
    for (const AlarmSettings& alarm : settings.alarms)
      alarms_.emplace_back(alarm, settings.instance);
  }

  void run() {
    ::sd_notify(0, "READY=1");
    logInfo("ready");
    while (!stopAsked(kBeat, "alarms")) {
      const Timestamp now = clock_.now();
      tend(now);
      if (now - pinged_ < kWatchdogPing) continue;
      pinged_ = now;
      ::sd_notify(0, "WATCHDOG=1");
    }
    ::sd_notify(0, "STOPPING=1");
    logInfo("stopping");
  }

 private:
  void tend(Timestamp now) {
    wall_.update(now);
    devices_.update(now);
    watchRoles(now);
    for (const page::LoggedEvent& event : events_.after(told_)) {
      told_ = event.number;
      if (event.role == "page") continue;  // what the watches say of roles: RoleState is patient
      for (Alarm& alarm : alarms_) alarm.add({event.role, event.time_utc, event.kind, event.what});
    }
    for (Alarm& alarm : alarms_) alarm.tend(now);
  }

  void watchRoles(Timestamp now) {
    const auto add = [&](const std::optional<std::string>& said) {
      if (said) events_.add("alarms", kRoleEvent.name, *said);
    };
    add(wall_state_.update(wall_.isRunning(), now));
    add(devices_state_.update(devices_.isRunning(), now));
    if (wall_.isRunning() || devices_.isRunning()) any_ran_ = true;
    if (any_ran_ || now - started_ < kFirstStart) return;
    any_ran_ = true;  // told once
    add(fmt::format("no merlind has run since the alarms were started {:.0f} s ago",
                    toSeconds(kFirstStart)));
  }

  Clock& clock_;
  Timestamp started_ = clock_.now();
  bool any_ran_ = false;  // a role has run, or it was told that none has
  page::EventLog events_{1};
  page::WallWatch wall_;
  page::DevicesWatch devices_;
  RoleState wall_state_{"wall"}, devices_state_{"devices"};
  std::vector<Alarm> alarms_;
  std::uint64_t told_ = 0;  // number of the last event that the alarms were told
  Timestamp pinged_{};
};

}  // namespace

Result<Ok> runAlarms(const Settings& settings, Clock& clock) {
  AlarmsProcess(settings, clock).run();
  return Ok{};
}

}  // namespace merlin
