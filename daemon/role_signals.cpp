#include "daemon/role_signals.h"

#include <csignal>
#include <cstdint>
#include <ctime>

#include <systemd/sd-daemon.h>

#include "daemon/base/log.h"

namespace merlin {

Duration watchdogInterval() {
  std::uint64_t usec = 0;
  return ::sd_watchdog_enabled(0, &usec) > 0 ? Duration(std::chrono::microseconds(usec / 2))
                                             : Duration{};
}

Asked askedBySignal(Duration wait, const std::function<bool()>& is_valid) {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int s : {SIGTERM, SIGINT, SIGHUP, SIGUSR1}) ::sigaddset(&set, s);
  const timespec limit{0, wait.count()};
  const int signal = ::sigtimedwait(&set, nullptr, &limit);
  if (signal == SIGTERM || signal == SIGINT) return Asked::kStop;
  if (signal == SIGUSR1) return Asked::kTest;
  return signal == SIGHUP && is_valid() ? Asked::kStartAgain : Asked::kNothing;
}

void tellEnd(Asked asked) {
  const bool stops = asked != Asked::kStartAgain;
  if (stops) ::sd_notify(0, "STOPPING=1");
  logInfo("{}", stops ? "stopping" : "starting again");
}

}  // namespace merlin
