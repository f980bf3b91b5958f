// SampleWaker: makes a descriptor readable when a sample comes, so that a server waits for its
// clients and for samples at once: shared memory's words can be waited on, but not polled with
// sockets.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/unique_fd.h"
#include "daemon/base/watched_thread.h"

namespace merlin::serve {

// Has a thread of its own. Costs a second wake-up a sample, some 20 us.
class SampleWaker {
 public:
  // `words`: of shm::Channel; they outlive this, as `watch` does.
  SampleWaker(std::vector<const std::atomic<std::uint32_t>*> words, ThreadWatch& watch,
              const std::string& name);
  ~SampleWaker();
  SampleWaker(const SampleWaker&) = delete;
  SampleWaker& operator=(const SampleWaker&) = delete;

  // Readable since the last clear() where a sample has come.
  int fd() const noexcept { return event_.get(); }
  // Before the samples are read: one that comes meanwhile makes it readable again.
  void clear() const noexcept;

 private:
  void run(const std::stop_token& stop, Progress& progress) const;

  std::vector<const std::atomic<std::uint32_t>*> words_;
  UniqueFd event_;
  WatchedThread thread_;
};

}  // namespace merlin::serve
