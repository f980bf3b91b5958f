// Orders: what a person asks by hand of others than the scene: the frame as a file, the panel's
// lamp. The wall counts them in its shared memory; here they are done, off the wall's thread.
#pragma once

#include <functional>
#include <string>

#include "daemon/shm/segment.h"

namespace merlin::wall {

// Thread-bound. The wall may be another process of the same configuration.
class Orders {
 public:
  // What this process can do; the others are empty. The lamp's is a command of the panel.
  struct Doers {
    std::function<void()> snapshot;
    std::function<void(const std::string& command)> lamp;
  };

  // `segment`: the wall's, as "/merlin-wall".
  Orders(std::string segment, Doers doers) : wall_(std::move(segment)), doers_(std::move(doers)) {}

  // Does what was asked since the last time, each thing once; of lamps the last.
  void poll(Timestamp now);

 private:
  shm::SegmentFollower<shm::WallSegment> wall_;
  Doers doers_;
  std::uint64_t generation_ = 0;  // of the wall whose orders were seen last
  shm::WallInteraction seen_{};
};

}  // namespace merlin::wall
