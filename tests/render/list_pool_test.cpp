#include "render/reduce/pattern/list_pool.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "tests/support/count_allocations.h"

namespace merlin::render {
namespace {

using Numbers = std::vector<std::uint32_t>;

Numbers at(const reduce::ListPool& pool, std::size_t list) {
  return {pool[list].begin(), pool[list].end()};
}

TEST(ListPool, StartsWithEmptyListsThatHaveRoom) {
  const Numbers room{2, 0, 1};
  reduce::ListPool pool(room);
  for (std::size_t list = 0; list < 3; ++list) EXPECT_TRUE(pool[list].empty());
  pool.append(0, 7);
  pool.append(2, 9);
  pool.append(0, 8);
  EXPECT_EQ(at(pool, 0), (Numbers{7, 8}));
  EXPECT_EQ(at(pool, 1), (Numbers{}));
  EXPECT_EQ(at(pool, 2), (Numbers{9}));
}

TEST(ListPool, RemovesTheFirstOneEqualAndKeepsTheOrder) {
  const Numbers room{4, 1};
  reduce::ListPool pool(room);
  for (const std::uint32_t n : {5U, 6U, 5U, 7U}) pool.append(0, n);
  pool.append(1, 1);
  pool.remove(0, 5);
  EXPECT_EQ(at(pool, 0), (Numbers{6, 5, 7}));
  pool.remove(0, 4);  // the list does not contain 4
  EXPECT_EQ(at(pool, 0), (Numbers{6, 5, 7}));
  pool.remove(0, 7);
  pool.remove(0, 6);
  pool.remove(0, 5);
  pool.remove(0, 5);
  EXPECT_EQ(at(pool, 0), (Numbers{}));
  EXPECT_EQ(at(pool, 1), (Numbers{1}));
}

TEST(ListPool, AssignsShorterAndLongerListsWithoutTouchingOthers) {
  const Numbers room{2, 2};
  reduce::ListPool pool(room);
  pool.append(1, 100);
  pool.assign(0, Numbers{1, 2, 3, 4, 5});
  EXPECT_EQ(at(pool, 0), (Numbers{1, 2, 3, 4, 5}));
  pool.assign(0, Numbers{6});
  EXPECT_EQ(at(pool, 0), (Numbers{6}));
  // fits into the space of the list's earlier five elements
  pool.assign(0, Numbers{1, 2, 3, 4, 5});
  EXPECT_EQ(at(pool, 0), (Numbers{1, 2, 3, 4, 5}));
  pool.assign(0, {});
  EXPECT_EQ(at(pool, 0), (Numbers{}));
  EXPECT_EQ(at(pool, 1), (Numbers{100}));
}

// A list that grows by one element at a time is moved up to 2000 times, which would take 8 MB if no
// space were reclaimed.
TEST(ListPool, TakesBackThePlacesThatListsHaveLeft) {
  reduce::ListPool pool(Numbers{0});
  Numbers numbers;
  test::largest_allocation = 0;
  for (std::uint32_t n = 0; n < 2000; ++n) {
    numbers.push_back(n);
    pool.assign(0, numbers);
  }
  EXPECT_EQ(at(pool, 0), numbers);
  EXPECT_LE(test::largest_allocation, 6 * 2000 * sizeof(std::uint32_t));
}

// Lists grow and shrink at random, as in a reduction, and are compacted many times.
TEST(ListPool, AgreesWithAVectorOfVectors) {
  Random random(1);
  const Numbers room(20, 3);
  reduce::ListPool pool(room);
  std::vector<Numbers> model(20);
  for (std::uint32_t step = 0; step < 20'000; ++step) {
    const std::size_t list = random.below(20);
    if (random.below(3) > 0) {
      Numbers numbers(random.below(12));
      for (std::uint32_t& n : numbers) n = static_cast<std::uint32_t>(random.below(8));
      pool.assign(list, numbers);
      model[list] = numbers;
    } else {
      const auto n = static_cast<std::uint32_t>(random.below(8));
      pool.remove(list, n);
      const auto found = std::find(model[list].begin(), model[list].end(), n);
      if (found != model[list].end()) model[list].erase(found);
    }
    for (std::size_t i = 0; i < 20; ++i) ASSERT_EQ(at(pool, i), model[i]) << "step " << step;
  }
}

}  // namespace
}  // namespace merlin::render
