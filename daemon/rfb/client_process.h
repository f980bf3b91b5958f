// The process that serves one client: it shows the picture, and sends the client's input to the
// wall as commands. Each client has a process of its own, because libvncserver blocks on a client
// that does not read, and because nothing that a client sends may affect another one.
#pragma once

#include "daemon/base/clock.h"
#include "daemon/rfb/settings.h"

namespace merlin::rfb {

// A byte in the pipe to the parent process.
enum class Report : char {
  kEstablished = 'e',  // the handshake is complete
  kActive = 'a'        // the client waits for the next picture; at most once a second
};

// Exit statuses of the process, besides those of daemon/cli/exit_status.h.
inline constexpr int kClientLeft = 0, kWrongPassword = 10;

// Time limits: handshakeLimit_s() for the handshake, during which a person may have to type the
// password; kMessageLimit_s for each message after it. When a limit is exceeded, SIGALRM ends the
// process.
constexpr unsigned handshakeLimit_s(const RfbSettings& settings) {
  return settings.password.empty() ? 10 : 60;
}
inline constexpr unsigned kMessageLimit_s = 120;

// Serves the client on the socket `client` until it leaves, and closes the socket; `report`: the
// pipe to the parent. Returns the exit status. Sets limits for the calling process, so it must be
// called in a process of its own.
int serveClient(const RfbSettings& settings, int client, int report);

}  // namespace merlin::rfb
