// DevicesBeside: connects the wall's process to the role devices in another process of this
// machine: passes it the commands of the operator's panel, and follows the state of its projectors.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/shm/segment.h"
#include "daemon/status/command_queue.h"
#include "daemon/status/role_follower.h"
#include "daemon/wall/operator_panel.h"

namespace merlin {

class DevicesBeside {
 public:
  explicit DevicesBeside(const std::string& instance);

  // Queues the command; update() sends queued commands one after another. Thread-safe. Errors:
  // kBusy (too many commands wait).
  Result<Ok> send(const std::string& command, Timestamp now);

  // Sends queued commands, and receives answers and status documents, without waiting. Calls
  // `refused` with the reason for each command that was not executed. To be called ten times a
  // second, always by the same thread.
  void update(Timestamp now, const std::function<void(const std::string& why)>& refused);

  // Returns the projectors in the newest status document; none while the role devices does not run.
  // To be called on the thread of update().
  const std::vector<wall::ProjectorsSeen>& projectors() const noexcept { return projectors_; }

 private:
  status::RoleFollower<shm::DevicesReader> devices_;
  std::vector<wall::ProjectorsSeen> projectors_;
  std::mutex mutex_;  // guards commands_
  status::CommandQueue commands_;
};

}  // namespace merlin
