// The page's list of events: the numbers of events, its limits, its memory.
#include "daemon/page/event_log.h"

#include <cstdint>
#include <string>

#include <gtest/gtest.h>
#include <malloc.h>

#include "daemon/json/json_tree.h"

namespace merlin::page {
namespace {

TEST(PageEvents, AreNumberedAndBounded) {
  EventLog log(1000);
  log.addDocument("wall", R"({"time_utc":"2026-11-24T07:00:00Z","kind":"wall","what":"a \"b\""})");
  log.addDocument("wall", "{");
  log.addDocument("wall", R"({"what":5})");
  EXPECT_EQ(log.since(0),
            "{\"next\":1001,\"events\":[{\"number\":1000,\"role\":\"wall\",\"time_utc\":"
            "\"2026-11-24T07:00:00Z\",\"kind\":\"wall\",\"what\":\"a \\\"b\\\"\"}]}\n");
  EXPECT_EQ(log.since(1000), "{\"next\":1001,\"events\":[]}\n");
  for (int i = 0; i < 2000; ++i) log.add("page", "server", std::string(5000, 'x'));
  const auto all = parseJson(log.since(0));
  ASSERT_TRUE(all) << all.error().what;
  EXPECT_EQ(all->members[0].value.number, 3001);
  EXPECT_EQ(all->members[1].value.items.size(), 200U);
  EXPECT_LT(log.since(0).size(), 300'000U);
}

// If the clock was set back before the start, a browser's last number is higher than all numbers of
// this run.
TEST(PageEvents, AreAllNewToAClientWithANumberThatNoEventHasHad) {
  EventLog log(1000);
  EXPECT_EQ(log.since(5000), "{\"next\":1000,\"events\":[]}\n");
  log.add("page", "server", "a");
  log.add("page", "server", "b");
  EXPECT_EQ(log.since(1001), "{\"next\":1002,\"events\":[]}\n");
  for (const std::uint64_t other : {std::uint64_t{1002}, ~std::uint64_t{0}})
    EXPECT_EQ(log.since(other), log.since(0)) << other;
  EXPECT_EQ(parseJson(log.since(5000))->members[1].value.items.size(), 2U);
}

TEST(PageEvents, TakeTheirMemoryAtTheStart) {
  EventLog log(1);
  const std::string role = "devices", kind = "flight", what(150, 'x');
  log.add(role, kind, what);
  const std::size_t before = ::mallinfo2().uordblks;
  for (int i = 0; i < 499; ++i) log.add(role, kind, what);
  EXPECT_LE(::mallinfo2().uordblks, before + 4096) << "50 kB and more without";
  EXPECT_EQ(log.after(0).size(), 500U);
  log.add(role, kind, "the last");
  const auto kept = log.after(0);
  ASSERT_EQ(kept.size(), 500U);
  EXPECT_EQ(kept.front().number, 2U);
  EXPECT_EQ(kept.back().what, "the last");
}

}  // namespace
}  // namespace merlin::page
