// Tests daemon/page/role_watch: what the page reports about a role that starts, ends and starts
// again.
#include "daemon/page/role_watch.h"

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/fake_clock.h"
#include "tests/support/temp_dir.h"

namespace merlin::page {
namespace {

using Writer = shm::SegmentWriter<shm::WallSegment>;

class RoleWatchTest : public testing::Test {
 protected:
  void start(std::uint64_t generation) {
    auto made = Writer::make(shm::segmentName(instance_, "wall"), shm::wallFields(), generation,
                             clock_.now(), {});
    ASSERT_TRUE(made) << made.error().what;
    wall_.emplace(std::move(*made));
  }
  // Returns the sentences that the watch reports within a second.
  std::vector<std::string> told() {
    for (int i = 0; i < 10; ++i) {
      clock_.advance(std::chrono::milliseconds(100));
      if (wall_) wall_->writeHeartbeat(clock_.now());
      watch_.update(clock_.now());
    }
    std::vector<std::string> sentences;
    for (const LoggedEvent& event : events_.after(seen_)) {
      sentences.push_back(event.what);
      seen_ = event.number;
    }
    return sentences;
  }

  test::FakeClock clock_;
  std::string instance_ = test::privateName("watch");
  EventLog events_{1};
  WallWatch watch_{instance_, "wall", events_};
  std::optional<Writer> wall_;
  std::uint64_t seen_ = 0;
};

using Told = std::vector<std::string>;

TEST_F(RoleWatchTest, TellsOnceOfARoleThatComesAndGoes) {
  EXPECT_EQ(told(), Told{"the role wall does not run"});
  EXPECT_EQ(told(), Told{});
  start(7);
  EXPECT_EQ(told(), Told{"the role wall runs"});
  EXPECT_EQ(told(), Told{});
  wall_.reset();
  told();
  told();
  EXPECT_EQ(told(), Told{});
  EXPECT_EQ(events_.after(0).back().what, "the role wall does not run");
}

TEST_F(RoleWatchTest, TellsOfOneThatIsBackBeforeItsEndIsNoticed) {
  start(7);
  EXPECT_EQ(told(), Told{"the role wall runs"});
  wall_.reset();
  start(8);
  Told sentences = told();
  for (int seconds = 0; sentences.empty() && seconds < 5; ++seconds) sentences = told();
  EXPECT_EQ(sentences, Told{"the role wall was started again"});
  EXPECT_EQ(watch_.generation(), 8);
}

}  // namespace
}  // namespace merlin::page
