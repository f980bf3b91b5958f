// A space mouse that is read through spacenavd: its frames, and the driver's dialogue in both
// versions of the protocol.
#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "drivers/spacenav/device.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/recording_sink.h"

namespace merlin::spacenav {
namespace {

std::vector<Frame> parse(Parser& parser, std::string_view bytes) {
  std::vector<Frame> frames;
  for (const char c : bytes) {
    if (const auto frame = parser.feed(static_cast<std::byte>(c))) frames.push_back(*frame);
  }
  return frames;
}

std::string nameAnswer(const std::string& text, std::int32_t left) {
  Frame frame{kDeviceName};
  std::copy(text.begin(), text.end(), reinterpret_cast<char*>(&frame[1]));
  frame[7] = left;
  return encode(frame);
}

const Frame kPush{kMotion, 350, -350, 175, 0, 20, -700, 16};

TEST(SpacenavParser, ReadsWhatItEncodes) {
  Parser parser;
  const auto frames = parse(parser, encode(kPush) + encode({kPress, 3, 1}));
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0], kPush);
  EXPECT_EQ(frames[1][1], 3);
  EXPECT_EQ(parser.badBytes(), 0u);
}

TEST(SpacenavParser, FindsTheNextFrameAfterRubbish) {
  Parser parser;
  const auto frames = parse(parser, std::string(7, '\xFF') + encode(kPush));
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0], kPush);
  EXPECT_EQ(parser.badBytes(), 7u);
  EXPECT_EQ(parser.badPackets(), 1u);
}

TEST(SpacenavParser, ANamesPiecesAreCutAtTheirLength) {
  Parser parser;
  const auto frames = parse(parser, nameAnswer("ABCDEFGHIJKLMNOPQRSTUVWX", 26) +
                                        nameAnswer("YZ", 2 | 0x10000) + nameAnswer("", kFailed));
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(namePiece(frames[0])->text, "ABCDEFGHIJKLMNOPQRSTUVWX");
  EXPECT_FALSE(namePiece(frames[0])->complete);
  EXPECT_EQ(namePiece(frames[1])->text, "YZ");
  EXPECT_TRUE(namePiece(frames[1])->complete);
  EXPECT_FALSE(namePiece(frames[2]));
}

class SpacenavTest : public testing::Test {
 protected:
  // Connects the driver; the stream answers as spacenavd 1.x does.
  void connect() {
    stream_.feed(encodeWord(kHello));
    stream_.feed(nameAnswer("SpaceNavigator", 14));
    const auto identity = device_.open(stream_);
    ASSERT_TRUE(identity) << identity.error().what;
    EXPECT_EQ(*identity, "SpaceNavigator");
  }
  void feed(const Frame& frame) {
    stream_.feed(encode(frame));
    ASSERT_TRUE(device_.poll(stream_));
  }

  test::FakeClock clock_;
  test::RecordingSink sink_;
  test::FakeStream stream_{clock_, nullptr};
  SpacenavDevice device_{{}, clock_, sink_};
};

TEST_F(SpacenavTest, AsksForTheNameAndStreams) {
  connect();
  EXPECT_EQ(stream_.written(), encodeWord(kHello) + encode({kDeviceName}));
  feed(kPush);
  ASSERT_EQ(sink_.ball.size(), 1u);
  const BallSample& s = sink_.ball[0];
  EXPECT_FLOAT_EQ(s.translation[0], 1);
  EXPECT_FLOAT_EQ(s.translation[1], -1);
  EXPECT_FLOAT_EQ(s.translation[2], -165.0F / 340);  // spacenavd's z points away from the person
  EXPECT_FLOAT_EQ(s.rotation[0], 0);
  EXPECT_FLOAT_EQ(s.rotation[1], 10.0F / 340);
  EXPECT_FLOAT_EQ(s.rotation[2], 1);
  EXPECT_EQ(s.raw[5], -700);
  EXPECT_EQ(s.counter, 1u);
}

TEST_F(SpacenavTest, OneOfVersion0IsToldItsSensitivityAndItsFirstEventIsKept) {
  stream_.feed(encode(kPush).substr(0, 4));  // an event arrives instead of the echo
  const auto identity = device_.open(stream_);
  ASSERT_TRUE(identity);
  EXPECT_EQ(*identity, "space mouse");
  EXPECT_EQ(stream_.written(), encodeWord(kHello) + encodeWord(0x3F800000));
  stream_.feed(encode(kPush).substr(4));
  ASSERT_TRUE(device_.poll(stream_));
  ASSERT_EQ(sink_.ball.size(), 1u);
  EXPECT_FLOAT_EQ(sink_.ball[0].translation[0], 1);
}

