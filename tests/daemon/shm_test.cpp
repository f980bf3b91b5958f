#include <cstring>
#include <map>
#include <set>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/shared_memory.h"
#include "daemon/shm/fields.h"
#include "daemon/shm/segment.h"
#include "tests/support/temp_dir.h"

namespace merlin::shm {
namespace {

using test::privateName;

const Endpoints kEndpoints{"ipc:///run/merlin/a.status", "ipc:///run/merlin/a.command"};

// The contract with other programs: these figures never change under version 1.
TEST(Layout, OffsetsOfVersion1) {
  EXPECT_EQ(kVersion, 1u);
  EXPECT_EQ(offsetof(Header, generation), 16u);
  EXPECT_EQ(offsetof(Header, heartbeat_ns), 24u);
  EXPECT_EQ(offsetof(Header, field_count), 44u);
  EXPECT_EQ(offsetof(Header, fields), 264u);
  EXPECT_EQ(sizeof(Field), 72u);
  EXPECT_EQ(offsetof(DevicesSegment, health), 7232u);
  EXPECT_EQ(offsetof(DevicesSegment, glove), 8192u);
  EXPECT_EQ(offsetof(GloveSample, raw), 112u);
  EXPECT_EQ(offsetof(TrackerSample, orientation_wxyz), 28u);
  EXPECT_EQ(offsetof(BallSample, rotation), 28u);
  EXPECT_EQ(offsetof(PostureSample, name), 44u);
  EXPECT_EQ(offsetof(WallStats, rate_held_hz), 60u);
  EXPECT_EQ(offsetof(WallInteraction, snapshots), 32u);
  EXPECT_EQ(offsetof(WallSegment, stats), 7232u);
  EXPECT_EQ(offsetof(WallSegment, trace), 7616u);
}

TEST(Layout, DevicesDoNotShareCacheLines) {
  EXPECT_EQ(offsetof(DevicesSegment, glove) % 64, 0u);
  EXPECT_EQ(offsetof(DevicesSegment, ball) % 64, 0u);
  EXPECT_EQ(sizeof(Channel<TrackerSample>) % 64, 0u);
}

TEST(Fields, DescribeEachValueOnceAndInsideTheSegment) {
  std::set<std::string> names;
  for (const Field& f : devicesFields()) {
    EXPECT_TRUE(names.insert(f.name).second) << f.name;
    EXPECT_GT(f.offset, f.slot) << f.name;
    const std::size_t size =
        std::map<char, std::size_t>{{'s', 1}, {'B', 1}, {'h', 2}, {'f', 4}, {'i', 4},
                                    {'I', 4}, {'d', 8}, {'q', 8}, {'Q', 8}}
            .at(f.type[0]);
    EXPECT_LE(f.offset + f.count * size, sizeof(DevicesSegment)) << f.name;
  }
  EXPECT_TRUE(names.count("glove.angle_rad"));
  EXPECT_TRUE(names.count("tracker4.orientation_wxyz"));
  for (const char* name : {"tracker.alignment_cm", "tracker.boresight_wxyz", "hand.joint_rad",
                           "gpio.power", "ball.count", "ball.wake", "ball.ring"})
    EXPECT_TRUE(names.count(name)) << name;
  EXPECT_LE(names.size(), kMostFields);
  EXPECT_LE(wallFields().size(), kMostFields);
}

TEST(Fields, PointAtTheValueInItsSlot) {
  auto segment = std::make_unique<DevicesSegment>();
  GloveSample glove{};
  glove.angle_rad[22] = 0.5F;
  segment->glove.publish(glove);
  for (const Field& f : devicesFields()) {
    if (std::strcmp(f.name, "glove.angle_rad") != 0) continue;
    EXPECT_EQ(f.count, 23u);
    EXPECT_STREQ(f.unit, "rad");
    float value = 0;
    std::memcpy(&value, reinterpret_cast<const char*>(segment.get()) + f.offset + 22 * sizeof value,
                sizeof value);
    EXPECT_EQ(value, 0.5F);
  }
}

TEST(Segment, IsFoundByAReaderAndGoneWithItsWriter) {
  const std::string name = segmentName(privateName("found"), "devices");
  const SystemClock clock;
  {
    const auto writer =
        SegmentWriter<DevicesSegment>::make(name, devicesFields(), 42, clock.now(), kEndpoints);
    ASSERT_TRUE(writer);
    BallSample ball{};
    ball.counter = 5;
    (*writer)->ball.publish(ball);
    const auto reader = SegmentReader<DevicesSegment>::open(name);
    ASSERT_TRUE(reader);
    EXPECT_EQ((*reader)->header.generation, 42u);
    EXPECT_EQ((*reader)->ball.newest()->counter, 5u);
    EXPECT_STREQ((*reader)->header.command_endpoint, "ipc:///run/merlin/a.command");
    EXPECT_TRUE(reader->alive(clock.now()));
    EXPECT_FALSE(reader->alive(clock.now() + std::chrono::seconds(2)));
  }
  const auto gone = SegmentReader<DevicesSegment>::open(name);
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, Errc::kNotFound);
}

TEST(Segment, ASecondWriterIsRefusedAndTheFirstUndisturbed) {
  const std::string name = segmentName(privateName("second"), "devices");
  const SystemClock clock;
  const auto first =
      SegmentWriter<DevicesSegment>::make(name, devicesFields(), 1, clock.now(), kEndpoints);
  ASSERT_TRUE(first);
  const auto second =
      SegmentWriter<DevicesSegment>::make(name, devicesFields(), 2, clock.now(), kEndpoints);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kBusy);
  EXPECT_NE(second.error().what.find(name), std::string::npos);
  EXPECT_EQ((*SegmentReader<DevicesSegment>::open(name))->header.generation, 1u);
}

