#include "daemon/base/thread_team.h"

#include <chrono>
#include <system_error>

namespace merlin {
namespace {

constexpr std::chrono::microseconds kAwake{200};

// Waits until the value differs from `old` and returns it; spins for kAwake, then sleeps.
int awaitOther(const std::atomic<int>& value, int old) noexcept {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point until = Clock::now() + kAwake;
  for (;;) {
    const int now = value.load(std::memory_order_acquire);
    if (now != old) return now;
    if (Clock::now() < until)
      std::this_thread::yield();
    else
      value.wait(old, std::memory_order_acquire);
  }
}

}  // namespace

ThreadTeam::~ThreadTeam() {
  job_ = nullptr;
  ++turn_;
  turn_.notify_all();
}

ThreadTeam::Turn ThreadTeam::start(std::size_t members, const std::function<void()>& job) {
  try {
    while (members_.size() < members) {
      members_.emplace_back(
          [this, member = members_.size(), turn = turn_.load()] { work(member, turn); });
    }
  } catch (const std::system_error&) {  // thread limit reached: continue with the threads that run
  }
  job_ = &job;
  wanted_ = members;
  if (members == 0) return Turn(*this);  // no thread needs to wake
  busy_ = static_cast<int>(members_.size());
  ++turn_;
  turn_.notify_all();
  return Turn(*this);
}

void ThreadTeam::finish() noexcept {
  for (int left = busy_; left != 0;) left = awaitOther(busy_, left);
  job_ = nullptr;
}

void ThreadTeam::work(std::size_t member, int turn) noexcept {
  for (;;) {
    turn = awaitOther(turn_, turn);
    if (!job_) return;
    if (member < wanted_) (*job_)();
    if (--busy_ == 0) busy_.notify_one();
  }
}

}  // namespace merlin
