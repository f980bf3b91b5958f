#include "tests/bench/soak/virtual_wall.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/shm/fields.h"
#include "render/out/shared_frame.h"
#include "tests/bench/figures.h"
#include "tests/support/wavy_sheet.h"

namespace merlin::bench {
namespace {

namespace out = render::out;

// The frame is small, since drawing takes virtual time only.
constexpr int kWidth = 64, kHeight = 48;
constexpr Duration kPerTriangle = std::chrono::microseconds(6),
                   kFixed = std::chrono::milliseconds(4);
constexpr Duration kSlice = std::chrono::milliseconds(3);
// number of slices of a frame of full detail, which is drawn while nothing moves
constexpr int kSlices = 20;

render::tiles::TilePlan smallPlan() {
  render::tiles::TilesSettings settings;
  settings.frame_width = settings.tile_width = kWidth;
  settings.frame_height = settings.tile_height = kHeight;
  settings.tiles = {{"wall", render::tiles::TileKind::kWall, 0, 0, 0}};
  auto plan = render::tiles::planTiles(settings);
  if (!plan) didNotRun("the wall", plan.error().what, "fix the benchmark");
  return *std::move(plan);
}

// An output that the script can unplug or blacken.
class FaultyOutput final : public out::Output {
 public:
  FaultyOutput(std::unique_ptr<out::Output> inner, const WallFaults& faults)
      : inner_(std::move(inner)), faults_(faults) {}

  Result<std::optional<Timestamp>> present(const out::Signal& signal,
                                           const out::FrameInfo& info) override {
    if (faults_.unplugged) return Error{Errc::kIo, "the display was unplugged"};
    if (!faults_.blackened) return inner_->present(signal, info);
    black_.resize(signal.pixels.size());
    return inner_->present({signal.width, signal.height, black_}, info);
  }
  // Returns true after a change of the fault, so that the change is shown although nothing moves.
  bool wantsFrame(Timestamp) const override { return std::exchange(was_, now()) != now(); }
  bool canReadBack() const override { return true; }
  Result<std::vector<out::DisplayReading>> readBack() override { return inner_->readBack(); }
  Result<std::string> mend() override { return inner_->mend(); }

 private:
  int now() const { return (faults_.unplugged ? 1 : 0) + (faults_.blackened ? 2 : 0); }

  std::unique_ptr<out::Output> inner_;
  const WallFaults& faults_;
  std::vector<std::uint8_t> black_;
  mutable int was_ = 0;
};

}  // namespace

// Draws only a pattern that changes from frame to frame. The time that this takes is that of a
// model of a renderer, with noise and occasional spikes.
class VirtualWall::Painter final : public render::frame::FramePainter {
 public:
  Painter(const VirtualWall& wall, VirtualClock& clock, double cost, std::uint64_t seed)
      : wall_(wall), clock_(clock), cost_(cost), random_(seed), pixels_(4UL * kWidth * kHeight) {}

  render::frame::DrawTimes draw(const Request& request) override {
    const double noise = std::exp(0.04 * normal_(random_)) + (random_() % 2000 == 0 ? 1 : 0);
    const Duration drawing = scaled(costOf(request.step), noise * wall_.faults_.slower);
    const Duration fixed = scaled(kFixed, wall_.faults_.slower / (divisor_ * divisor_));
    const Timestamp began = clock_.now();
    wait(drawing);
    const Timestamp read = clock_.now();
    wait(fixed);
    using Kind = render::frame::FrameStep::Kind;
    steps_ = {{Kind::kChoose, 0, began, began},
              {Kind::kDraw, 0, began, read},
              {Kind::kReadBack, 0, read, clock_.now()}};
    paint();
    return {drawing, fixed, false};
  }
  void beginRefining(const Eigen::Isometry3f&, std::size_t step) override {
    left_ = step == 0 ? kSlices : static_cast<int>(costOf(step) / kSlice) + 1;
  }
  bool refine(Timestamp until) override {
    steps_.clear();
    while (clock_.now() + kSlice < until) {
      wait(kSlice);
      if (--left_ > 0) continue;
      paint();
      return true;
    }
    return false;
  }
  void setSizeDivisor(int divisor) override { divisor_ = divisor; }
  bool sees(const Eigen::Isometry3f& T_eye_model) const override {
    return T_eye_model.translation().norm() < 50;
  }
  std::span<const render::frame::FrameStep> steps() const noexcept override { return steps_; }
  std::span<std::uint8_t> pixels() noexcept override { return pixels_; }

