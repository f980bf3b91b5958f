#include "daemon/devices/posture_sink.h"

#include <gtest/gtest.h>

#include "daemon/devices/continued_counts.h"
#include "drivers/hand/shapes.h"
#include "nn/io/network_file.h"
#include "tests/support/recording_sink.h"

namespace merlin::devices {
namespace {

GloveSample showing(const char* shape, std::uint32_t counter) {
  GloveSample sample{};
  sample.counter = counter;
  sample.received_ns = 1000 + counter;
  const auto& angles = hand::findShape(shape)->angle_rad;
  std::copy(angles.begin(), angles.end(), sample.angle_rad);
  return sample;
}

class PostureSinkTest : public testing::Test {
 protected:
  nn::TrainedPostures file_ =
      nn::trainedPostures(*nn::loadNetwork(MERLIN_SOURCE_DIR "/config/postures.json"));
  std::unique_ptr<shm::Channel<PostureSample>> postures_ =
      std::make_unique<shm::Channel<PostureSample>>();
  test::RecordingSink next_;
  shm::SeqSlot<PostureState> held_;
  PostureSink sink_{file_, {}, {*postures_, held_}, next_};
};

TEST_F(PostureSinkTest, RecognisesEachShippedShapeAndHandsTheSampleOn) {
  std::uint32_t counter = 0;
  for (const hand::Shape& shape : hand::shapes()) {
    sink_.publish(showing(shape.name, ++counter));
    EXPECT_STREQ(postures_->newest()->name, shape.name);
    EXPECT_EQ(postures_->newest()->counter, counter);
  }
  EXPECT_EQ(next_.glove.size(), hand::shapes().size());
}

TEST_F(PostureSinkTest, SaysSinceWhenAPostureLasts) {
  sink_.publish(showing("open", 1));
  sink_.publish(showing("fist", 2));
  sink_.publish(showing("fist", 3));
  EXPECT_EQ(postures_->newest()->since_ns, 1002);
  EXPECT_EQ(postures_->newest()->received_ns, 1003);
}

TEST_F(PostureSinkTest, HoldsAPostureThatLasts) {
  GloveSample fist = showing("fist", 1);
  for (std::int64_t ms = 0; ms < 200; ms += 10) {
    fist.received_ns = 1'000'000'000 + ms * 1'000'000;
    sink_.publish(fist);
    EXPECT_STREQ(held_.read()->name, ms < 150 ? "" : "fist") << ms;
    EXPECT_STREQ(held_.read()->seen, "fist");
  }
  EXPECT_EQ(held_.read()->since_ns, 1'000'000'000);
  EXPECT_EQ(held_.read()->entered, 1u);
  EXPECT_GT(held_.read()->margin, 0.5F);
}

TEST_F(PostureSinkTest, AHandThatIsNoneHasNoName) {
  GloveSample broken = showing("fist", 1);
  broken.angle_rad[5] = std::numeric_limits<float>::quiet_NaN();
  sink_.publish(broken);
  EXPECT_STREQ(postures_->newest()->name, "");
}

TEST_F(PostureSinkTest, ANewHoldEndsThePostureAndBeginsItAnew) {
  GloveSample fist = showing("fist", 1);
  const auto show = [&](std::int64_t ms) {
    fist.received_ns = 1'000'000'000 + ms * 1'000'000;
    sink_.publish(fist);
  };
  for (std::int64_t ms = 0; ms < 200; ms += 10) show(ms);
  ASSERT_STREQ(held_.read()->name, "fist");
  sink_.reload(file_, {{.hold_s = 0.05}, {}});
  show(200);
  EXPECT_STREQ(held_.read()->name, "");
  EXPECT_EQ(held_.read()->entered, 1u) << "counts go on";
  for (std::int64_t ms = 210; ms < 260; ms += 10) show(ms);
  EXPECT_STREQ(held_.read()->name, "fist");
  EXPECT_EQ(held_.read()->entered, 2u);
}

TEST_F(PostureSinkTest, WithoutANetworkNoPostureIsSeen) {
  sink_.publish(showing("fist", 1));
  sink_.reload(std::nullopt, {});
  sink_.publish(showing("fist", 2));
  EXPECT_STREQ(postures_->newest()->name, "");
  sink_.publish(showing("fist", 3));
  EXPECT_EQ(postures_->newest()->counter, 2u) << "nothing is published any more";
  sink_.reload(file_, {});
  sink_.publish(showing("fist", 4));
  EXPECT_STREQ(postures_->newest()->name, "fist");
  EXPECT_EQ(next_.glove.size(), 4u);
}

// The chain is due when the sink behind it is due, and passes on the tick.
TEST(ContinuedCounts, PassOnWhatIsDue) {
  test::RecordingSink samples;
  test::RecordingHealth healths;
  ContinuedCounts counts(samples, healths);
  EXPECT_EQ(counts.due(), Timestamp::max());
  const Timestamp due{std::chrono::seconds(7)};
  samples.due_at = due;
  EXPECT_EQ(counts.due(), due);
  counts.tick(due);
  EXPECT_EQ(samples.ticks, std::vector{due});
}

TEST(ContinuedCounts, GoOnWhereTheDeviceIsMadeAnew) {
  test::RecordingSink samples;
  test::RecordingHealth healths;
  ContinuedCounts counts(samples, healths);
  const auto ball = [&](std::uint32_t counter) {
    BallSample sample{};
    sample.counter = counter;
    counts.publish(sample);
    return samples.ball.back().counter;
  };
  const auto tracker = [&](std::uint32_t station, std::uint32_t counter) {
    TrackerSample sample{};
    sample.station = station;
    sample.counter = counter;
    counts.publish(sample);
    return samples.tracker.back().counter;
  };
  const auto health = [&](std::uint64_t n) {
    DeviceHealth h{};
    h.samples = n;
    h.bad_bytes = 1;
    h.reconnects = 2;
    counts.publish(h);
    return healths.last();
  };
  EXPECT_EQ(ball(7), 7u);
  EXPECT_EQ(tracker(1, 5), 5u);
  EXPECT_EQ(tracker(4, 9), 9u);
  EXPECT_EQ(health(12).samples, 12u);
  counts.restart();
  EXPECT_EQ(ball(1), 8u);
  EXPECT_EQ(tracker(1, 1), 6u);
  EXPECT_EQ(tracker(4, 2), 11u);
  EXPECT_EQ(health(3).samples, 15u);
  EXPECT_EQ(healths.last().bad_bytes, 2u);
  EXPECT_EQ(healths.last().reconnects, 5u) << "the line was opened once more";
  counts.restart();
  EXPECT_EQ(ball(1), 9u);
}

// A glove whose sensors drift, each in its own direction, while its wearer shows the postures one
// by one for 0.4 s each.
class DriftingGlove {
 public:
  explicit DriftingGlove(const nn::TrainedPostures& postures) : ranges_(postures.network.ranges) {}

  // Shows every shape once, with the sensors drifted by `drift`, a share of each sensor's range.
  // Returns how many of the eight shapes were recognised at their last sample.
  int show(PostureSink& sink, const shm::Channel<PostureSample>& seen, float drift) {
    int right = 0;
    for (const hand::Shape& shape : hand::shapes()) {
      for (int hand = 0; hand < 40; ++hand) {
        ++counter_;
        GloveSample sample = showing(shape.name, counter_);
        sample.received_ns = std::int64_t{counter_} * 10'000'000;
        for (std::size_t i = 0; i < std::size(sample.angle_rad); ++i) {
          const float range = ranges_[i].high - ranges_[i].low;
          sample.angle_rad[i] += (i % 2 == 0 ? drift : -drift) * range;
        }
        sink.publish(sample);
      }
      right += std::string_view(seen.newest()->name) == shape.name;
    }
    return right;
  }
  // Simulates that no sample comes from the glove, as when it is unplugged.
  void pause() { counter_ += 200; }

 private:
  nn::InputRanges ranges_;
  std::uint32_t counter_ = 1000;
};

constexpr float kDrifted = 0.27F;

// Returns how many of eight postures are recognised at the end of a slow drift.
int rightAfterDrift(PostureSink& sink, const shm::Channel<PostureSample>& seen,
                    DriftingGlove& glove) {
  constexpr int kRounds = 100;
  int right = 0;
  for (int round = 0; round <= kRounds; ++round)
    right = glove.show(sink, seen, kDrifted * static_cast<float>(round) / kRounds);
  return right;
}

TEST_F(PostureSinkTest, FollowsASlowDriftAndForgetsItWhenTheGloveIsBack) {
  DriftingGlove glove(file_);
  EXPECT_EQ(rightAfterDrift(sink_, *postures_, glove), 8);
  glove.pause();
  EXPECT_EQ(glove.show(sink_, *postures_, 0), 8) << "the drift is forgotten";
}

TEST_F(PostureSinkTest, WithoutFollowingTheSameDriftIsTakenForOtherPostures) {
  PostureSink still{file_, {{}, {.share = 0}}, {*postures_, held_}, next_};
  DriftingGlove glove(file_);
  EXPECT_LT(rightAfterDrift(still, *postures_, glove), 7);
}

TEST_F(PostureSinkTest, ANetworkWithoutStatisticsRecognisesAndFollowsNothing) {
  PostureSink plain{nn::TrainedPostures{file_.network, {}}, {}, {*postures_, held_}, next_};
  DriftingGlove glove(file_);
  EXPECT_EQ(glove.show(plain, *postures_, 0), 8);
  EXPECT_LT(rightAfterDrift(plain, *postures_, glove), 7);
}

}  // namespace
}  // namespace merlin::devices
