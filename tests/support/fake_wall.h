// FakeWall: the wall's real loop on a virtual clock, with a fake painter, whose frames take a
// simulated time, and a fake feed, which delivers the input that the test sets.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/wall/wall_loop.h"
#include "render/content/model_content.h"
#include "tests/support/fake_clock.h"

namespace merlin::wall {

using render::lod::Dendrogram;
using std::chrono::microseconds;
using std::chrono::milliseconds;

inline const Duration kPeriod = fromSeconds(1.0 / 30);

const Dendrogram& model();

// A painter whose frame takes 4 ms plus `per_triangle` for each triangle. A refined frame of full
// detail takes `slices` slices of 3 ms; at any other step it takes as many slices as its triangles
// need.
class FakePainter final : public render::frame::FramePainter {
 public:
  FakePainter(test::FakeClock& clock, Duration per_triangle, int slices)
      : clock_(clock), per_triangle_(per_triangle), slices_(slices) {}

  render::frame::DrawTimes draw(const Request& request) override;
  void setSizeDivisor(int now) override { divisor = now; }
  bool sees(const Eigen::Isometry3f& T_eye_model) const override {
    return T_eye_model.translation().norm() < furthest_seen_m;
  }
  std::span<const render::frame::FrameStep> steps() const noexcept override { return steps_; }
  void beginRefining(const Eigen::Isometry3f&, std::size_t step) override;
  bool refine(Timestamp until) override;
  std::span<std::uint8_t> pixels() noexcept override { return pixels_; }

  static constexpr std::uint8_t kMoving = 0, kRefined = 90;
  std::vector<std::uint8_t> pixels_;  // the size is set by the test

  void setCost(Duration per_triangle) { per_triangle_ = per_triangle; }

  int slow = 1, divisor = 1;
  float furthest_seen_m = 50;
  std::function<void()> on_draw = [] {};
  bool gives_way = false;
  // What is missing in the frames drawn. Data that have arrived are drawn in the next refined
  // frame.
  render::content::Pending left_out = render::content::Pending::kNothing;
  render::content::Pending pending() const noexcept override { return left_out; }
  int refined = 0;  // number of times that a frame of full detail was begun
  std::vector<Timestamp> drawn;
  std::vector<std::size_t> steps_drawn;

 private:
  Duration costOf(std::size_t level) const;
  test::FakeClock& clock_;
  Duration per_triangle_;
  int slices_, left_ = 0;
  std::vector<render::frame::FrameStep> steps_;
};

// Its input turns the ball while `pushed` is true, and adds the actions and the hand that the test
// sets.
class FakeFeed final : public InputFeed {
 public:
  WallInput read(Timestamp now) override;
  void lookAhead(Duration until_visible) override { ahead = until_visible; }
  Duration age() const noexcept override { return milliseconds(7); }

  bool pushed = true;
  WallInput actions;  // held actions, and actions requested since the last read
  std::optional<TrackerSample> hand;
  // the last value passed to lookAhead(): how far ahead poses are to be predicted
  Duration ahead{};
  std::function<void(Timestamp)> on_begin;
  std::vector<Timestamp> begins;
};

struct RecordedFrames {
  std::vector<render::out::FrameInfo> frames;
  std::vector<std::uint8_t> firsts;  // the first byte of each frame
};

class RecordingOutput final : public render::out::Output {
 public:
  RecordingOutput(RecordedFrames& recorded, const Clock& clock)
      : recorded_(recorded), clock_(clock) {}
  Result<std::optional<Timestamp>> present(const render::out::Signal& signal,
                                           const render::out::FrameInfo& info) override;

 private:
  RecordedFrames& recorded_;
  const Clock& clock_;
};

class FakeWall : public testing::Test {
 protected:
  explicit FakeWall(Duration per_triangle = microseconds(10), int slices = 40,
                    const render::governor::GovernorSettings& settings = {});
  ~FakeWall() override;

  // Runs the loop until `seconds` of virtual time have passed. `on_begin` is called whenever the
  // loop reads its input, with the time of reading.
  void run(double seconds, const std::function<void(Timestamp)>& on_begin = {});
  WallParts parts();
  shm::WallStats stats() const { return *stats_->read(); }
  render::out::OutputSet recordingOutputs();

  test::FakeClock clock_;
  render::out::TimerFrameClock frame_clock_{clock_};
  FakePainter painter_;
  render::content::ModelDetail detail_{model()};
  std::vector<ShownContent> contents_ = {{&detail_, &painter_}};
  render::scene::Scene scene_ = *render::scene::Scene::make({});
  render::governor::Governor governor_;
  FakeFeed feed_;
  RecordedFrames frames_;
  render::tiles::TilePlan plan_ = *render::tiles::planTiles({});
  render::out::OutputSet outputs_ = recordingOutputs();
  std::unique_ptr<render::frame::Delivery> delivery_;
  std::unique_ptr<shm::SeqSlot<shm::WallStats>> stats_ =
      std::make_unique<shm::SeqSlot<shm::WallStats>>();
  std::unique_ptr<shm::Channel<shm::FrameTrace>> trace_ =
      std::make_unique<shm::Channel<shm::FrameTrace>>();
  render::frame::Curtain curtain_;
  PlaylistSettings playlist_;
  std::vector<std::size_t> playlist_places_;
  std::unique_ptr<Attendance> attendance_;
  render::frame::PointerMarker* marker_ = nullptr;
  std::vector<std::unique_ptr<render::frame::Correction>> corrections_;
  ContentSource* replacements_ = nullptr;
  ViewerPlace* viewer_ = nullptr;
  std::function<void()> on_snapshot_ = [] {};
  std::function<std::uint32_t()> snapshots_written_ = [] { return 0U; };
  std::function<void(const AlignInput&)> on_align_ = [](const AlignInput&) {};
  std::size_t first_content_ = 0, listed_ = 0;
  std::unique_ptr<shm::SeqSlot<shm::WallInteraction>> interaction_ =
      std::make_unique<shm::SeqSlot<shm::WallInteraction>>();
  std::unique_ptr<shm::SeqSlot<shm::WallOutputs>> output_stats_ =
      std::make_unique<shm::SeqSlot<shm::WallOutputs>>();
  std::unique_ptr<shm::SeqSlot<shm::WallContent>> content_ =
      std::make_unique<shm::SeqSlot<shm::WallContent>>();
  std::stop_source stop_;
  WallLoop* loop_ = nullptr;  // null when the loop does not run
  bool calibrated_ = false;
  int fade_frames_ = 1;
  double return_after_s_ = 0;
  int first_frames_ = 0;
};

}  // namespace merlin::wall
