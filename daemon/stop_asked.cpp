#include "daemon/stop_asked.h"

#include <csignal>
#include <ctime>

#include "daemon/base/log.h"

namespace merlin {

bool stopAsked(Duration wait, const char* role) {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int s : {SIGTERM, SIGINT, SIGHUP}) ::sigaddset(&set, s);
  const timespec limit{0, wait.count()};
  const int signal = ::sigtimedwait(&set, nullptr, &limit);
  if (signal == SIGHUP)
    logInfo("SIGHUP is ignored: the role {} reads a changed configuration when it is restarted",
            role);
  return signal == SIGTERM || signal == SIGINT;
}

}  // namespace merlin
