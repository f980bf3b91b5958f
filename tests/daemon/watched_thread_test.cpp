#include "daemon/base/watched_thread.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include <gtest/gtest.h>

#include "daemon/base/token_bucket.h"
#include "tests/support/eventually.h"
#include "tests/support/temp_dir.h"

namespace merlin {
namespace {

void untilStopped(const std::stop_token& stop, Progress& progress) {
  while (!stop.stop_requested()) {
    progress.step();
    std::this_thread::yield();
  }
}

TEST(WatchedThread, IsKnownByNameWhileItRunsAndItsProgressGrows) {
  ThreadWatch watch;
  {
    const WatchedThread thread(watch, "a server", untilStopped);
    ASSERT_EQ(watch.threads().size(), 1U);
    EXPECT_EQ(watch.threads()[0].name, "a server");
    const auto before = watch.threads()[0].progress;
    EXPECT_TRUE(test::eventually([&] { return watch.threads()[0].progress > before; }));
    EXPECT_FALSE(watch.threads()[0].ended);
    EXPECT_TRUE(test::eventually([] {
      const std::filesystem::directory_iterator all("/proc/self/task");
      return std::any_of(begin(all), end(all), [](const auto& task) {
        return test::readText(task.path() / "comm") == "a server\n";
      });
    })) << "top -H shows it";
  }
  EXPECT_TRUE(watch.threads().empty()) << "stopped as it was asked to";
}

TEST(WatchedThread, OneThatEndsByItselfIsSeenWithTheReason) {
  ThreadWatch watch;
  const WatchedThread thrower(watch, "thrower", [](const std::stop_token&, Progress&) {
    throw std::runtime_error("no memory");
  });
  const WatchedThread leaver(watch, "leaver", [](const std::stop_token&, Progress&) {});
  ASSERT_TRUE(test::eventually([&] {
    const auto threads = watch.threads();
    return threads[0].ended && threads[1].ended;
  }));
  EXPECT_EQ(watch.threads()[0].reason, "no memory");
  EXPECT_EQ(watch.threads()[1].reason, "returned without having been asked to stop");
}

TEST(TokenBucket, GivesItsBurstAndThenItsRate) {
  TokenBucket bucket(10, 3);
  const Timestamp t0{std::chrono::seconds(1000)};
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(bucket.take(1, t0));
  EXPECT_FALSE(bucket.take(1, t0));
  EXPECT_NEAR(toSeconds(bucket.waitFor(1, t0)), 0.1, 1e-6);
  EXPECT_TRUE(bucket.take(1, t0 + std::chrono::milliseconds(101)));
  EXPECT_FALSE(bucket.take(1, t0 + std::chrono::milliseconds(102)));
  EXPECT_NEAR(bucket.available(t0 + std::chrono::hours(1)), 3, 1e-9) << "no more than its burst";
}

TEST(TokenBucket, ADebtIsWaitedFor) {
  TokenBucket bucket(10, 3);
  const Timestamp t0{std::chrono::seconds(1000)};
  bucket.charge(13, t0);
  EXPECT_NEAR(toSeconds(bucket.waitFor(1, t0)), 1.1, 1e-6);
  EXPECT_EQ(bucket.waitFor(1, t0 + std::chrono::seconds(2)), Duration::zero());
}

}  // namespace
}  // namespace merlin
