// SampleWaker: makes a descriptor readable when a sample arrives. So a server can poll its clients
// and the samples together, although the futex words in shared memory cannot be polled with
// sockets.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/unique_fd.h"
#include "daemon/base/watched_thread.h"

namespace merlin::serve {

// Has its own thread. Cost: a second wake-up per sample, about 20 us.
class SampleWaker {
 public:
  // `words`: wake words of shm::Channel. They and `watch` must outlive this.
  SampleWaker(std::vector<const std::atomic<std::uint32_t>*> words, ThreadWatch& watch,
              const std::string& name);
  ~SampleWaker();
  SampleWaker(const SampleWaker&) = delete;
  SampleWaker& operator=(const SampleWaker&) = delete;

  // Returns the descriptor, which is readable if a sample has arrived since the last clear().
  int fd() const noexcept { return event_.get(); }
  // To be called before the samples are read: a later sample then makes it readable again.
  void clear() const noexcept;

 private:
  void run(const std::stop_token& stop, Progress& progress) const;

  std::vector<const std::atomic<std::uint32_t>*> words_;
  UniqueFd event_;
  WatchedThread thread_;
};

}  // namespace merlin::serve
