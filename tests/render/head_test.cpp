// The wall is drawn for the position of the tracked head, and the picture does not change while the
// head is at rest.
#include "render/stereo/head.h"

#include <limits>

#include <gtest/gtest.h>

namespace merlin::render::stereo {
namespace {

using Eigen::Vector3d;
using std::chrono::milliseconds;

constexpr double kStillAfter_s = 0.15;
const tiles::Viewer kConfigured{Vector3d::Zero(), Vector3d(0.06, 0, 0)};

// The transmitter hangs 2 m above the room's origin, with x from the wall to the person.
stereo::HeadSettings overhead() {
  stereo::HeadSettings s;
  s.station = 2;
  s.origin_m = {0, 2, 0};
  return s;
}

TrackerSample at(float x, float y, float z) {
  TrackerSample sample{};
  sample.position_m[0] = x;
  sample.position_m[1] = y;
  sample.position_m[2] = z;
  sample.orientation_wxyz[0] = 1;
  return sample;
}

class HeadTest : public testing::Test {
 protected:
  stereo::Head::View after(const std::optional<TrackerSample>& sample,
                           Duration time = milliseconds(33)) {
    now_ += time;
    return head_.update(sample, now_);
  }
  // Repeats the sample until the head counts as being at rest.
  stereo::Head::View restAt(const std::optional<TrackerSample>& sample) {
    for (int i = 0; i < 10; ++i) after(sample);
    return after(sample);
  }
  stereo::Head head_{overhead(), kConfigured, {0, 1.6, 1}, kStillAfter_s};
  Timestamp now_{std::chrono::hours(1)};
};

// The tracker's x is the room's z, its -y the room's x, its -z the room's y.
TEST_F(HeadTest, IsInTheRoomWhereTheTrackerIsSetUpToSayIt) {
  const stereo::Head::View view = after(at(1.5F, -0.25F, 0.3F));
  EXPECT_TRUE(view.tracked);
  EXPECT_TRUE(view.moving);
  EXPECT_TRUE(view.viewer.place_m.isApprox(Vector3d(0.25, 1.7, 1.5) - Vector3d(0, 1.6, 1), 1e-6))
      << view.viewer.place_m.transpose();
  EXPECT_TRUE(view.viewer.eyes_m.isApprox(Vector3d(0.06, 0, 0)));
}

TEST_F(HeadTest, ScalesWhatTheTrackerSays) {
  stereo::HeadSettings settings = overhead();
  settings.scale = 2;
  stereo::Head head(settings, kConfigured, {0, 0, 0}, kStillAfter_s);
  EXPECT_TRUE(head.update(at(1, 0, 0), now_).viewer.place_m.isApprox(Vector3d(0, 2, 2), 1e-6));
}

// The head is rolled to the left by 90 degrees, about the axis from the wall to the person, so the
// right eye is above the left one.
TEST_F(HeadTest, TurnsTheEyesWithTheHead) {
  TrackerSample rolled = at(1, 0, 0);
  rolled.orientation_wxyz[0] = rolled.orientation_wxyz[1] = 0.70710678F;
  EXPECT_TRUE(after(rolled).viewer.eyes_m.isApprox(Vector3d(0, 0.06, 0), 1e-6));
}

TEST_F(HeadTest, AtRestStaysWhereItIsWithinTheDeadBand) {
  const Vector3d rested = restAt(at(1, 0, 0)).viewer.place_m;
  for (int i = 0; i < 300; ++i) {
    const float jitter = 0.0045F * static_cast<float>(i % 3 - 1);
    const stereo::Head::View view = after(at(1 + jitter, 0, 0));
    ASSERT_FALSE(view.moving) << i;
    ASSERT_EQ(view.viewer.place_m, rested) << "the same picture becomes finer";
  }
}

TEST_F(HeadTest, BeyondTheDeadBandIsTakenAsItIsUntilItRests) {
  const Vector3d rested = restAt(at(1, 0, 0)).viewer.place_m;
  EXPECT_TRUE(after(at(1.006F, 0, 0)).moving);
  const stereo::Head::View small = after(at(1.007F, 0, 0));
  EXPECT_TRUE(small.moving);
  EXPECT_NEAR(small.viewer.place_m.z() - rested.z(), 0.007, 1e-6) << "without a filter";
  const stereo::Head::View at_rest = restAt(at(1.008F, 0, 0));
  EXPECT_FALSE(at_rest.moving);
  EXPECT_NEAR(at_rest.viewer.place_m.z() - rested.z(), 0.008, 1e-6);
}

// A drift of a millimetre a frame counts as motion, since such steps add up.
TEST_F(HeadTest, ThatDriftsIsFollowed) {
  restAt(at(1, 0, 0));
  stereo::Head::View view;
  for (int i = 1; i <= 20; ++i) view = after(at(1 + 0.001F * static_cast<float>(i), 0, 0));
  EXPECT_NEAR(view.viewer.place_m.z(), 1.02 - 1, 0.006);
}

TEST_F(HeadTest, ThatTurnsByLessThanTheDeadBandIsAtRest) {
  restAt(at(1, 0, 0));
  TrackerSample turned = at(1, 0, 0);
  turned.orientation_wxyz[3] = 0.015F;  // half of 1.7 degrees
  EXPECT_FALSE(after(turned).moving);
  turned.orientation_wxyz[3] = 0.02F;
  EXPECT_TRUE(after(turned).moving);
}

TEST_F(HeadTest, ThatIsMissingReturnsToTheConfiguredPlaceWhichIsMotion) {
  restAt(at(1, 0.5F, 0));
  const stereo::Head::View lost = after(std::nullopt);
  EXPECT_FALSE(lost.tracked);
  EXPECT_TRUE(lost.moving);
  EXPECT_EQ(lost.viewer.place_m, kConfigured.place_m);
  EXPECT_EQ(lost.viewer.eyes_m, kConfigured.eyes_m);
  EXPECT_FALSE(restAt(std::nullopt).moving);
  EXPECT_TRUE(after(at(1, 0.5F, 0)).tracked);
}

TEST_F(HeadTest, WithoutFiniteFiguresIsMissing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(after(at(nan, 0, 0)).tracked);
  EXPECT_FALSE(after(at(0, infinity, 0)).tracked);
  EXPECT_FALSE(after(at(0, 1e30F, 0)).tracked);
  TrackerSample none = at(1, 0, 0);
  none.orientation_wxyz[0] = 0;
  EXPECT_FALSE(after(none).tracked) << "no rotation";
  none.orientation_wxyz[2] = nan;
  EXPECT_FALSE(after(none).tracked);
  EXPECT_TRUE(after(at(1, 0, 0)).tracked);
}

}  // namespace
}  // namespace merlin::render::stereo
