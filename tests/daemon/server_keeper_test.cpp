// A server is optional for the wall: it is restarted after a failure, and its failure never ends
// the process.
#include "daemon/net/server_keeper.h"

#include <atomic>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "daemon/net/server_thread.h"
#include "tests/support/eventually.h"
#include "tests/support/told.h"

namespace merlin::net {
namespace {

using test::Sentences;
using test::told;

// A server that runs until the test sets `fails`.
class Failing final : public Server {
 public:
  Failing(ThreadWatch& threads, std::atomic<bool>& fails)
      : thread_(threads, "failing", [&fails] {
          if (fails.exchange(false)) throw std::runtime_error("no memory");
          std::this_thread::yield();
        }) {}
  ServerReport report() const override { return {}; }
  std::string failure() const override { return thread_.failure(); }

 private:
  ServerThread thread_;
};

TEST(Keeper, AServerWhoseThreadEndsIsStartedAgainAndTheProcessIsNotTold) {
  ThreadWatch threads;
  std::atomic<bool> fails = false;
  int starts = 0;
  ServerKeeper keeper("mouse", [&]() -> Result<std::unique_ptr<Server>> {
    ++starts;
    return std::unique_ptr<Server>(std::make_unique<Failing>(threads, fails));
  });
  Timestamp now{std::chrono::seconds(1000)};
  keeper.tend(now);
  EXPECT_EQ(told(keeper.takeEvents(now)), Sentences{"mouse: running"});
  fails = true;
  ASSERT_TRUE(test::eventually([&] {
    keeper.tend(now);
    return !keeper.health().failure.empty();
  }));
  EXPECT_EQ(told(keeper.takeEvents(now)),
            Sentences{"fault: mouse: failed (its thread ended: no memory); retried every 5 s"});
  EXPECT_TRUE(threads.threads().empty()) << "no thread is left, nor one that ended unasked";
  keeper.tend(now + std::chrono::milliseconds(4999));
  EXPECT_EQ(starts, 1);
  keeper.tend(now + std::chrono::seconds(5));
  EXPECT_EQ(starts, 2);
  EXPECT_EQ(keeper.health().failure, "");
}

TEST(Keeper, AServerThatCannotStartIsTriedEveryFiveSecondsAndToldOnce) {
  bool taken = true;
  ThreadWatch threads;
  std::atomic<bool> fails = false;
  ServerKeeper keeper("mouse", [&]() -> Result<std::unique_ptr<Server>> {
    if (taken) return Error{Errc::kBusy, "another program serves this socket"};
    return std::unique_ptr<Server>(std::make_unique<Failing>(threads, fails));
  });
  const Timestamp now{std::chrono::seconds(1000)};
  keeper.tend(now);
  EXPECT_EQ(told(keeper.takeEvents(now)),
            Sentences{"fault: mouse: failed (another program serves this socket); "
                      "retried every 5 s"});
  keeper.tend(now + std::chrono::seconds(5));
  EXPECT_TRUE(keeper.takeEvents(now).empty());
  taken = false;
  keeper.tend(now + std::chrono::seconds(9));
  EXPECT_EQ(keeper.health().failure, "another program serves this socket");
  keeper.tend(now + std::chrono::seconds(10));
  EXPECT_EQ(keeper.health().failure, "");
  EXPECT_EQ(told(keeper.takeEvents(now)), Sentences{"mouse: running"});
}

}  // namespace
}  // namespace merlin::net
