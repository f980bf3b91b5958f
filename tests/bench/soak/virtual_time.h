// Virtual time for code that blocks. The threads of that code become fibers of one thread. One
// fiber runs at a time, in the order of the times for which the fibers wait. Hours therefore pass
// as fast as the computation in them, and runs with the same seeds are equal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <queue>
#include <vector>

#include "daemon/base/clock.h"

namespace merlin::bench {

// Thread-bound. Each fiber has a stack of its own of 1 MiB.
class Fibers {
 public:
  Fibers();
  ~Fibers();  // REQUIRES: every body has returned
  Fibers(const Fibers&) = delete;
  Fibers& operator=(const Fibers&) = delete;

  // Adds a fiber, which begins at the present time. `body` must not throw.
  void start(std::function<void()> body);

  // Runs all fibers until virtual time `end`, or until all have returned. REQUIRES: the caller is
  // not a fiber.
  void runUntil(Timestamp end);

  // Lets other fibers run until virtual time `when`. Fibers that wait for the same time continue in
  // the order in which they began to wait. REQUIRES: the caller is a fiber.
  void waitUntil(Timestamp when);

  Timestamp now() const noexcept { return now_; }
  bool finished() const noexcept { return waiting_.empty(); }

 private:
  struct Fiber;
  struct Waiting {
    Timestamp when;
    std::uint64_t order;
    Fiber* fiber;
    bool operator>(const Waiting& other) const {
      return when != other.when ? when > other.when : order > other.order;
    }
  };
  static void enter(unsigned high, unsigned low);

  Timestamp now_{std::chrono::seconds(1000)}, end_{};
  std::uint64_t order_ = 0;
  std::unique_ptr<Fiber> main_;
  Fiber* current_ = nullptr;  // null: no fiber is running
  std::vector<std::unique_ptr<Fiber>> all_;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
};

// The clock of all code that runs in fibers. Only a fiber may call sleepUntil().
class VirtualClock final : public Clock {
 public:
  explicit VirtualClock(Fibers& fibers) : fibers_(fibers) {}
  Timestamp now() const noexcept override { return fibers_.now(); }
  bool sleepUntil(Timestamp when, const std::stop_token& stop) noexcept override;

 private:
  Fibers& fibers_;
};

}  // namespace merlin::bench
