// The wall's frame clock on a virtual clock: a painter that costs what a model of the renderer
// says.
#include "daemon/wall/wall_loop.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "render/reduce/reduce.h"
#include "tests/support/fake_clock.h"

namespace merlin::wall {
namespace {

using render::Dendrogram;
using std::chrono::microseconds;
using std::chrono::milliseconds;

const Duration kPeriod = fromSeconds(1.0 / 30);

// A wavy sheet of 5,000 triangles, reduced to the end.
const Dendrogram& model() {
  static const Dendrogram made = [] {
    render::Mesh mesh;
    constexpr std::uint32_t kSide = 51;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const auto x = static_cast<float>(i % kSide), y = static_cast<float>(i / kSide);
      mesh.positions.insert(mesh.positions.end(), {x, y, std::sin(x / 5) + std::cos(y / 7)});
      if (i % kSide + 1 == kSide || i / kSide + 1 == kSide) continue;
      mesh.triangles.insert(mesh.triangles.end(),
                            {i, i + 1, i + kSide, i + 1, i + kSide + 1, i + kSide});
    }
    render::ensureNormals(mesh);
    return render::buildDendrogram(mesh, render::reduce(mesh, {})->log);
  }();
  return made;
}

// 4 ms a frame and `per_triangle` each; full detail costs `slices` of 3 ms.
class FakePainter final : public Painter {
 public:
  FakePainter(test::FakeClock& clock, Duration per_triangle, int slices)
      : clock_(clock), per_triangle_(per_triangle), slices_(slices) {}

  DrawTimes draw(const Eigen::Isometry3f&, std::size_t level, Timestamp) override {
    const Duration fixed = milliseconds(4);
    const Duration drawing =
        per_triangle_ * static_cast<std::int64_t>(model().trianglesAt(level)) * slow;
    clock_.advance(fixed + drawing);
    drawn.push_back(clock_.now());
    return {drawing, fixed, false};
  }
  void beginRefining(const Eigen::Isometry3f&) override { left_ = slices_; }
  bool refine(Timestamp until) override {
    while (clock_.now() + milliseconds(3) < until) {
      clock_.advance(milliseconds(3));
      if (--left_ == 0) return true;
    }
    return false;
  }
  std::span<const std::uint8_t> pixels() const noexcept override { return {}; }

  int slow = 1;
  std::vector<Timestamp> drawn;

 private:
  test::FakeClock& clock_;
  Duration per_triangle_;
  int slices_, left_ = 0;
};

// Pushes the ball while `pushed`; asks the loop to stop after `until`.
class FakeFeed final : public InputFeed {
 public:
  render::SceneInput read(Timestamp now) override {
    begins.push_back(now);
    if (on_begin) on_begin(now);
    render::SceneInput input;
    input.ball.emplace();
    input.ball->rotation[1] = pushed ? 0.5F : 0.0F;
    return input;
  }
  Duration age() const noexcept override { return milliseconds(7); }

  bool pushed = true;
  std::function<void(Timestamp)> on_begin;
  std::vector<Timestamp> begins;
};

struct RecordingFrames final : render::FrameSink {
  void present(std::span<const std::uint8_t>, const render::FrameInfo& info) override {
    frames.push_back(info);
  }
  std::vector<render::FrameInfo> frames;
};

class WallLoopTest : public testing::Test {
 protected:
  // Runs for `seconds` of virtual time.
  void run(double seconds, const std::function<void(Timestamp)>& on_begin = {}) {
    const Timestamp end = clock_.now() + fromSeconds(seconds);
    feed_.on_begin = [&, end](Timestamp now) {
      if (on_begin) on_begin(now);
      if (now >= end) stop_.request_stop();
    };
    WallLoop loop({model(), painter_, scene_, governor_, feed_, {&frames_}, *stats_, clock_});
    loop.run(stop_.get_token(), [&] { ++first_frames_; });
  }
  shm::WallStats stats() const { return *stats_->read(); }

