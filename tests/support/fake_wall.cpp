#include "tests/support/fake_wall.h"

#include <algorithm>

#include "tests/support/wavy_sheet.h"

namespace merlin::wall {

const Dendrogram& model() {
  static const Dendrogram made = test::wavySheet();
  return made;
}

render::frame::DrawTimes FakePainter::draw(const Request& request) {
  on_draw();
  const Duration fixed = milliseconds(4) / (divisor * divisor);
  const Duration drawing = costOf(request.step) * slow;
  const Timestamp began = clock_.now();
  clock_.advance(drawing);
  const Timestamp read = clock_.now();
  std::fill(pixels_.begin(), pixels_.end(), kMoving);
  clock_.advance(fixed);
  drawn.push_back(clock_.now());
  steps_drawn.push_back(request.step);
  using Kind = render::frame::FrameStep::Kind;
  steps_ = {{Kind::kChoose, 0, began, began},
            {Kind::kDraw, 0, began, read},
            {Kind::kReadBack, 0, read, clock_.now()}};
  return {drawing, fixed, gives_way};
}

void FakePainter::beginRefining(const Eigen::Isometry3f&, std::size_t step) {
  refined += step == 0 ? 1 : 0;
  if (left_out == render::content::Pending::kArrived) left_out = render::content::Pending::kNothing;
  left_ = step == 0 ? slices_ : static_cast<int>(costOf(step) / milliseconds(3)) + 1;
}

bool FakePainter::refine(Timestamp until) {
  steps_.clear();
  while (clock_.now() + milliseconds(3) < until) {
    clock_.advance(milliseconds(3));
    if (--left_ > 0) continue;
    std::fill(pixels_.begin(), pixels_.end(), kRefined);
    return true;
  }
  return false;
}

Duration FakePainter::costOf(std::size_t level) const {
  return per_triangle_ * static_cast<std::int64_t>(model().trianglesAt(level));
}

WallInput FakeFeed::read(Timestamp now) {
  begins.push_back(now);
  if (on_begin) on_begin(now);
  WallInput input = actions;
  actions.next_content = actions.previous_content = actions.snapshot = 0;
  actions.blank = actions.freeze = 0;
  actions.align = {};
  input.scene.ball.emplace();
  input.scene.ball->rotation[1] = pushed ? 0.5F : 0.0F;
  input.scene.hand = hand;
  return input;
}

Result<std::optional<Timestamp>> RecordingOutput::present(const render::out::Signal& signal,
                                                          const render::out::FrameInfo& info) {
  recorded_.frames.push_back(info);
  recorded_.firsts.push_back(signal.pixels.empty() ? std::uint8_t{0} : signal.pixels[0]);
  return std::optional(clock_.now());
}

FakeWall::FakeWall(Duration per_triangle, int slices,
                   const render::governor::GovernorSettings& settings)
    : painter_(clock_, per_triangle, slices), governor_(settings) {}

FakeWall::~FakeWall() = default;

void FakeWall::run(double seconds, const std::function<void(Timestamp)>& on_begin) {
  const Timestamp end = clock_.now() + fromSeconds(seconds);
  feed_.on_begin = [&, end](Timestamp now) {
    if (on_begin) on_begin(now);
    if (now >= end) stop_.request_stop();
  };
  WallLoop loop(parts());
  loop_ = &loop;
  if (calibrated_) loop.calibrate();
  loop.run(stop_.get_token(), [&] { ++first_frames_; });
}

WallParts FakeWall::parts() {
  std::vector<render::frame::Overlay*> overlays = {&curtain_};
  if (marker_) overlays.insert(overlays.begin(), marker_);
  delivery_ = std::make_unique<render::frame::Delivery>(plan_, outputs_, std::move(overlays),
                                                        std::move(corrections_));
  attendance_ = std::make_unique<Attendance>(playlist_);
  return {.contents = contents_,
          .scene = scene_,
          .governor = governor_,
          .feed = feed_,
          .delivery = *delivery_,
          .slots = {*stats_, trace_.get(), interaction_.get(), output_stats_.get(), content_.get()},
          .clock = clock_,
          .frame_clock = frame_clock_,
          .attendance = *attendance_,
          .curtain = &curtain_,
          .marker = marker_,
          .fade_frames = fade_frames_,
          .return_after_s = return_after_s_,
          .replacements = replacements_,
          .viewer = viewer_,
          .on_snapshot = on_snapshot_,
          .snapshots_written = snapshots_written_,
          .on_align = on_align_,
          .first_content = first_content_,
          .listed = listed_,
          .playlist = playlist_places_};
}

render::out::OutputSet FakeWall::recordingOutputs() {
  std::vector<render::out::NamedOutput> outputs;
  outputs.push_back({"recorder", "fake", std::make_unique<RecordingOutput>(frames_, clock_)});
  return render::out::OutputSet(std::move(outputs));
}

}  // namespace merlin::wall
