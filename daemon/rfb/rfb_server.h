// RfbServer: listens for VNC clients until it is told to stop.
#pragma once

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"
#include "daemon/rfb/settings.h"

namespace merlin::rfb {

// Thread-bound; the process must have no other thread, since it forks.
class RfbServer {
 public:
  // Errors: kBusy (another program listens at the port), kInvalidArgument (see validate()),
  // kUnsupported, kIo.
  static Result<RfbServer> make(const RfbSettings& settings);

  // Serves clients until `stop` is readable; then disconnects all.
  Result<Ok> run(const UniqueFd& stop);

  int port() const;  // the port at which it listens, even if the settings have 0

 private:
  RfbServer(RfbSettings settings, UniqueFd listener)
      : settings_(std::move(settings)), listener_(std::move(listener)) {}

  RfbSettings settings_;
  UniqueFd listener_;
};

}  // namespace merlin::rfb
