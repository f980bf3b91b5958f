// ThreadTeam: threads that stay for work in many short turns. A thread that has just been started,
// or wakes up, comes 50 us late, which is too late for work of 0.5 ms.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace merlin {

// Belongs to the thread that makes it, until it goes; forBlocks() finds it there. Its members are
// started when they are first needed, with that thread's affinity and priority. They wait on their
// processors for 0.2 ms, then asleep.
class ThreadTeam {
 public:
  ThreadTeam() noexcept;
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  // The calling thread's latest; null where there is none, or it is at work.
  static ThreadTeam* idle() noexcept;

  // Ends once all members have ended what they do.
  class Turn {
   public:
    explicit Turn(ThreadTeam& team) : team_(team) {}
    ~Turn() { team_.finish(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    ThreadTeam& team_;
  };

  // Has `members` threads call job() once each, or fewer where the system has no more of them. It
  // must not throw, and outlive the turn. REQUIRES: the team is idle, and the caller's.
  [[nodiscard]] Turn start(std::size_t members, const std::function<void()>& job);

 private:
  void finish() noexcept;
  void work(std::size_t member, int turn) noexcept;

  ThreadTeam* const outer_;
  const std::function<void()>* job_ = nullptr;  // null in a new turn: the end
  std::size_t wanted_ = 0;
  std::atomic<int> turn_{0}, busy_{0};
  std::vector<std::jthread> members_;
};

}  // namespace merlin
