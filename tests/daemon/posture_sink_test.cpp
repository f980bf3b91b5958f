#include "daemon/devices/posture_sink.h"

#include <gtest/gtest.h>

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
  nn::NetworkFile file_ = *nn::loadNetwork(MERLIN_SOURCE_DIR "/config/postures.json");
  std::unique_ptr<shm::Channel<PostureSample>> postures_ =
      std::make_unique<shm::Channel<PostureSample>>();
  test::RecordingSink next_;
  shm::SeqSlot<PostureState> held_;
  PostureSink sink_{file_.network, {}, {*postures_, held_}, next_};
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

}  // namespace
}  // namespace merlin::devices
