// RoleFollower: follows a role of merlind in another process of this machine across its restarts:
// gives access to its segment, its topics and the address for its commands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/shm/segment.h"
#include "daemon/status/topic_follower.h"

namespace merlin::status {

// Thread-bound. `Reader`: shm::SegmentReader<shm::WallSegment> or shm::DevicesReader, instantiated
// in role_follower.cpp.
template <typename Reader>
class RoleFollower {
 public:
  // `role`: "wall" or "devices", of this instance of merlind. `from`: whose segments are trusted.
  RoleFollower(const std::string& instance, std::string role, std::vector<std::string> topics,
               SharedMemory::From from = SharedMemory::From::kOwnUserOrRoot);

  // Looks for the role, and connects to a new run of it; if connecting fails, it is tried again
  // every second. Returns true if a new run has begun or the role has ended; documents of the last
  // run are then out of date. Never waits.
  bool update(Timestamp now);

  const std::string& role() const noexcept { return role_; }
  // Returns the role's segment; null while the role does not run. Valid until the next update().
  const typename Reader::View* segment() const noexcept { return segment_; }
  // Returns the generation of the run that is followed; 0: none.
  std::uint64_t generation() const noexcept { return generation_; }
  // Returns the address at which the role takes commands; empty while it does not run here.
  const std::string& commandEndpoint() const noexcept { return command_endpoint_; }
  // Returns the next document that has arrived; nothing if there is none.
  std::optional<TopicFollower::Message> take() { return topics_.take(); }

 private:
  void connect(const std::string& endpoint);

  const std::string role_;
  shm::SegmentFollower<Reader> follower_;
  TopicFollower topics_;
  const typename Reader::View* segment_ = nullptr;
  std::uint64_t generation_ = 0;
  std::string command_endpoint_;
  Timestamp connected_{};  // when connect() was last called
  std::string fault_;      // why connect() failed last; empty: it succeeded
};

}  // namespace merlin::status