TEST_F(SpacenavTest, AHeldPushIsPublishedAgainUntilItEnds) {
  connect();
  feed(kPush);
  const Timestamp pushed = clock_.now();
  while (clock_.now() < pushed + std::chrono::seconds(1)) ASSERT_TRUE(device_.poll(stream_));
  EXPECT_EQ(sink_.ball.size(), 21u);  // every 50 ms
  for (std::size_t i = 1; i < sink_.ball.size(); ++i) {
    EXPECT_EQ(sink_.ball[i].counter, i + 1);
    EXPECT_FLOAT_EQ(sink_.ball[i].translation[0], 1);
  }
  feed({kMotion});
  const std::size_t ended = sink_.ball.size();
  EXPECT_FLOAT_EQ(sink_.ball.back().translation[0], 0);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(device_.poll(stream_));
  EXPECT_EQ(sink_.ball.size(), ended);  // at rest the mouse is silent, which is no fault
}

TEST_F(SpacenavTest, ButtonsAreBitsAndOnesThatABallLacksAreLeftOut) {
  connect();
  feed({kPress, 0, 1});
  feed({kPress, 11, 1});
  EXPECT_EQ(sink_.ball.back().buttons, 0x801u);
  feed({kPress, 12, 1});
  feed({kPress, -1, 1});
  EXPECT_EQ(sink_.ball.size(), 2u);
  feed({kRelease, 0, 0});
  EXPECT_EQ(sink_.ball.back().buttons, 0x800u);
}

TEST_F(SpacenavTest, AnUnpluggedMouseIsAComplaintAndNothingIsPressedAnyMore) {
  connect();
  feed(kPush);
  feed({kPress, 2, 1});
  feed({kDevice, 1});
  EXPECT_STREQ(device_.complaint(), "spacenavd has no space mouse");
  EXPECT_EQ(sink_.ball.back().buttons, 0u);
  EXPECT_FLOAT_EQ(sink_.ball.back().translation[0], 0);
  feed({kDevice, 0});
  EXPECT_STREQ(device_.complaint(), "");
}

TEST_F(SpacenavTest, WhatWasHeldWhenSpacenavdEndedIsReleasedWhenItReturns) {
  connect();
  feed({kPress, 0, 1});
  connect();
  ASSERT_EQ(sink_.ball.size(), 2u);
  EXPECT_EQ(sink_.ball.back().buttons, 0u);
  connect();
  EXPECT_EQ(sink_.ball.size(), 2u) << "nothing was held any more";
  feed(kPush);
  connect();
  EXPECT_FLOAT_EQ(sink_.ball.back().translation[0], 0);
}

TEST_F(SpacenavTest, AHeldButtonActsWhenItIsDue) {
  connect();
  feed({kPress, 0, 1});
  sink_.due_at = clock_.now() + std::chrono::milliseconds(70);
  const std::vector due = {sink_.due_at};
  ASSERT_TRUE(device_.poll(stream_));
  EXPECT_EQ(sink_.ticks, due);
}

// spacenavd reports that a mouse was unplugged, but not whether another mouse is left.
TEST_F(SpacenavTest, OfTwoMiceTheOneThatIsLeftIsTheSpaceMouse) {
  connect();
  feed({kDevice, 1});
  feed({kRelease, 0, 0});
  EXPECT_STREQ(device_.complaint(), "spacenavd has no space mouse");
  feed(kPush);
  EXPECT_STREQ(device_.complaint(), "");
  feed({kDevice, 1});
  EXPECT_STREQ(device_.complaint(), "spacenavd has no space mouse");
  feed({kPress, 2, 1});
  EXPECT_STREQ(device_.complaint(), "");
}

TEST_F(SpacenavTest, OneWithoutAMouseIsSaidToHaveNone) {
  stream_.feed(encodeWord(kHello));
  stream_.feed(nameAnswer("", kFailed));
  ASSERT_TRUE(device_.open(stream_));
  EXPECT_STREQ(device_.complaint(), "spacenavd has no space mouse");
}

TEST_F(SpacenavTest, OneThatNeverAnswersTheQuestionIsRefusedInTime) {
  stream_.feed(encodeWord(kHello));
  const Timestamp began = clock_.now();
  EXPECT_EQ(device_.open(stream_).error().code, Errc::kTimeout);
  EXPECT_LE(clock_.now() - began, std::chrono::milliseconds(1300));
}

TEST_F(SpacenavTest, RandomBytesGiveNoSampleThatIsNotPlausible) {
  connect();
  Random random(7);
  for (int i = 0; i < 200'000; ++i) {
    std::string bytes;
    for (int n = 0; n < 8; ++n)
      bytes += static_cast<char>(random.below(3) == 0 ? random.below(256) : 0);
    stream_.feed(bytes);
    ASSERT_TRUE(device_.poll(stream_));
  }
  EXPECT_GT(sink_.ball.size(), 100u);
  for (const BallSample& s : sink_.ball) {
    for (const float v : s.translation) ASSERT_LE(std::abs(v), 1);
    ASSERT_EQ(s.buttons >> 12, 0u);
  }
}

TEST(SpacenavSettings, AnAxisMapHasEachAxisOnce) {
  SpacenavSettings settings;
  EXPECT_TRUE(validate(settings, {}).empty());
  settings.axis_map = {1, 1, 3, 4, 5, 6};
  ASSERT_EQ(validate(settings, {}).size(), 1u);
  EXPECT_EQ(validate(settings, {})[0].pointer, "/spacenav/axis_map");
}

}  // namespace
}  // namespace merlin::spacenav
