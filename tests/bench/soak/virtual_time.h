// Virtual time for code that blocks: its threads are fibers of one thread, which run one at a time,
// in the order of the times that they wait for. So hours pass as fast as the work that is done in
// them, and each run with the same seeds is the same.
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

  // Runs all fibers until virtual time `end`, or until all have returned. Not within a fiber.
  void runUntil(Timestamp end);

  // Within a fiber: others run until then. Those that wait for the same time run in the order in
  // which they began to wait.
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
  Fiber* current_ = nullptr;  // null: none runs
  std::vector<std::unique_ptr<Fiber>> all_;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
};

// The clock of everything that runs in fibers. sleepUntil() only within one.
class VirtualClock final : public Clock {
 public:
  explicit VirtualClock(Fibers& fibers) : fibers_(fibers) {}
  Timestamp now() const noexcept override { return fibers_.now(); }
  bool sleepUntil(Timestamp when, const std::stop_token& stop) noexcept override;

 private:
  Fibers& fibers_;
};

}  // namespace merlin::bench
