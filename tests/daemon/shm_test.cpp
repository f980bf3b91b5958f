#include <cstring>
#include <map>
#include <set>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/shared_memory.h"
#include "daemon/shm/fields.h"
#include "daemon/shm/segment.h"
#include "tests/support/local_devices.h"
#include "tests/support/temp_dir.h"

namespace merlin::shm {
namespace {

using test::privateName;

const Endpoints kEndpoints{"ipc:///run/merlin/a.status", "ipc:///run/merlin/a.command"};

// Other programs rely on these offsets, so they must never change within version 6.
TEST(Layout, OffsetsOfVersion6) {
  EXPECT_EQ(kVersion, 6u);
  EXPECT_EQ(offsetof(Header, generation), 16u);
  EXPECT_EQ(offsetof(Header, field_offset), 24u);
  EXPECT_EQ(offsetof(Header, field_count), 28u);
  EXPECT_EQ(offsetof(Header, field_size), 32u);
  EXPECT_EQ(offsetof(Header, heartbeat_ns), 40u);
  EXPECT_EQ(offsetof(Header, realtime_offset_ns), 56u);
  EXPECT_EQ(offsetof(Header, command_endpoint), 172u);
  EXPECT_EQ(sizeof(Field), 112u);
  EXPECT_EQ(offsetof(Field, offset), 88u);
  EXPECT_EQ(offsetof(Field, ring), 96u);
  EXPECT_EQ(offsetof(DevicesSegment, health), 320u);
  EXPECT_EQ(offsetof(DevicesSegment, glove), 5440u);
  EXPECT_EQ(offsetof(GloveSample, raw), 112u);
  EXPECT_EQ(offsetof(TrackerSample, orientation_wxyz), 28u);
  EXPECT_EQ(offsetof(BallSample, rotation), 28u);
  EXPECT_EQ(offsetof(BallSample, keys), 56u);
  EXPECT_EQ(offsetof(TouchSample, wheel), 142u);
  EXPECT_EQ(offsetof(PostureSample, name), 44u);
  EXPECT_EQ(offsetof(GestureState, counter), 16u);
  EXPECT_EQ(offsetof(WallStats, rate_held_hz), 60u);
  EXPECT_EQ(offsetof(WallInteraction, snapshots), 32u);
  EXPECT_EQ(offsetof(WallInteraction, light), 48u);
  EXPECT_EQ(offsetof(WallSegment, stats), 320u);
  EXPECT_EQ(offsetof(WallSegment, trace), 704u);
}

TEST(Layout, DevicesDoNotShareCacheLines) {
  EXPECT_EQ(offsetof(DevicesSegment, glove) % 64, 0u);
  EXPECT_EQ(offsetof(DevicesSegment, ball) % 64, 0u);
  EXPECT_EQ(sizeof(Channel<TrackerSample>) % 64, 0u);
}

std::size_t widthOf(const Field& f) {
  const std::string type(f.type);
  if (type.ends_with('s')) return std::stoul(type);
  return std::map<std::string, std::size_t>{{"B", 1}, {"h", 2}, {"H", 2}, {"f", 4}, {"i", 4},
                                            {"I", 4}, {"d", 8}, {"q", 8}, {"Q", 8}}
      .at(type);
}

TEST(Fields, DescribeEachValueOnceAndInsideTheSegment) {
  for (const auto& [fields, size] :
       {std::pair{devicesFields(test::defaultSlotNames()), sizeof(DevicesSegment)},
        std::pair{wallFields(), sizeof(WallSegment)}}) {
    std::set<std::string> names;
    for (const Field& f : fields) {
      EXPECT_TRUE(names.insert(f.name).second) << f.name;
      EXPECT_GE(f.offset, f.slot) << f.name;
      EXPECT_GE(f.step, widthOf(f)) << f.name;
      EXPECT_LE(f.offset + (f.count - 1) * f.step + widthOf(f), size) << f.name;
    }
    EXPECT_LE(names.size(), kMostFields * 3 / 4) << "a quarter of the table is room for what comes";
  }
}

// Returns, for each byte of a segment, whether the table describes it: values, the sequence
// counters of their slots, and rings.
std::vector<bool> described(const std::vector<Field>& fields, std::size_t size) {
  std::vector<bool> bytes(size);
  const auto mark = [&](std::size_t from, std::size_t count) {
    for (std::size_t i = from; i < from + count; ++i) bytes.at(i) = true;
  };
  for (const Field& f : fields) {
    for (std::uint32_t i = 0; i < f.count; ++i) mark(f.offset + i * f.step, widthOf(f));
    if (f.slot != 0) mark(f.slot, 8);
    if (f.ring != 0) mark(f.ring, std::size_t{f.ring_slots} * f.ring_stride);
  }
  return bytes;
}

// Returns the gaps between described bytes before the table, each as the name of the preceding
// field and the gap's length.
std::vector<std::string> undescribed(const std::vector<Field>& fields, std::size_t size) {
  const std::vector<bool> bytes = described(fields, size);
  std::map<std::size_t, std::string> ends;
  for (const Field& f : fields) ends[f.offset + (f.count - 1) * f.step + widthOf(f)] = f.name;
  for (const Field& f : fields) {
    if (f.ring != 0) ends[f.ring + f.ring_slots * f.ring_stride] = std::string(f.name) + "'s ring";
  }
  std::vector<std::string> runs;
  for (std::size_t i = 0; i < size; ++i) {
    if (bytes[i]) continue;
    std::size_t end = i;
    while (end < size && !bytes[end]) ++end;
    runs.push_back(ends[i] + " " + std::to_string(end - i));
    i = end;
  }
  return runs;
}

using Runs = std::vector<std::string>;

// A member that is added to layout.h or samples.h but not to fields.cpp changes these lists. The
// lists may contain only `reserved` members and padding to 8 or 64 bytes.
TEST(Fields, CoverEveryByteOfTheDevicesSegmentButPadding) {
  SlotNames all;  // each device of a kind has the kind as its name, after a letter
  const auto add = [&](SampleKind kind, const char* name, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
      all.devices.push_back({static_cast<char>('a' + i) + std::string("_") + name, kind});
  };
  add(SampleKind::kGlove, "glove", kMostGloves);
  add(SampleKind::kTracker, "tracker", kMostTrackers);
  add(SampleKind::kBall, "ball", kMostBalls);
  add(SampleKind::kTouch, "touch", kMostTouches);
  for (std::size_t i = 0; i < kMostHands; ++i)
    all.hands.push_back(static_cast<char>('a' + i) + std::string("_hand"));
  Runs kinds;
  for (std::string run : undescribed(devicesFields(all), offsetof(DevicesSegment, fields))) {
    if (run[1] == '_') run.erase(0, 2);
    if (std::find(kinds.begin(), kinds.end(), run) == kinds.end()) kinds.push_back(run);
  }
  EXPECT_EQ(kinds, (Runs{"segment.command_endpoint 40",
                         "glove.health.rate_hz 4",
                         "tracker.health.rate_hz 4",
                         "ball.health.rate_hz 4",
                         "touch.health.rate_hz 4",
                         "glove.wake 4",
                         "glove.raw's ring 32",
                         "posture.wake 4",
                         "posture.name's ring 40",
                         "posture_state.seen 48",
                         "glove.posture.wake 4",
                         "glove.posture.name's ring 40",
                         "glove.posture_state.seen 48",
                         "tracker1.stylus 2",
                         "tracker1.wake 4",
                         "tracker1.stylus's ring 56",
                         "tracker2.stylus 2",
                         "tracker2.wake 4",
                         "tracker2.stylus's ring 56",
                         "tracker3.stylus 2",
                         "tracker3.wake 4",
                         "tracker3.stylus's ring 56",
                         "tracker4.stylus 2",
                         "tracker4.wake 4",
                         "tracker4.stylus's ring 56",
                         "tracker.boresight_wxyz 40",
                         "ball.wake 4",
                         "ball.keys's ring 32",
                         "touch.wake 4",
                         "touch.wheel's ring 24",
                         "hand.delay_s 4",
                         "hand.wake 4",
                         "hand.delay_s's ring 56",
                         "gpio.wake 4",
                         "gpio.wait_s's ring 8",
                         "gpio.health.rate_hz 4",
                         "actions.d_hand.recent 56",
                         "hand.gesture.name 32"}));
}

TEST(Fields, CoverEveryByteOfTheWallsSegmentButPadding) {
  EXPECT_EQ(undescribed(wallFields(), offsetof(WallSegment, fields)),
            (Runs{"segment.command_endpoint 40", "wall.least_cost 20", "trace.wake 4",
                  "trace.step.tile's ring 56", "interaction.light 4", "outputs.count 4",
                  "outputs.picture_fault 48", "content.refused 24", "idle.testcard 32",
                  "panel.by_ball 28", "notice.text 24"}));
}

// Reads sample 258 at its position in the ring, as a reader would that knows only the table.
TEST(Fields, SayWhereASampleLiesInItsRing) {
  auto segment = std::make_unique<DevicesSegment>();
  BallSample ball{};
  for (ball.counter = 0; ball.counter < 300; ++ball.counter) segment->ball[0].publish(ball);
  for (const Field& f : devicesFields(test::defaultSlotNames())) {
    if (std::strcmp(f.name, "ball.counter") != 0) continue;
    ASSERT_EQ(f.ring_slots, 256u);
    const auto* base = reinterpret_cast<const char*>(segment.get());
    const std::size_t slot = f.ring + (258 % f.ring_slots) * f.ring_stride;
    std::uint32_t value = 0;
    std::memcpy(&value, base + slot + (f.offset - f.slot), sizeof value);
    EXPECT_EQ(value, 258u);
    return;
  }
  FAIL() << "no ball.counter";
}

TEST(Fields, PointAtTheValueInItsSlot) {
  auto segment = std::make_unique<DevicesSegment>();
  GloveSample glove{};
  glove.angle_rad[22] = 0.5F;
  segment->glove[0].samples.publish(glove);
  for (const Field& f : devicesFields(test::defaultSlotNames())) {
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
    const auto writer = SegmentWriter<DevicesSegment>::make(
        name, devicesFields(test::defaultSlotNames()), 42, clock.now(), kEndpoints);
    ASSERT_TRUE(writer);
    BallSample ball{};
    ball.counter = 5;
    (*writer)->ball[0].publish(ball);
    const auto reader = SegmentReader<DevicesSegment>::open(name);
    ASSERT_TRUE(reader);
    EXPECT_EQ((*reader)->header.generation, 42u);
    EXPECT_EQ((*reader)->ball[0].newest()->counter, 5u);
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
  const auto first = SegmentWriter<DevicesSegment>::make(
      name, devicesFields(test::defaultSlotNames()), 1, clock.now(), kEndpoints);
  ASSERT_TRUE(first);
  const auto second = SegmentWriter<DevicesSegment>::make(
      name, devicesFields(test::defaultSlotNames()), 2, clock.now(), kEndpoints);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kBusy);
  EXPECT_NE(second.error().what.find(name), std::string::npos);
  EXPECT_EQ((*SegmentReader<DevicesSegment>::open(name))->header.generation, 1u);
}

// kill -9 leaves the shared memory object behind; the next start must take it over.
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

// A reader may hold a read lock on an object that it is allowed to read. The next start must not
// mistake that lock for the owner's.
TEST(SharedMemory, AReadersLockDoesNotForbidTheRestart) {
  const std::string name = "/" + privateName("locked");
  { ASSERT_TRUE(SharedMemory::create(name, 4096)); }
  const pid_t child = ::fork();
  if (child == 0) {
    auto left = SharedMemory::create(name, 4096);
    ::_exit(left.ok() ? 0 : 1);  // like a killed process: the object stays
  }
  ::waitpid(child, nullptr, 0);
  const UniqueFd reader(::shm_open(name.c_str(), O_RDONLY, 0));
  ASSERT_TRUE(reader.valid());
  struct flock lock {};
  lock.l_type = F_RDLCK;
  lock.l_whence = SEEK_SET;
  ASSERT_EQ(::fcntl(reader.get(), F_OFD_SETLK, &lock), 0);
  const auto again = SharedMemory::create(name, 4096);
  EXPECT_TRUE(again) << again.error().what;
}

TEST(SharedMemory, TwoLivingOwnersCannotShareAName) {
  const std::string name = "/" + privateName("owned");
  const auto first = SharedMemory::create(name, 4096);
  ASSERT_TRUE(first);
  EXPECT_EQ(SharedMemory::create(name, 4096).error().code, Errc::kBusy);
  EXPECT_TRUE(SharedMemory::owned(name));
}

// Somebody else has removed the object: an administrator, or logind when the daemon's user logged
// out.
TEST(SharedMemory, WhatWasRemovedIsMadeAgainWithTheSameBytes) {
  const std::string name = "/" + privateName("mended");
  auto memory = SharedMemory::create(name, 10'000);
  ASSERT_TRUE(memory);
  std::byte* const data = memory->data();
  data[0] = std::byte{7};
  data[9'999] = std::byte{8};
  EXPECT_EQ(*memory->mend(), "") << "nothing was wrong";
  for (const std::string& lost : {name, name + ".lock"}) {
    ASSERT_EQ(::shm_unlink(lost.c_str()), 0);
    EXPECT_EQ(*memory->mend(),
              "another program removed shared memory " + lost + "; it was created again");
    EXPECT_EQ(*memory->mend(), "");
  }
  EXPECT_EQ(SharedMemory::create(name, 10'000).error().code, Errc::kBusy);
  EXPECT_EQ(memory->data(), data);
  data[1] = std::byte{9};
  const auto reader = SharedMemory::open(name);
  ASSERT_TRUE(reader) << reader.error().what;
  ASSERT_EQ(reader->size(), 10'000u);
  EXPECT_EQ(reader->data()[0], std::byte{7});
  EXPECT_EQ(reader->data()[9'999], std::byte{8});
  EXPECT_EQ(reader->data()[1], std::byte{9}) << "what is written from then on is there too";
}

TEST(SharedMemory, ANameThatAnotherTookMeanwhileStaysTheOthers) {
  const std::string name = "/" + privateName("usurped");
  Result<SharedMemory> second = Error{Errc::kNotFound, "not made yet"};
  {
    auto first = SharedMemory::create(name, 4096);
    ASSERT_TRUE(first);
    ::shm_unlink(name.c_str());
    ::shm_unlink((name + ".lock").c_str());
    second = SharedMemory::create(name, 4096);
    ASSERT_TRUE(second);
    EXPECT_EQ(first->mend().error().code, Errc::kBusy);
    first->data()[0] = std::byte{1};  // `first` still owns these bytes
  }
  EXPECT_TRUE(SharedMemory::open(name)) << "the first's end removed the second's";
  EXPECT_EQ(second->data()[0], std::byte{0});
}

TEST(SharedMemory, AStrangersLockKeepsNobodyOut) {
  if (::geteuid() != 0) GTEST_SKIP() << "takes root, to act as another user";
  const std::string name = "/" + privateName("squatted");
  int ready[2], done[2];
  ASSERT_TRUE(::pipe(ready) == 0 && ::pipe(done) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    char byte = 0;
    struct flock lock {};
    lock.l_type = F_WRLCK;
    const bool stranger = ::setgid(65534) == 0 && ::setuid(65534) == 0;
    const int fd = ::shm_open((name + ".lock").c_str(), O_RDWR | O_CREAT, 0666);
    const bool held = stranger && fd >= 0 && ::fcntl(fd, F_OFD_SETLK, &lock) == 0;
    if (::write(ready[1], held ? "y" : "n", 1) == 1) (void)!::read(done[0], &byte, 1);
    ::_exit(0);
  }
  char held = 0;
  ASSERT_EQ(::read(ready[0], &held, 1), 1);
  EXPECT_EQ(held, 'y');
  EXPECT_FALSE(SharedMemory::owned(name));
  const auto ours = SharedMemory::create(name, 4096);
  EXPECT_TRUE(ours) << ours.error().what;
  EXPECT_TRUE(SharedMemory::owned(name));
  ASSERT_EQ(::write(done[1], "x", 1), 1);
  ::waitpid(child, nullptr, 0);
}

// Any user may create an object with a name that is not in use.
TEST(SharedMemory, AStrangersObjectIsNotTakenAndGoesForRoot) {
  if (::geteuid() != 0) GTEST_SKIP() << "takes root, to act as another user";
  const std::string name = "/" + privateName("stranger");
  const pid_t child = ::fork();
  if (child == 0) {
    if (::setgid(65534) != 0 || ::setuid(65534) != 0) ::_exit(1);
    const int fd = ::shm_open(name.c_str(), O_RDWR | O_CREAT, 0644);
    ::_exit(fd >= 0 && ::ftruncate(fd, 4096) == 0 ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  EXPECT_TRUE(SharedMemory::open(name));
  const auto taken = SharedMemory::open(name, SharedMemory::From::kOwnUserOrRoot);
  ASSERT_FALSE(taken);
  EXPECT_NE(taken.error().what.find("belongs to user nobody and is not accepted"),
            std::string::npos)
      << taken.error().what;
  const auto ours = SharedMemory::create(name, 4096);
  EXPECT_TRUE(ours) << ours.error().what;
  EXPECT_TRUE(SharedMemory::open(name, SharedMemory::From::kOwnUserOrRoot));
}

TEST(SharedMemory, OfAnotherUserInOneOfOurGroupsIsAcceptedWhereThatIsWanted) {
  if (::geteuid() != 0) GTEST_SKIP() << "takes root, to act as other users";
  const std::string name = "/" + privateName("group");
  const auto made = SharedMemory::create(name, 4096);
  ASSERT_TRUE(made) << made.error().what;
  constexpr uid_t kOwner = 65533, kReader = 65534;
  ASSERT_EQ(::chown(("/dev/shm" + name).c_str(), kOwner, kOwner), 0);
  // 'a': accepted, 'r': refused; for a reader in the owner's group, and for one outside of it
  const auto seenBy = [&](gid_t group) {
    int out[2];
    EXPECT_EQ(::pipe(out), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      if (::setgroups(1, &group) != 0 || ::setgid(kReader) != 0 || ::setuid(kReader) != 0)
        ::_exit(1);
      const char answer = SharedMemory::open(name, SharedMemory::From::kOwnGroup) ? 'a' : 'r';
      ::_exit(::write(out[1], &answer, 1) == 1 ? 0 : 1);
    }
    char answer = 0;
    EXPECT_EQ(::read(out[0], &answer, 1), 1);
    ::waitpid(child, nullptr, 0);
    ::close(out[0]);
    ::close(out[1]);
    return answer;
  };
  EXPECT_EQ(seenBy(kOwner), 'a');
  EXPECT_EQ(seenBy(kReader), 'r');
}

TEST(Segment, OfAnotherVersionOrMakerIsRefused) {
  const std::string name = segmentName(privateName("other"), "wall");
  auto memory = SharedMemory::create(name, sizeof(WallSegment));
  ASSERT_TRUE(memory);
  // All bytes are zero.
  EXPECT_EQ(SegmentReader<WallSegment>::open(name).error().code, Errc::kMalformed);
  auto& header = *reinterpret_cast<Header*>(memory->data());
  fillHeader(header, sizeof(WallSegment), 1, Timestamp{}, kEndpoints);
  EXPECT_TRUE(SegmentReader<WallSegment>::open(name));
  header.version = 1;
  EXPECT_EQ(SegmentReader<WallSegment>::open(name).error().code, Errc::kUnsupported);
  header.version = kVersion;
  header.field_count = 3;
  header.field_size = sizeof(Field);
  header.field_offset = sizeof(WallSegment) - 3 * sizeof(Field);
  EXPECT_TRUE(SegmentReader<WallSegment>::open(name));
  ++header.field_offset;  // the table would end one byte after the segment
  EXPECT_EQ(SegmentReader<WallSegment>::open(name).error().code, Errc::kMalformed);
  header.field_offset = 0;
  header.field_size = 100;  // shorter than an entry of this version
  EXPECT_EQ(SegmentReader<WallSegment>::open(name).error().code, Errc::kMalformed);
  header.field_count = 0;
  header.size = 100;
  EXPECT_EQ(SegmentReader<WallSegment>::open(name).error().code, Errc::kMalformed);
}

TEST(Segment, HeartbeatBringsTheOffsetToTheTimeOfDay) {
  const std::string name = segmentName(privateName("utc"), "wall");
  const auto writer =
      SegmentWriter<WallSegment>::make(name, wallFields(), 1, SystemClock().now(), kEndpoints);
  ASSERT_TRUE(writer);
  Header& header = (*writer)->header;
  const auto expectNow = [&] {
    const auto utc = std::chrono::system_clock::now().time_since_epoch();
    const auto stamp = std::chrono::nanoseconds(toNanoseconds(SystemClock().now()) +
                                                header.realtime_offset_ns.load());
    EXPECT_LT(std::chrono::abs(stamp - utc), std::chrono::seconds(1));
  };
  expectNow();
  header.realtime_offset_ns = 0;  // as if the system's clock had been set after the start
  writer->writeHeartbeat(SystemClock().now());
  expectNow();
}

TEST(SegmentFollower, OpensAgainAfterTheDaemonWasStartedAnew) {
  const std::string name = segmentName(privateName("follow"), "wall");
  SegmentFollower<SegmentReader<WallSegment>> follower(name);
  Timestamp now = SystemClock().now();
  EXPECT_EQ(follower.get(now), nullptr);
  {
    const auto first = SegmentWriter<WallSegment>::make(name, wallFields(), 1, now, kEndpoints);
    ASSERT_TRUE(first);
    EXPECT_EQ(follower.get(now), nullptr) << "twice a second is enough";
    now += std::chrono::seconds(1);
    first->writeHeartbeat(now);
    ASSERT_NE(follower.get(now), nullptr);
    EXPECT_EQ(follower.get(now)->header.generation, 1u);
  }
  now += std::chrono::seconds(2);  // no heartbeat for too long
  EXPECT_EQ(follower.get(now), nullptr);
  const auto second = SegmentWriter<WallSegment>::make(name, wallFields(), 2, now, kEndpoints);
  ASSERT_TRUE(second);
  now += std::chrono::seconds(1);
  second->writeHeartbeat(now);
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
