#include "render/reduce/pattern/edge_heap.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/random.h"

namespace merlin::render {
namespace {

using Edges = std::vector<std::uint32_t>;

// Removes the top until the heap is empty; returns the removed edges in their order.
Edges drained(reduce::EdgeHeap& heap) {
  Edges order;
  while (!heap.empty()) {
    order.push_back(heap.top());
    heap.remove(heap.top());
  }
  return order;
}

TEST(EdgeHeap, OfNoEdgesIsEmpty) { EXPECT_TRUE(reduce::EdgeHeap({}).empty()); }

TEST(EdgeHeap, GivesTheShortestFirst) {
  reduce::EdgeHeap heap({3, 1, 2, 0.5F});
  EXPECT_EQ(drained(heap), (Edges{3, 1, 2, 0}));
}

TEST(EdgeHeap, GivesTheSmallerNumberFirstOfTwoThatAreAlike) {
  reduce::EdgeHeap heap(std::vector<float>(100, 7));
  Edges order(100);
  std::iota(order.begin(), order.end(), 0U);
  EXPECT_EQ(drained(heap), order);
}

TEST(EdgeHeap, KeepsAnEdgesLengthAndItsOrderWhenItChanges) {
  reduce::EdgeHeap heap({3, 1, 2});
  heap.update(1, 9);
  EXPECT_EQ(heap.top(), 2u);
  EXPECT_EQ(heap.length(1), 9);
  heap.update(0, 0);
  EXPECT_EQ(heap.top(), 0u);
  heap.update(0, std::numeric_limits<float>::infinity());
  EXPECT_EQ(drained(heap), (Edges{2, 1, 0}));
}

TEST(EdgeHeap, RemovesAnEdgeOnce) {
  reduce::EdgeHeap heap({3, 1, 2});
  heap.remove(1);
  EXPECT_FALSE(heap.contains(1));
  heap.remove(1);
  EXPECT_EQ(drained(heap), (Edges{2, 0}));
}

TEST(EdgeHeap, AgreesWithSortForEverySize) {
  Random random(1);
  for (std::size_t size = 1; size < 200; ++size) {
    std::vector<float> lengths(size);
    for (float& l : lengths) l = static_cast<float>(random.below(size));  // with many ties
    Edges sorted(size);
    std::iota(sorted.begin(), sorted.end(), 0U);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return lengths[a] < lengths[b]; });
    reduce::EdgeHeap heap(lengths);
    ASSERT_EQ(drained(heap), sorted) << size;
  }
}

// The reference: a map from edge to length, searched linearly.
std::uint32_t shortest(const std::map<std::uint32_t, float>& model) {
  const auto shorter = [](const auto& a, const auto& b) { return a.second < b.second; };
  return std::min_element(model.begin(), model.end(), shorter)->first;
}

TEST(EdgeHeap, AgreesWithANaiveModelThroughUpdatesAndRemovals) {
  Random random(2);
  for (int round = 0; round < 20; ++round) {
    std::map<std::uint32_t, float> model;
    std::vector<float> lengths(100);
    for (std::uint32_t e = 0; e < 100; ++e) {
      model[e] = lengths[e] = static_cast<float>(random.below(50));
    }
    reduce::EdgeHeap heap(lengths);
    while (!model.empty()) {
      ASSERT_EQ(heap.top(), shortest(model));
      const auto edge = static_cast<std::uint32_t>(random.below(100));
      ASSERT_EQ(heap.contains(edge), model.count(edge) == 1);
      if (random.below(4) == 0) {
        heap.remove(edge);
        model.erase(edge);
      } else if (heap.contains(edge)) {
        heap.update(edge, model[edge] = static_cast<float>(random.below(50)));
      }
    }
    EXPECT_TRUE(heap.empty());
  }
}

}  // namespace
}  // namespace merlin::render
