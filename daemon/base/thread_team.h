// ThreadTeam: a pool of threads for short work (0.5 ms) that comes many times a second. Starting or
// waking a thread takes 50 us, too long for that, so idle threads spin briefly.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace merlin {

// Used by one thread at a time, which passes the team to forBlocks() (blocks.h). The team's threads
// are started when first needed, with the affinity and priority of the thread that needs them. When
// idle they spin for 0.2 ms, then sleep.
class ThreadTeam {
 public:
  ThreadTeam() = default;
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  // Whether the team has no job. May be called by the thread that uses the team, or by the job.
  bool idle() const noexcept { return !job_; }

  // One job of the team; the destructor waits until all threads have finished it.
  class Turn {
   public:
    explicit Turn(ThreadTeam& team) : team_(team) {}
    ~Turn() { team_.finish(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    ThreadTeam& team_;
  };

  // Lets `members` threads call job() once each; fewer if the system's thread limit is reached.
  // `job` must not throw and must outlive the turn. REQUIRES: the team is idle.
  [[nodiscard]] Turn start(std::size_t members, const std::function<void()>& job);

 private:
  void finish() noexcept;
  void work(std::size_t member, int turn) noexcept;

  const std::function<void()>* job_ = nullptr;  // null: no job, or the threads must end
  std::size_t wanted_ = 0;
  std::atomic<int> turn_{0}, busy_{0};
  std::vector<std::jthread> members_;
};

}  // namespace merlin
