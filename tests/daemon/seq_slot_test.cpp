#include "daemon/shm/seq_slot.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "daemon/shm/channel.h"

namespace merlin::shm {
namespace {

// A value that is so large that a write takes long enough for a read to overlap it.
using Block = std::array<std::uint64_t, 512>;

Block filled(std::uint64_t n) {
  Block b;
  b.fill(n);
  return b;
}

bool uniform(const Block& b) {
  return std::all_of(b.begin(), b.end(), [&](auto w) { return w == b.front(); });
}

TEST(SeqSlot, IsEmptyUntilTheFirstPublish) {
  SeqSlot<Block> slot;
  EXPECT_FALSE(slot.read());
  slot.publish({1, 2, 3});
  EXPECT_EQ(slot.read(), (Block{1, 2, 3}));
}

TEST(SeqSlot, AReaderNeverSeesAMixOfTwoValues) {
  SeqSlot<Block> slot;
  std::atomic<int> reads{0};
  // The writer writes three times, then waits for a read. Most reads therefore overlap a write, and
  // none waits for ever.
  std::jthread writer([&](const std::stop_token& stop) {
    for (std::uint64_t n = 1; !stop.stop_requested(); ++n) {
      const int before = reads;
      slot.publish(filled(n));
      while (n % 3 == 0 && reads == before && !stop.stop_requested()) {
      }
    }
  });
  std::uint64_t last = 0;
  while (reads < 5'000) {
    const auto b = slot.read();
    if (!b) continue;
    ASSERT_TRUE(uniform(*b));
    ASSERT_GE(b->front(), last);  // values never go back
    last = b->front();
    ++reads;
  }
}

TEST(SeqSlot, AWriterThatDiedInTheMiddleIsNothingAndNoWait) {
  struct Torn {
    std::uint64_t sequence = 7;  // an odd number: a write that never ends
    std::uint64_t payload = 1;
  } torn;
  EXPECT_FALSE(reinterpret_cast<const SeqSlot<std::uint64_t>&>(torn).read());
}

// SharedMemory::mend() copies a segment while others write to it, so a slot in the copy may be
// torn.
TEST(SeqSlot, ACopyThatWasTakenDuringAWriteIsWholeWithTheNextOne) {
  struct Torn {
    std::uint64_t sequence = 7, payload = 1;
  } torn;
  auto& slot = reinterpret_cast<SeqSlot<std::uint64_t>&>(torn);
  slot.publish(2);
  EXPECT_EQ(slot.read(), 2u);
  slot.publish(3);
  EXPECT_EQ(slot.read(), 3u);
}

TEST(Channel, KeepsTheLast256AndSaysWhichAreGone) {
  auto channel = std::make_unique<Channel<std::uint64_t>>();
  for (std::uint64_t n = 0; n < 300; ++n) channel->publish(1000 + n);
  EXPECT_EQ(channel->count(), 300u);
  EXPECT_EQ(channel->newest(), 1299u);
  EXPECT_EQ(channel->at(299), 1299u);
  EXPECT_EQ(channel->at(45), 1045u);
  EXPECT_FALSE(channel->at(44));  // overwritten by value number 300
  EXPECT_FALSE(channel->at(300));
}

TEST(Channel, WakesAWaiterAtOnce) {
  Channel<std::uint64_t> channel;
  std::atomic<bool> woken{false};
  std::jthread waiter([&] {
    while (channel.count() == 0) channel.wait(0, {60, 0});
    woken = true;
  });
  channel.publish(1);
  waiter.join();  // join() would take a minute for each wait if publish() did not wake the waiter
  EXPECT_TRUE(woken);
}

TEST(Channel, ARingReadThatIsOvertakenIsNothing) {
  auto channel = std::make_unique<Channel<Block>>();
  std::jthread writer([&](const std::stop_token& stop) {
    for (std::uint64_t n = 0; !stop.stop_requested(); ++n) channel->publish(filled(n));
  });
  for (int reads = 0; reads < 2'000;) {
    const std::uint64_t count = channel->count();
    if (count < kHistory) continue;
    const std::uint64_t oldest = count - kHistory + 1;
    if (const auto b = channel->at(oldest)) {
      ASSERT_TRUE(uniform(*b));
      ASSERT_EQ(b->front(), oldest);
    }
    ++reads;
  }
}

}  // namespace
}  // namespace merlin::shm
