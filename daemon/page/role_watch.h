// RoleWatch: follows what one role of merlind publishes, across restarts of the role.
#pragma once

#include <string>

#include "daemon/base/clock.h"
#include "daemon/page/event_log.h"
#include "daemon/shm/segment.h"
#include "daemon/status/role_follower.h"

namespace merlin::page {

// Thread-bound. `Reader`: shm::SegmentReader<shm::WallSegment> or shm::DevicesReader, instantiated
// in role_watch.cpp.
template <typename Reader>
class RoleWatch {
 public:
  // `role`: "wall" or "devices", of this instance of merlind. `events` must outlive this.
  RoleWatch(const std::string& instance, std::string role, EventLog& events);

  // Takes the documents that have arrived, and adds events to the log: those of the role, and that
  // the role runs, has restarted or has ended. Never waits; takes a microsecond if nothing has
  // arrived.
  void update(Timestamp now);

  const std::string& role() const noexcept { return follower_.role(); }
  bool isRunning() const noexcept { return segment() != nullptr; }
  // Returns the generation of the run that is followed; 0: none.
  std::uint64_t generation() const noexcept { return follower_.generation(); }
  // Returns the role's segment; null while the role does not run. Valid until the next update().
  const typename Reader::View* segment() const noexcept { return follower_.segment(); }
  // Return the newest document of the topic "status" or "metrics", a JSON object; empty while there
  // is none.
  const std::string& status() const noexcept { return status_; }
  const std::string& metrics() const noexcept { return metrics_; }
  // Returns the address at which the role takes commands; empty while it does not run here.
  const std::string& commandEndpoint() const noexcept { return follower_.commandEndpoint(); }
  // Returns when status() arrived; meaningless while status() is empty.
  Timestamp heard() const noexcept { return heard_; }

 private:
  void take(const status::TopicFollower::Message& message, Timestamp now);

  EventLog& events_;
  status::RoleFollower<Reader> follower_;
  bool told_ = false;
  std::string status_, metrics_;
  Timestamp heard_{};
};

using WallWatch = RoleWatch<shm::SegmentReader<shm::WallSegment>>;
using DevicesWatch = RoleWatch<shm::DevicesReader>;

}  // namespace merlin::page
