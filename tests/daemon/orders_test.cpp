#include "daemon/wall/orders.h"

#include <gtest/gtest.h>

#include "daemon/shm/fields.h"
#include "daemon/wall/snapshot_writer.h"
#include "tests/support/temp_dir.h"

namespace merlin::wall {
namespace {

using std::chrono::seconds;

class OrdersTest : public testing::Test {
 protected:
  // The wall of a daemon that has just begun.
  void start(std::uint64_t generation) {
    wall_.reset();
    auto made =
        shm::SegmentWriter<shm::WallSegment>::make(name_, shm::wallFields(), generation, now_, {});
    ASSERT_TRUE(made) << made.error().what;
    wall_.emplace(*std::move(made));
    wall_->beat(now_);
  }
  void say(std::uint32_t snapshots, std::uint32_t lamps, std::uint32_t lamp) {
    (*wall_)->interaction.publish({0, 0, {-1, -1}, {}, snapshots, lamps, lamp, 0});
    now_ += seconds(1);
    wall_->beat(now_);
    orders_.poll(now_);
  }

  std::string name_ = "/" + test::privateName("orders");
  Timestamp now_ = SystemClock().now();
  std::optional<shm::SegmentWriter<shm::WallSegment>> wall_;
  int snapshots_ = 0;
  std::vector<std::string> lamps_;
  Orders orders_{name_,
                 {[this] { ++snapshots_; },
                  [this](const std::string& command) { lamps_.push_back(command); }}};
};

TEST_F(OrdersTest, EachIsDoneOnce) {
  start(1);
  say(0, 0, 0);
  say(1, 0, 0);
  say(1, 1, 1);
  say(1, 2, 3);
  say(1, 2, 3);
  EXPECT_EQ(snapshots_, 1);
  EXPECT_EQ(lamps_, (std::vector<std::string>{"lamp_slow", "lamp_on"}));
}

TEST_F(OrdersTest, WhatWasAskedBeforeIsPast) {
  start(1);
  say(5, 7, 2);
  EXPECT_EQ(snapshots_, 0);
  EXPECT_TRUE(lamps_.empty());
  say(6, 8, 2);
  EXPECT_EQ(snapshots_, 1);
  EXPECT_EQ(lamps_, (std::vector<std::string>{"lamp_fast"}));
}

TEST_F(OrdersTest, WithoutAWallNothingIsDone) {
  orders_.poll(now_);
  EXPECT_EQ(snapshots_, 0);
}

TEST(SnapshotWriterTest, SaysWhyThereIsNone) {
  const test::TempDir dir;
  ThreadWatch watch;
  const SnapshotWriter writer("/" + test::privateName("noframes"),
                              DatedFiles(dir.path(), "lab", ".png", 3), watch);
  const auto written = writer.write();
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().what.find("noframes"), std::string::npos) << written.error().what;
}

}  // namespace
}  // namespace merlin::wall