  test::FakeClock clock_;
  FakePainter painter_{clock_, microseconds(10), 40};
  render::Scene scene_ = *render::Scene::make({});
  render::Governor governor_{render::GovernorSettings{}};
  FakeFeed feed_;
  RecordingFrames frames_;
  std::unique_ptr<shm::SeqSlot<shm::WallStats>> stats_ =
      std::make_unique<shm::SeqSlot<shm::WallStats>>();
  std::stop_source stop_;
  int first_frames_ = 0;
};

TEST_F(WallLoopTest, HoldsTheRateWhileItMoves) {
  run(10);
  EXPECT_EQ(first_frames_, 1);
  EXPECT_NEAR(static_cast<double>(frames_.frames.size()), 300, 2);
  EXPECT_NEAR(stats().rate_held_hz, 30, 0.01);
  EXPECT_LE(stats().late, 3u);  // the first frame asks for more than there is time for
  EXPECT_GT(stats().utilisation, 0.80F);
  EXPECT_EQ(stats().moving, 1u);
  EXPECT_FLOAT_EQ(stats().input_age_ms, 7);
}

TEST_F(WallLoopTest, EachPeriodBeginsOnTheGrid) {
  run(3);
  const Timestamp start = feed_.begins.front();
  for (std::size_t i = 10; i < feed_.begins.size(); ++i) {
    EXPECT_EQ((feed_.begins[i] - start) % kPeriod, Duration::zero()) << i;
  }
}

TEST_F(WallLoopTest, EveryDeadlineThatALongFrameMissesCounts) {
  run(4, [&](Timestamp now) {
    painter_.slow = now - feed_.begins.front() > milliseconds(2000) &&
                            now - feed_.begins.front() < milliseconds(2034)
                        ? 5
                        : 1;
  });
  // One frame of about 30 ms became one of about 130 ms: it misses four deadlines, and no frame
  // after it.
  EXPECT_GE(stats().longest_late, 3u);
  EXPECT_LE(stats().longest_late, 5u);
  EXPECT_NEAR(stats().rate_held_hz, 30, 0.01);
}

TEST_F(WallLoopTest, ShowsFullDetailWithinHalfASecondOfStandstill) {
  std::optional<Timestamp> let_go;
  run(4, [&](Timestamp now) {
    feed_.pushed = now - feed_.begins.front() < std::chrono::seconds(2);
    if (!feed_.pushed && !let_go) let_go = now;
  });
  ASSERT_TRUE(let_go);
  const auto full = std::find_if(frames_.frames.begin(), frames_.frames.end(), [&](const auto& f) {
    return f.full_detail && f.finished > *let_go;
  });
  ASSERT_NE(full, frames_.frames.end());
  EXPECT_EQ(full->triangles, model().triangleCount());
  EXPECT_LE(full->finished - *let_go, milliseconds(500));
  EXPECT_EQ(full + 1, frames_.frames.end()) << "a picture that stands is not drawn again";
  EXPECT_EQ(stats().full_detail, 1u);
  EXPECT_NEAR(stats().rate_held_hz, 30, 0.01);
}

// Whenever motion resumes, refining or not, the frame that begins then meets its own deadline.
TEST_F(WallLoopTest, TheFirstFrameAfterMotionResumesIsInTime) {
  std::optional<Timestamp> resumed;
  for (int still_periods = 5; still_periods < 40; ++still_periods) {
    feed_.begins.clear();
    frames_.frames.clear();
    resumed.reset();
    stop_ = std::stop_source();
    run(4, [&](Timestamp now) {
      const auto k = (now - feed_.begins.front()) / kPeriod;
      feed_.pushed = k < 60 || k >= 60 + still_periods;
      if (k >= 60 + still_periods && !resumed) resumed = now;
    });
    ASSERT_TRUE(resumed);
    const auto first = std::find_if(frames_.frames.begin(), frames_.frames.end(),
                                    [&](const auto& f) { return f.finished > *resumed; });
    ASSERT_NE(first, frames_.frames.end());
    EXPECT_LE(first->finished - *resumed, kPeriod) << still_periods;
    EXPECT_FALSE(first->full_detail) << still_periods;
    EXPECT_EQ(stats().resumed, 1u);
    EXPECT_EQ(stats().resumed_late, 0u);
  }
}

TEST_F(WallLoopTest, ARequestIsDoneBeforeTheNextFrame) {
  feed_.pushed = false;
  WallLoop loop({model(), painter_, scene_, governor_, feed_, {&frames_}, *stats_, clock_});
  feed_.on_begin = [&](Timestamp) {
    if (feed_.begins.size() == 3) loop.request(WallLoop::kNextMode);
    if (feed_.begins.size() == 5) stop_.request_stop();
  };
  loop.run(stop_.get_token(), [] {});
  EXPECT_STREQ(stats().mode, "fly");
  EXPECT_GE(loop.periods(), 5u);
}

TEST_F(WallLoopTest, StopsAtOnce) {
  stop_.request_stop();
  WallLoop loop({model(), painter_, scene_, governor_, feed_, {&frames_}, *stats_, clock_});
  loop.run(stop_.get_token(), [] {});
  EXPECT_TRUE(frames_.frames.empty());
}

}  // namespace
}  // namespace merlin::wall
