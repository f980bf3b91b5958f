#include "daemon/base/handover.h"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace merlin {
namespace {

TEST(Handover, TheNewestOfferIsTakenOnce) {
  Handover<std::vector<int>> handover;
  std::vector<int> mine = {1};
  EXPECT_FALSE(handover.take(mine));
  handover.offer({2});
  handover.offer({3});
  EXPECT_TRUE(handover.take(mine, [](const auto& before, auto& fresh) {
    fresh.insert(fresh.begin(), before.begin(), before.end());
  }));
  EXPECT_EQ(mine, (std::vector<int>{1, 3}));
  EXPECT_FALSE(handover.take(mine));
}

// The offering thread frees the values that were returned; the leak sanitizer would detect a lost
// value.
TEST(Handover, BetweenThreadsNothingIsTornOrLost) {
  constexpr int kOffers = 20'000;
  Handover<std::vector<int>> handover;
  std::thread taker([&] {
    std::vector<int> mine(3, 0);
    while (mine[0] != kOffers) {
      const int before = mine[0];
      if (!handover.take(mine)) continue;
      EXPECT_GT(mine[0], before);
      EXPECT_TRUE(mine[0] == mine[1] && mine[1] == mine[2]);
    }
  });
  for (int i = 1; i <= kOffers; ++i) handover.offer(std::vector<int>(3, i));
  taker.join();
}

}  // namespace
}  // namespace merlin
