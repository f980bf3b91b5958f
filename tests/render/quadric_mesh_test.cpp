// Parts of QuadricReducer that can be tested alone: the queue, and the storage of stars.
#include "render/reduce/quadric/quadric_mesh.h"

#include <new>
#include <set>

#include <gtest/gtest.h>

#include "render/reduce/quadric/bucket_queue.h"

namespace merlin::render {
namespace {

TEST(BucketQueue, JoinedIsBothByCost) {
  std::vector<std::uint32_t> links(6);
  const auto next = [&](std::uint32_t v) -> std::uint32_t& { return links[v]; };
  reduce::BucketQueue queue, other;
  queue.push(0, 1.0F, next);
  queue.push(1, 100.0F, next);
  other.push(2, 0.5F, next);
  other.push(3, 100.0F, next);  // two entries in one bucket
  other.push(4, 100.0F, next);
  other.push(5, 10.0F, next);
  queue.join(std::move(other), next);
  std::vector<std::uint32_t> order;
  for (std::uint32_t v;
       (v = queue.pop(reduce::BucketQueue::buckets(), next)) != reduce::BucketQueue::kNone;)
    order.push_back(v);
  EXPECT_EQ(order, (std::vector<std::uint32_t>{2, 0, 5, 4, 3, 1}));
}

TEST(StarRoom, NoTwoHaveTheSameLines) {
  reduce::FreshLines fresh;
  fresh.reset(800, 800 + (1 << 15));
  reduce::StarRoom a(fresh), b(fresh);
  std::set<std::uint32_t> lines;
  std::uint32_t taken = 0;
  for (std::uint32_t corners = 1; corners <= 50; ++corners) {
    for (reduce::StarRoom* room : {&a, &b}) {
      std::uint32_t capacity = 0;
      const std::uint32_t star = room->take(corners, capacity);
      ASSERT_GE(capacity, corners);
      for (std::uint32_t line = star; line < star + capacity; line += reduce::kLine)
        lines.insert(line);
      taken += capacity / reduce::kLine;
    }
  }
  EXPECT_EQ(lines.size(), taken);
  EXPECT_GE(*lines.begin(), 800u);
}

TEST(StarRoom, TakesWhatIsLeftThenWhatIsTooLarge) {
  reduce::FreshLines fresh;
  fresh.reset(0, 6 * reduce::kLine);  // less than one claim takes
  reduce::StarRoom a(fresh), b(fresh);
  std::uint32_t capacity = 0;
  const std::uint32_t large = a.take(3 * reduce::kLine, capacity);
  b.give(b.take(2 * reduce::kLine + 1, capacity), capacity);
  a.join(std::move(b));
  a.give(large, 3 * reduce::kLine);
  EXPECT_NO_THROW(a.take(reduce::kLine, capacity));
  EXPECT_EQ(capacity, 3 * reduce::kLine);
  EXPECT_NO_THROW(a.take(reduce::kLine, capacity));
  EXPECT_THROW(a.take(reduce::kLine, capacity), std::bad_alloc);
}

}  // namespace
}  // namespace merlin::render
