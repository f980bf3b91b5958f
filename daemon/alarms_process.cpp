#include "daemon/alarms_process.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

#include "daemon/alarms/alarm_queue.h"
#include "daemon/alarms/child_program.h"
#include "daemon/alarms/role_state.h"
#include "daemon/base/event_kinds.h"
#include "daemon/base/log.h"
#include "daemon/page/event_log.h"
#include "daemon/page/role_watch.h"
#include "daemon/stop_asked.h"
#include "daemon/wall/wall_contents.h"

namespace merlin {
namespace {

constexpr Duration kBeat = std::chrono::milliseconds(100);
constexpr Duration kWatchdogPing = std::chrono::seconds(1);

// Whether a process of this role has something to do on this machine.
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
        devices_(settings.instance, "devices", events_),
        wall_state_("wall", hasWall(settings), clock.now()),
        devices_state_("devices", hasDevices(settings), clock.now()) {
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
    add(wall_state_.update(wall_.generation(), now));
    add(devices_state_.update(devices_.generation(), now));
  }

  Clock& clock_;
  page::EventLog events_{1};
  page::WallWatch wall_;
  page::DevicesWatch devices_;
  alarms::RoleState wall_state_, devices_state_;
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
