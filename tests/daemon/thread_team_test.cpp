// Parallel loops over blocks, with a persistent team of threads and without one.
#include "daemon/base/thread_team.h"

#include <algorithm>
#include <atomic>
#include <barrier>
#include <functional>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/blocks.h"

namespace merlin {
namespace {

const auto keepGoing = [](std::size_t) { return true; };

// Each test runs with a team and without one.
class ForBlocks : public testing::TestWithParam<bool> {
 protected:
  Threads threads(unsigned n) { return GetParam() ? Threads(n, team_) : Threads(n); }

 private:
  ThreadTeam team_;
};
INSTANTIATE_TEST_SUITE_P(Team, ForBlocks, testing::Bool(),
                         [](const auto& test) { return test.param ? "Stays" : "IsNone"; });

TEST_P(ForBlocks, AreDoneOnceEachAndWhatTheyThrowComesOut) {
  for (const unsigned n : {1u, 5u, 2u}) {
    std::vector<int> calls(1000);
    EXPECT_TRUE(forBlocks(
        threads(n), 1000, [&](std::size_t block) { ++calls[block]; }, keepGoing));
    EXPECT_EQ(calls, std::vector<int>(1000, 1));
    const auto throwing = [](std::size_t block) {
      if (block == 500) throw std::runtime_error("500");
    };
    EXPECT_THROW(forBlocks(threads(n), 1000, throwing, keepGoing), std::runtime_error);
  }
}

TEST_P(ForBlocks, EndBeforeWhatIsThrownBetweenThemComesOut) {
  std::vector<int> calls(100);
  const auto work = [&](std::size_t block) { ++calls[block]; };
  const auto thrower = [](std::size_t) -> bool { throw std::runtime_error("stop"); };
  EXPECT_THROW(forBlocks(threads(3), 100, work, thrower), std::runtime_error);
  const std::vector<int> then = calls;
  EXPECT_TRUE(forBlocks(threads(3), 100, work));
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(calls[i], then[i] + 1);
}

TEST_P(ForBlocks, MayHaveBlocksOfTheirOwn) {
  std::atomic<int> calls{0};
  EXPECT_TRUE(forBlocks(threads(3), 4, [&](std::size_t) {
    forBlocks(threads(2), 5, [&](std::size_t) { ++calls; });
  }));
  EXPECT_EQ(calls, 20);
}

thread_local int turns_of_this = 0;

// Runs loops in which every thread waits for all others, so that each thread handles one block of
// each loop. Returns the smallest number of blocks that a thread of the last loop has handled in
// all loops.
int fewestTurns(Threads threads, int turns) {
  std::vector<int> of(threads.count);
  turns_of_this = 0;
  for (int turn = 0; turn < turns; ++turn) {
    std::barrier all(threads.count);
    forBlocks(threads, threads.count, [&](std::size_t block) {
      all.arrive_and_wait();
      of[block] = ++turns_of_this;
    });
  }
  return *std::min_element(of.begin(), of.end());
}

TEST(ThreadTeam, Stays) {
  ThreadTeam team;
  EXPECT_EQ(fewestTurns({3, team}, 50), 50);
  EXPECT_EQ(fewestTurns({4, team}, 50), 50);
}

TEST(ThreadTeam, HasAsManyAtWorkAsIsSaid) {
  ThreadTeam team;
  for (const std::size_t members : {3U, 1U, 0U, 2U}) {
    std::atomic<std::size_t> calls{0};
    const std::function<void()> job = [&] { ++calls; };
    {
      const ThreadTeam::Turn turn = team.start(members, job);
      EXPECT_FALSE(team.idle());
    }
    EXPECT_EQ(calls, members);
    EXPECT_TRUE(team.idle());
  }
}

TEST(ThreadTeam, WithoutOneEachLoopStartsThreadsOfItsOwn) { EXPECT_EQ(fewestTurns(3, 50), 1); }

}  // namespace
}  // namespace merlin