// kill -9 leaves the name behind; the next start takes it over.
TEST(Segment, OfADeadWriterIsReplaced) {
  const std::string name = segmentName(privateName("dead"), "wall");
  const SystemClock clock;
  const pid_t child = ::fork();
  if (child == 0) {
    const auto writer =
        SegmentWriter<WallSegment>::make(name, wallFields(), 1, clock.now(), kEndpoints);
    ::_exit(writer.ok() ? 0 : 1);  // no destructor runs
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  ASSERT_TRUE(SegmentReader<WallSegment>::open(name)) << "left behind";
  EXPECT_FALSE(SharedMemory::owned(name));
  const auto next =
      SegmentWriter<WallSegment>::make(name, wallFields(), 2, clock.now(), kEndpoints);
  ASSERT_TRUE(next);
  EXPECT_TRUE(SharedMemory::owned(name));
  EXPECT_EQ((*SegmentReader<WallSegment>::open(name))->header.generation, 2u);
}

TEST(Segment, OfAnotherVersionOrMakerIsRefused) {
  const std::string name = segmentName(privateName("other"), "wall");
  auto memory = SharedMemory::create(name, sizeof(WallSegment));
  ASSERT_TRUE(memory);
  EXPECT_EQ(SegmentReader<WallSegment>::open(name).error().code, Errc::kMalformed);  // zeros
  auto& header = *reinterpret_cast<Header*>(memory->data());
  fillHeader(header, sizeof(WallSegment), 1, Timestamp{}, kEndpoints);
  EXPECT_TRUE(SegmentReader<WallSegment>::open(name));
  header.version = 2;
  EXPECT_EQ(SegmentReader<WallSegment>::open(name).error().code, Errc::kUnsupported);
  header.version = 1;
  header.size = 100;
  EXPECT_EQ(SegmentReader<WallSegment>::open(name).error().code, Errc::kMalformed);
}

TEST(SegmentFollower, OpensAgainAfterTheDaemonWasStartedAnew) {
  const std::string name = segmentName(privateName("follow"), "wall");
  SegmentFollower<WallSegment> follower(name);
  Timestamp now = SystemClock().now();
  EXPECT_EQ(follower.get(now), nullptr);
  {
    const auto first = SegmentWriter<WallSegment>::make(name, wallFields(), 1, now, kEndpoints);
    ASSERT_TRUE(first);
    EXPECT_EQ(follower.get(now), nullptr) << "twice a second is enough";
    now += std::chrono::seconds(1);
    first->beat(now);
    ASSERT_NE(follower.get(now), nullptr);
    EXPECT_EQ(follower.get(now)->header.generation, 1u);
  }
  now += std::chrono::seconds(2);  // its heart has stopped
  EXPECT_EQ(follower.get(now), nullptr);
  const auto second = SegmentWriter<WallSegment>::make(name, wallFields(), 2, now, kEndpoints);
  ASSERT_TRUE(second);
  now += std::chrono::seconds(1);
  second->beat(now);
  ASSERT_NE(follower.get(now), nullptr);
  EXPECT_EQ(follower.get(now)->header.generation, 2u);
}

TEST(SharedMemory, MoreThanThereIsIsAnErrorNowAndNoFaultLater) {
  const auto memory = SharedMemory::create("/" + privateName("huge"), std::size_t{1} << 50);
  ASSERT_FALSE(memory);
  EXPECT_EQ(memory.error().code, Errc::kIo);
  EXPECT_EQ(SharedMemory::open("/" + privateName("huge")).error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace merlin::shm