 private:
  static Duration scaled(Duration d, double factor) { return fromSeconds(toSeconds(d) * factor); }
  Duration costOf(std::size_t step) const {
    const auto triangles = static_cast<double>(wall_.model_.trianglesAt(step));
    return scaled(kPerTriangle, cost_ * triangles / (divisor_ * divisor_));
  }
  void wait(Duration d) { (void)clock_.sleepUntil(clock_.now() + d, {}); }
  void paint() {
    ++painted_;
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      pixels_[i] = static_cast<std::uint8_t>(64 + (i * 7 + painted_ * 5) % 128);
  }

  const VirtualWall& wall_;
  VirtualClock& clock_;
  double cost_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::vector<std::uint8_t> pixels_;
  std::size_t painted_ = 0;
  int divisor_ = 1, left_ = 0;
  std::vector<render::frame::FrameStep> steps_;
};

VirtualWall::VirtualWall(const Settings& settings, std::uint64_t seed, Fibers& fibers,
                         VirtualClock& clock)
    : fibers_(fibers),
      clock_(clock),
      model_(test::wavySheet()),
      detail_(model_),
      plan_(smallPlan()),
      scene_(*render::scene::Scene::make(settings.wall.scene)),
      governor_(settings.wall.governor),
      feed_(shm::segmentName(settings.instance, "devices"), feedSettings(settings)),
      attendance_(settings.wall.playlist),
      frame_clock_(clock) {
  painters_[0] = std::make_unique<Painter>(*this, clock, 1, seed);
  painters_[1] = std::make_unique<Painter>(*this, clock, 0.7, seed + 1);
  auto segment = shm::SegmentWriter<shm::WallSegment>::make(
      shm::segmentName(settings.instance, "wall"), shm::wallFields(), 1, clock.now(), {});
  if (!segment) didNotRun("shared memory", segment.error().what, "see /dev/shm");
  segment_.emplace(*std::move(segment));
  makeOutputs(settings);
  const wall::WallSlots slots{(*segment_)->stats,        &(*segment_)->trace,
                              &(*segment_)->interaction, &(*segment_)->outputs,
                              &(*segment_)->content,     &(*segment_)->idle};
  wall::WallParts parts{{{&detail_, painters_[0].get()}, {&detail_, painters_[1].get()}},
                        scene_,
                        governor_,
                        feed_,
                        *delivery_,
                        slots,
                        clock_,
                        frame_clock_,
                        attendance_};
  parts.curtain = &curtain_;
  parts.fade_frames = settings.wall.render.fade_frames;
  parts.return_after_s = settings.wall.scene.return_after_s;
  loop_ = std::make_unique<wall::WallLoop>(std::move(parts));
}

VirtualWall::~VirtualWall() = default;

void VirtualWall::makeOutputs(const Settings& settings) {
  auto shared = out::SharedFrameOutput::make(shm::segmentName(settings.instance, "framebuffer"),
                                             plan_, 1, clock_);
  if (!shared) didNotRun("shared memory", shared.error().what, "see /dev/shm");
  std::vector<out::NamedOutput> outputs;
  outputs.push_back(
      {"shared", "shared_memory", std::make_unique<FaultyOutput>(*std::move(shared), faults_)});
  outputs_.emplace(std::move(outputs));
  checks_.emplace(
      std::vector<out::PictureChecks::Checked>{
          {&outputs_->output(0), fromSeconds(settings.wall.outputs[0].check_s)}},
      clock_);
  outputs_->checkWith(&*checks_);
  delivery_.emplace(plan_, *outputs_, std::vector<render::frame::Overlay*>{&curtain_});
}

void VirtualWall::start(const std::stop_token& stop) {
  fibers_.start([this, stop] {
    loop_->calibrate();
    loop_->run(stop, [] {});
  });
  fibers_.start([this, stop] {
    while (!stop.stop_requested()) {
      const auto due = checks_->step();
      if (!due ||
          !clock_.sleepUntil(std::max(*due, clock_.now() + std::chrono::milliseconds(1)), stop))
        return;
    }
  });
}

wall::FeedSettings VirtualWall::feedSettings(const Settings& settings) {
  wall::FeedSettings feed;
  for (const HandSettings& hand : settings.devices.hands)
    feed.hands.push_back({hand.name, hand.person, hand.glove, {hand.tracker, hand.station}});
  for (const DeviceSettings& device : settings.devices.list)
    feed.devices.push_back({device.name, device.person});
  feed.stale_after = fromSeconds(settings.devices.stale_after_s);
  feed.turn = fromSeconds(settings.devices.turn_s);
  return feed;
}

void VirtualWall::reload(const Settings& settings, bool rate, bool playlist, bool scene,
                         bool input) {
  wall::WallTuning tuning;
  if (rate) tuning.governor = settings.wall.governor;
  if (playlist) tuning.playlist = settings.wall.playlist;
  if (scene) tuning.scene = settings.wall.scene;
  if (input) tuning.feed = feedSettings(settings);
  loop_->tune(std::move(tuning));
}

}  // namespace merlin::bench
