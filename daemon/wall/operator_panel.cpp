#include "daemon/wall/operator_panel.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "daemon/base/fixed_text.h"
#include "daemon/base/printable_text.h"
#include "daemon/wall/useful_cost.h"

namespace merlin::wall {
namespace {

using namespace render::panel;

constexpr Duration kFactsEvery = std::chrono::milliseconds(100);
constexpr Duration kNoticeShown = std::chrono::seconds(15);
constexpr std::size_t kMostRequests = 32;

template <std::size_t N>
std::string panelText(const char (&field)[N]) {
  return std::string(wholeCharacters(textIn(field)));
}

ShownKind shownKind(std::string_view kind) {
  if (kind == "panorama") return ShownKind::kPanorama;
  return kind == "model" ? ShownKind::kModel : ShownKind::kPicture;
}

// Rounds down to two digits, so that small changes of the governor's budget do not redraw the panel
// ten times a second.
std::uint32_t twoDigits(std::uint32_t number) {
  std::uint32_t unit = 1;
  while (number / unit >= 100) unit *= 10;
  return number / unit * unit;
}

float strongest(std::initializer_list<float> pushes) {
  return std::max(pushes, [](float a, float b) { return std::abs(a) < std::abs(b); });
}

// Converts a sample of the ball to two directions: right (pushed, turned or rolled to the right)
// and up (pushed up or away, or tilted away).
BallPush pushOf(const BallSample& ball) {
  const auto& t = ball.translation;
  const auto& r = ball.rotation;
  return {strongest({t[0], r[1], -r[2]}), strongest({t[1], -t[2], -r[0]}), ball.buttons != 0};
}

}  // namespace

PanelOptions panelOptions(const Settings& settings, const std::vector<ContentEntry>& contents) {
  PanelOptions options;
  for (const ContentEntry& entry : contents)
    options.contents.push_back({entry.name, entry.kind == ContentKind::kModel});
  options.snapshots = !settings.wall.snapshots.empty();
  if (!settings.wall.input.endpoint.empty()) return options;
  const GpioSettings& gpio = settings.devices.gpio;
  const bool chip = !gpio.chip.empty();
  options.projectors = !settings.devices.projectors.empty() || (chip && gpio.projector_line >= 0);
  options.video = chip && gpio.video_line >= 0;
  options.lamp = chip && gpio.lamp_line >= 0;
  return options;
}

ProjectorsSeen projectorSeen(std::string power, std::optional<bool> wanted) {
  if (!wanted && power != "unknown") wanted = power == "on" || power == "warming";
  return {std::move(power), wanted};
}

ProjectorsSeen together(const std::vector<ProjectorsSeen>& all) {
  if (all.empty()) return {};
  ProjectorsSeen seen = all.front();
  for (const ProjectorsSeen& one : all) {
    if (one.power != seen.power) seen.power = "mixed";
    if (one.wanted != seen.wanted) seen.wanted.reset();
  }
  return seen;
}

OperatorPanel::OperatorPanel(PanelPlace place, PanelOptions options, const Parts& parts)
    : place_(std::move(place)),
      options_(std::move(options)),
      parts_(parts),
      devices_(parts.devices),
      input_(place_.layout) {}

// Reports a press to Attendance. A press of blank or freeze is no touch(), since a touch would
// first end that state and the press would then begin it again.
void OperatorPanel::touchBy(std::optional<ControlId> pressed) {
  if (pressed == ControlId::kBlank || pressed == ControlId::kFreeze)
    parts_.attendance.attend();
  else
    parts_.attendance.touch();
}

void OperatorPanel::point(std::optional<Point> in_frame, bool pressed) {
  const Timestamp now = parts_.clock.now();
  const std::lock_guard lock(mutex_);
  if (!in_frame) {
    swallowed_ = false;
    return input_.leave();
  }
  const bool begins = pressed && !swallowed_ && !input_.isDown();
  if (begins && shown_ == Attendance::Shown::kBlank) swallowed_ = true;
  if (!pressed) swallowed_ = false;
  input_.point({in_frame->x - place_.tile.x, in_frame->y - place_.tile.y}, pressed && !swallowed_,
               now);
  if (begins) touchBy(swallowed_ ? std::nullopt : input_.pressed());
  collectRequests();
}

void OperatorPanel::toggleBall() {
  const std::lock_guard lock(mutex_);
  toggled_ = !toggled_;
}

std::vector<Request> OperatorPanel::takeRequests() {
  const std::lock_guard lock(mutex_);
  return std::exchange(requests_, {});
}

void OperatorPanel::refuse(std::string why) {
  const std::lock_guard lock(mutex_);
  notice_ = std::move(why);
  noticed_at_ = parts_.clock.now();
}

void OperatorPanel::report(ProjectorsSeen projectors) {
  const std::lock_guard lock(mutex_);
  projectors_ = std::move(projectors);
}

void OperatorPanel::collectRequests() {
  for (const ControlId id : input_.takeActs()) {
    auto request = requestOf(id, facts_, options_);
    if (request && requests_.size() < kMostRequests) requests_.push_back(*std::move(request));
  }
}

void OperatorPanel::readFacts(Timestamp now) {
  if (read_at_ && now - *read_at_ < kFactsEvery) return;
  read_at_ = now;
  PanelFacts facts;
  if (const auto stats = parts_.wall.stats.read()) {
    facts.rate_hz = static_cast<double>(stats->rate_asked_hz);
    facts.rate_by_hand = std::abs(facts.rate_hz - parts_.rate_hz) > 0.01;
    facts.detail_by_hand = stats->held_cost > 0;
    facts.detail =
        usefulCost(*stats, facts.detail_by_hand ? stats->held_cost : twoDigits(stats->budget));
    facts.full_detail = stats->full_cost;
    facts.detail_unit = panelText(stats->cost_unit);
    facts.flies = textIn(stats->mode) == "fly";
  }
  if (const auto content = parts_.wall.content.read()) {
    facts.content = panelText(content->name);
    facts.slide = panelText(content->slide);
    facts.kind = shownKind(textIn(content->kind));
  }
  const std::vector<std::string> faults = parts_.missing.faults();
  for (std::size_t i = 0; i < std::min(faults.size(), options_.contents.size()); ++i) {
    if (!faults[i].empty()) facts.missing.push_back(options_.contents[i].name);
  }
  facts.blank = shown_ == Attendance::Shown::kBlank;
  facts.frozen = shown_ == Attendance::Shown::kFrozen;
  readDevices(now, facts);
  if (!notice_.empty() && now - noticed_at_ < kNoticeShown) facts.notice = notice_;
  facts_ = std::move(facts);
}

void OperatorPanel::readDevices(Timestamp now, PanelFacts& facts) {
  const shm::DeviceSlots* const devices = devices_.get(now);
  const auto gpio = devices && devices->gpio ? devices->gpio->newest() : std::nullopt;
  if (gpio) {
    constexpr const char* kPowers[] = {"off", "warming", "on", "cooling"};
    facts.lamp = gpio->lamp;
    facts.video = gpio->video;
    if (gpio->power < std::size(kPowers)) {
      facts.projectors = kPowers[gpio->power];
      facts.projectors_wanted =
          gpio->power == GpioSample::kWarming || gpio->power == GpioSample::kOn;
    }
  }
  if (!projectors_) return;
  facts.projectors = projectors_->power;
  facts.projectors_wanted = projectors_->wanted;
}

// Lets the ball operate the panel, or stop doing so. While the wall is black or frozen, a push of
// the ball only ends that state.
void OperatorPanel::useBall(WallInput& input, Timestamp now) {
  auto& ball = input.scene.ball;
  const bool toggles = (input.operator_panel % 2 == 1) != std::exchange(toggled_, false);
  if (toggles && input_.byBall()) return input_.leaveByBall();
  if (toggles && ball) input_.enterByBall(now);
  if (toggles && !ball) {
    notice_ = "There is no ball that works.";
    noticed_at_ = now;
  }
  if (!input_.byBall()) return;
  if (!ball) return input_.leaveByBall();
  const BallPush push = pushOf(*ball);
  if (shown_ == Attendance::Shown::kPicture)
    input_.ball(push, now);
  else
    input_.enterByBall(now);
  input.panel_pushed = push.right != 0 || push.up != 0;
  std::fill(std::begin(ball->translation), std::end(ball->translation), 0.0F);
  std::fill(std::begin(ball->rotation), std::end(ball->rotation), 0.0F);
}

void OperatorPanel::addMotion(WallInput& input, Duration elapsed) const {
  const auto held = input_.pressed();
  if (!held) return;
  const Motion motion = motionOf(*held, facts_.kind);
  const auto seconds = static_cast<float>(std::min(toSeconds(elapsed), 0.1));
  input.scene.step.way_m += parts_.radius_m * seconds * Eigen::Vector3f(motion.way_radii_s.data());
  input.scene.step.turn_rad += seconds * Eigen::Vector3f(motion.turn_rad_s.data());
}

void OperatorPanel::update(WallInput& input, Timestamp now) {
  const Duration elapsed = now - std::exchange(updated_at_, now).value_or(now);
  const std::lock_guard lock(mutex_);
  shown_ = parts_.attendance.shown();
  readFacts(now);
  useBall(input, now);
  input_.update(now);
  collectRequests();
  addMotion(input, elapsed);
  view_ = {facts_, input_.byBall(), input_.hovered(), input_.selected(), input_.pressed()};
  publish(now);
}

void OperatorPanel::publish(Timestamp now) {
  if (published_by_ball_ == view_.by_ball) return;
  published_by_ball_ = view_.by_ball;
  const Rect at = place_.inFrame();
  shm::WallPanel panel{};
  panel.updated_ns = toNanoseconds(now);
  panel.x = at.x, panel.y = at.y, panel.width = at.width, panel.height = at.height;
  panel.by_ball = view_.by_ball ? 1 : 0;
  parts_.slot.publish(panel);
}

}  // namespace merlin::wall
