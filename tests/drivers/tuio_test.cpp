// A touch surface whose tracker speaks TUIO 1.1: frames that are lost, late, split or damaged,
// several trackers, and silence.
#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "drivers/port/plausible.h"
#include "drivers/tuio/device.h"
#include "tests/support/count_allocations.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/osc_packets.h"
#include "tests/support/recording_sink.h"

namespace merlin::tuio {
namespace {

using std::chrono::milliseconds;
using test::datagram;
using test::oscBundle;
using test::oscMessage;
using test::tuioCursors;
using test::tuioObject;

class TuioTest : public testing::Test {
 protected:
  void connect(const TuioSettings& settings = {}) {
    device_.emplace(settings, clock_, sink_);
    const auto identity = device_->open(stream_);
    ASSERT_TRUE(identity);
    EXPECT_EQ(*identity, "TUIO 1.1 touch surface");
  }
  void feed(const std::string& packet, std::uint32_t sender = 1) {
    stream_.feed(datagram(packet, sender));
    ASSERT_TRUE(device_->poll(stream_));
  }
  const TouchSample& newest() const { return sink_.touch.back(); }

  test::FakeClock clock_;
  test::RecordingSink sink_;
  test::FakeStream stream_{clock_, nullptr};
  std::optional<TuioDevice> device_;
};

TEST_F(TuioTest, FingersComeMoveAndGo) {
  connect();
  EXPECT_STREQ(device_->complaint(), "no TUIO frame has come yet");
  feed(tuioCursors(1, {{40, 0.25F, 0.5F}, {41, 0.75F, 1}}));
  ASSERT_EQ(sink_.touch.size(), 1u);
  EXPECT_EQ(newest().fingers, 2u);
  EXPECT_EQ(newest().counter, 1u);
  EXPECT_FLOAT_EQ(newest().position[0][0], 0.25F);
  EXPECT_FLOAT_EQ(newest().position[0][1], 0.5F);
  EXPECT_FLOAT_EQ(newest().position[1][0], 0.75F);
  EXPECT_FLOAT_EQ(newest().aspect, 16.0F / 9);
  const std::uint32_t first = newest().id[0], second = newest().id[1];
  EXPECT_NE(first, second);
  EXPECT_STREQ(device_->complaint(), "");
  feed(tuioCursors(2, {{41, 0.5F, 0.5F}}, {40}));  // the first finger stays where it is
  EXPECT_EQ(newest().id[0], first);
  EXPECT_FLOAT_EQ(newest().position[0][0], 0.25F);
  EXPECT_EQ(newest().id[1], second);
  EXPECT_FLOAT_EQ(newest().position[1][0], 0.5F);
  feed(tuioCursors(3, {}, {41}));
  ASSERT_EQ(newest().fingers, 1u);
  EXPECT_EQ(newest().id[0], second);
  EXPECT_EQ(newest().id[1], 0u);
  feed(tuioCursors(4, {}));
  EXPECT_EQ(newest().fingers, 0u);
  EXPECT_EQ(newest().counter, 4u);
  feed(tuioCursors(5, {{40, 0.1F, 0.1F}}));  // the number 40 is used again, for another finger
  EXPECT_NE(newest().id[0], first);
  EXPECT_EQ(device_->counters().bad_packets, 0u);
}

TEST_F(TuioTest, AFrameThatChangesNothingIsNotPublished) {
  connect();
  feed(tuioCursors(1, {{1, 0.5F, 0.5F}}));
  feed(tuioCursors(2, {}, {1}));
  feed(tuioCursors(3, {{1, 0.5F, 0.5F}}));
  feed(tuioCursors(-1, {}, {1}));
  EXPECT_EQ(sink_.touch.size(), 1u);
}

TEST_F(TuioTest, AFrameThatComesLateIsLeftOutAndARestartedTrackerIsNot) {
  connect();
  feed(tuioCursors(200, {{1, 0.5F, 0.5F}}));
  feed(tuioCursors(199, {{1, 0.1F, 0.1F}}));
  feed(tuioCursors(101, {}));
  ASSERT_EQ(sink_.touch.size(), 1u);
  feed(tuioCursors(200, {{2, 0.2F, 0.2F}}, {1}));  // the second part of frame 200
  EXPECT_EQ(newest().fingers, 2u);
  feed(tuioCursors(100, {{1, 0.9F, 0.9F}}));  // 100 frames behind: the tracker was restarted
  EXPECT_EQ(newest().fingers, 1u);
  feed(tuioCursors(101, {}));
  EXPECT_EQ(newest().fingers, 0u);
}

TEST_F(TuioTest, AFrameWithTheNumberMinusOneCountsAlways) {
  connect();
  feed(tuioCursors(50, {{1, 0.5F, 0.5F}}));
  feed(tuioCursors(-1, {{1, 0.75F, 0.5F}}));
  EXPECT_FLOAT_EQ(newest().position[0][0], 0.75F);
  feed(tuioCursors(49, {}));  // this frame is still late
  EXPECT_EQ(newest().fingers, 1u);
}

TEST_F(TuioTest, AFingerWhosePlaceWasLostIsNoFingerUntilItIsTold) {
  connect();
  feed(tuioCursors(2, {}, {7}));  // frame 1, which had the finger's position, was lost
  EXPECT_TRUE(sink_.touch.empty());
  feed(tuioCursors(3, {{7, 0.5F, 0.5F}}));
  EXPECT_EQ(newest().fingers, 1u);
}

TEST_F(TuioTest, AnObjectIsAFingerWithANumberOfItsOwnRange) {
  connect();
  feed(tuioCursors(1, {{5, 0.1F, 0.1F}}));
  feed(tuioObject(1, {5, 0.6F, 0.7F}));
  ASSERT_EQ(newest().fingers, 2u);
  EXPECT_LT(newest().id[0], Sources::kFirstObject);
  EXPECT_EQ(newest().id[1], Sources::kFirstObject);
  EXPECT_FLOAT_EQ(newest().position[1][0], 0.6F);
  EXPECT_FLOAT_EQ(newest().position[1][1], 0.7F);
}

TEST_F(TuioTest, SourcesAreToldApartByNameAndWithoutOneBySender) {
  connect();
  feed(tuioCursors(1000, {{1, 0.1F, 0.1F}}, {}, "left@10.0.0.1"));
  feed(tuioCursors(5, {{1, 0.9F, 0.9F}}, {}, "right@10.0.0.2"));
  ASSERT_EQ(newest().fingers, 2u);
  EXPECT_NE(newest().id[0], newest().id[1]);
  feed(tuioCursors(1001, {}, {}, "left@10.0.0.1"), 2);  // of another port, still "left"
  ASSERT_EQ(newest().fingers, 1u);
  EXPECT_FLOAT_EQ(newest().position[0][0], 0.9F);
  feed(tuioCursors(1, {{1, 0.3F, 0.3F}}), 3);
  feed(tuioCursors(1, {{1, 0.4F, 0.4F}}), 4);
  EXPECT_EQ(newest().fingers, 3u);
  feed(tuioCursors(1, {{1, 0.4F, 0.4F}}), 5);
  EXPECT_EQ(newest().fingers, 3u);
  EXPECT_STREQ(device_->complaint(), "more than 4 TUIO sources send");
}

TEST_F(TuioTest, ASourceThatIsSilentForTwoSecondsTouchesNoMore) {
  connect();
  feed(tuioCursors(1, {{1, 0.5F, 0.5F}}));
  const Timestamp at = clock_.now();
  while (newest().fingers > 0) ASSERT_TRUE(device_->poll(stream_));
  EXPECT_GE(clock_.now() - at, milliseconds(2000));
  EXPECT_LE(clock_.now() - at, milliseconds(2250));
  EXPECT_STREQ(device_->complaint(), "silent: no TUIO frame for 2 s, so nothing touches");
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(device_->poll(stream_));  // silence is no fault
  feed(tuioCursors(1, {{1, 0.5F, 0.5F}}));  // restarted: frames count from 1 again
  EXPECT_EQ(newest().fingers, 1u);
  EXPECT_STREQ(device_->complaint(), "");
}

TEST_F(TuioTest, WhatIsMalformedDropsItsFrameAndIsSaid) {
  connect();
  feed(tuioCursors(1, {{1, 0.5F, 0.5F}}));
  feed(tuioCursors(2, {{1, 512, 300}}));
  EXPECT_STREQ(device_->complaint(),
               "positions come that are not from 0 to 1: does the tracker send pixels?");
  feed(tuioCursors(3, {{1, std::numeric_limits<float>::quiet_NaN(), 0}}));
  const std::string kCursor = "/tuio/2Dcur";
  const auto set = std::string("set");
  feed(oscBundle({oscMessage(kCursor, {std::string("fseq"), 4})}));  // a frame without "alive"
  feed(oscBundle({oscMessage(kCursor, {std::string("alive"), 1}), oscMessage(kCursor, {set, 1}),
                  oscMessage(kCursor, {std::string("fseq"), 5})}));
  feed(oscBundle({oscMessage(kCursor, {std::string("alive"), 0.5F}),
                  oscMessage(kCursor, {std::string("fseq"), 6})}));
  feed(oscBundle({oscMessage(kCursor, {7})}));
  feed(oscBundle({oscMessage(kCursor, {})}));
  EXPECT_STREQ(device_->complaint(), "a TUIO message does not have the form of TUIO 1.1");
  feed("not OSC.");
  EXPECT_STREQ(device_->complaint(), "datagrams come that are not OSC");
  EXPECT_EQ(sink_.touch.size(), 1u);
  EXPECT_EQ(device_->counters().bad_packets, 8u);
  feed(tuioCursors(7, {{1, 0.25F, 0.5F}}));
  EXPECT_STREQ(device_->complaint(), "");
  EXPECT_EQ(sink_.touch.size(), 2u);
}

TEST_F(TuioTest, AProfileThatIsNotReadIsNoFaultOnceFramesCome) {
  connect();
  const std::string blob = oscBundle({oscMessage("/tuio/2Dblb", {std::string("alive")})});
  feed(blob);
  EXPECT_STREQ(device_->complaint(),
               "OSC messages come, but no complete frame of /tuio/2Dcur or /tuio/2Dobj");
  feed(tuioCursors(1, {{1, 0.5F, 0.5F}}));
  feed(blob);
  EXPECT_STREQ(device_->complaint(), "");
  EXPECT_EQ(device_->counters().bad_packets, 0u);
}

TEST_F(TuioTest, ASurfaceThatIsMountedOtherwiseIsTurned) {
  TuioSettings settings;
  settings.orientation.swap_axes = settings.orientation.invert_x = true;
  settings.aspect = 0.5;
  connect(settings);
  feed(tuioCursors(1, {{1, 0.25F, -0.1F}}));  // just outside of the surface, so it is at the margin
  EXPECT_FLOAT_EQ(newest().position[0][0], 1);
  EXPECT_FLOAT_EQ(newest().position[0][1], 0.25F);
  EXPECT_FLOAT_EQ(newest().aspect, 0.5F);
}

TEST_F(TuioTest, OfManyFingersTheFirstTenAreFollowed) {
  connect();
  std::vector<test::TuioContact> many;
  for (int i = 0; i < 64; ++i) many.push_back({i, 0.01F * static_cast<float>(i), 0.5F});
  const auto feedAll = [&](const std::string& packet) {  // feeds more than one poll reads
    feed(packet);
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(device_->poll(stream_));
  };
  feedAll(tuioCursors(1, many));
  EXPECT_EQ(newest().fingers, kFingers);
  EXPECT_FLOAT_EQ(newest().position[9][0], 0.09F);
  many.push_back({64, 0.5F, 0.5F});
  feedAll(tuioCursors(2, many));
  EXPECT_STREQ(device_->complaint(), "more than 64 fingers or objects come at once");
}

TEST_F(TuioTest, ReopenedItHasNoFingerOfBefore) {
  connect();
  feed(tuioCursors(1, {{1, 0.5F, 0.5F}}));
  ASSERT_TRUE(device_->open(stream_));
  EXPECT_EQ(newest().fingers, 0u);
  EXPECT_EQ(newest().counter, 2u);
}

TEST_F(TuioTest, AHeldPinchActsWhenItIsDue) {
  connect();
  sink_.due_at = clock_.now() + std::chrono::milliseconds(70);
  const std::vector due = {sink_.due_at};
  ASSERT_TRUE(device_->poll(stream_));
  EXPECT_EQ(sink_.ticks, due);
}

TEST_F(TuioTest, FramesAllocateNothing) {
  connect();
  sink_.touch.reserve(1000);
  std::string bytes;
  for (int i = 1; i < 400; ++i)
    bytes += datagram(tuioCursors(i, {{1, 0.001F * static_cast<float>(i), 0.5F}}));
  stream_.feed(bytes);
  const long before = test::allocations;
  while (sink_.touch.size() < 399) ASSERT_TRUE(device_->poll(stream_));
#ifndef MERLIN_THREAD_SANITIZER
  EXPECT_EQ(test::allocations, before);
#endif
}

TEST_F(TuioTest, DamagedDatagramsGiveNoSampleThatIsNotPlausible) {
  connect();
  Random random(5);
  int frame = 1;
  for (int i = 0; i < 30'000; ++i) {
    const float x = static_cast<float>(random.uniform()), y = static_cast<float>(random.uniform());
    std::string bytes = random.below(4)
                            ? tuioCursors(frame++, {{static_cast<int>(random.below(20)), x, y}},
                                          {1000, static_cast<int>(random.below(3))}, "a@b")
                            : tuioObject(frame++, {static_cast<int>(random.below(20)), x, y});
    for (std::uint64_t n = random.below(3); n > 0; --n)
      bytes[random.below(bytes.size())] = static_cast<char>(random.next());
    if (random.below(20) == 0) bytes.resize(random.below(bytes.size()) + 1);
    stream_.feed(datagram(bytes, static_cast<std::uint32_t>(random.below(3))));
    ASSERT_TRUE(device_->poll(stream_));
  }
  EXPECT_GT(sink_.touch.size(), 1000u);
  EXPECT_GT(device_->counters().bad_packets, 1000u);
  for (const TouchSample& s : sink_.touch) ASSERT_TRUE(plausible(s));
}

TEST(TuioSettings, OtherPortsThanThoseOfDatagramsAreRefused) {
  LineSettings line;
  line.driver = "tuio";
  for (const char* good : {"", "udp:3333", "udp://0.0.0.0:3333", "replay:x", "pty:/tmp/x"}) {
    line.port = good;
    EXPECT_TRUE(validate(TuioSettings{}, line).empty()) << good;
  }
  line.port = "tcp://lab:3333";
  ASSERT_EQ(validate(TuioSettings{}, line).size(), 1u);
  EXPECT_EQ(validate(TuioSettings{}, line)[0].pointer, "/port");
}

}  // namespace
}  // namespace merlin::tuio
