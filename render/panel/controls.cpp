#include "render/panel/controls.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "daemon/base/commands.h"

namespace merlin::render::panel {
namespace {

struct Control {
  ControlId id;
  std::string_view label;
  Acts acts;
  std::string_view command;  // empty: the control is for motion
};

// In the order of ControlId.
constexpr Control kControls[] = {
    {ControlId::kModel, "Model", Acts::kClick, "show"},
    {ControlId::kPicture, "Picture", Acts::kClick, "show"},
    {ControlId::kPrevious, "‹", Acts::kClick, "previous_content"},
    {ControlId::kNext, "›", Acts::kClick, "next_content"},
    {ControlId::kUp, "▲", Acts::kMotion, ""},
    {ControlId::kLeft, "◀", Acts::kMotion, ""},
    {ControlId::kReset, "●", Acts::kClick, "reset_view"},
    {ControlId::kRight, "▶", Acts::kMotion, ""},
    {ControlId::kDown, "▼", Acts::kMotion, ""},
    {ControlId::kNearer, "+", Acts::kMotion, ""},
    {ControlId::kFarther, "−", Acts::kMotion, ""},
    {ControlId::kMode, "", Acts::kClick, "next_mode"},
    {ControlId::kSnapshot, "Snapshot", Acts::kClick, "snapshot"},
    {ControlId::kBall, "", Acts::kClick, "operator_panel"},
    {ControlId::kRateLess, "−", Acts::kStep, "rate"},
    {ControlId::kRateMore, "+", Acts::kStep, "rate"},
    {ControlId::kRateAuto, "auto", Acts::kClick, "rate"},
    {ControlId::kDetailLess, "−", Acts::kStep, "triangles"},
    {ControlId::kDetailMore, "+", Acts::kStep, "triangles"},
    {ControlId::kDetailAuto, "auto", Acts::kClick, "triangles"},
    {ControlId::kBlank, "Blank", Acts::kClick, "blank"},
    {ControlId::kFreeze, "Freeze", Acts::kClick, "freeze"},
    {ControlId::kLampOff, "off", Acts::kClick, "lamp_off"},
    {ControlId::kLampSlow, "slow", Acts::kClick, "lamp_slow"},
    {ControlId::kLampFast, "fast", Acts::kClick, "lamp_fast"},
    {ControlId::kLampOn, "on", Acts::kClick, "lamp_on"},
    {ControlId::kProjectorsOn, "on", Acts::kClick, "projector_on"},
    {ControlId::kProjectorsOff, "off", Acts::kClick, "projector_off"},
    {ControlId::kVideoA, "A", Acts::kClick, "video_a"},
    {ControlId::kVideoB, "B", Acts::kClick, "video_b"},
};
static_assert([] {
  for (std::size_t i = 0; i < std::size(kControls); ++i) {
    const Control& control = kControls[i];
    const bool listed =
        std::any_of(std::begin(kCommands), std::end(kCommands),
                    [&](const CommandInfo& c) { return c.name == control.command; });
    if (control.id != ControlId{static_cast<std::uint8_t>(i)}) return false;
    if (listed == (control.acts == Acts::kMotion)) return false;
  }
  return true;
}());

const Control& controlOf(ControlId id) { return kControls[static_cast<std::size_t>(id)]; }

// Rates that displays have, and those that people ask for.
constexpr double kRates_hz[] = {5,  10, 12, 15, 20, 24,  25,  30,  40,  48,
                                50, 60, 72, 75, 90, 100, 120, 144, 165, 240};
constexpr double kDetailStep = 1.25;
constexpr double kLeastDetail = 100;

std::string lessRate(double now_hz) {
  const auto* const above = std::ranges::lower_bound(kRates_hz, now_hz - 0.01);
  return above == std::begin(kRates_hz) ? "" : fmt::format("{:g}", *(above - 1));
}

std::string moreRate(double now_hz) {
  const auto* const above = std::ranges::upper_bound(kRates_hz, now_hz + 0.01);
  return above == std::end(kRates_hz) ? "" : fmt::format("{:g}", *above);
}

// Rounds to two significant digits, since people read the number.
double rounded(double number) {
  const double unit = std::pow(10, std::floor(std::log10(number)) - 1);
  return std::round(number / unit) * unit;
}

std::string detailTimes(const PanelFacts& facts, double factor) {
  if (facts.detail == 0) return "";
  const double most = facts.full_detail > 0 ? facts.full_detail : 1e9;
  const double least = std::min(kLeastDetail, most);
  const double now = std::clamp<double>(facts.detail, least, most);
  const double next = std::clamp(rounded(now * factor), least, most);
  return next == now ? "" : fmt::format("{:.0f}", next);
}

bool isMissing(const PanelContent& content, const PanelFacts& facts) {
  return std::ranges::find(facts.missing, content.name) != facts.missing.end();
}

// Returns the name of the first content of this kind after the one that is shown; empty if there is
// none.
std::string nextOfKind(bool is_model, const PanelFacts& facts, const PanelOptions& options) {
  if ((facts.kind == ShownKind::kModel) == is_model) return "";
  const auto& all = options.contents;
  const auto shown = std::ranges::find(all, facts.content, &PanelContent::name);
  const auto from = shown == all.end() ? 0 : static_cast<std::size_t>(shown - all.begin());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const PanelContent& content = all[(from + i) % all.size()];
    if (content.is_model == is_model && !isMissing(content, facts)) return content.name;
  }
  return "";
}

// Returns whether a content other than the current one can be shown.
bool hasOther(const PanelFacts& facts, const PanelOptions& options) {
  return std::ranges::any_of(options.contents, [&](const PanelContent& content) {
    return content.name != facts.content && !isMissing(content, facts);
  });
}

// Returns the argument of the control's command; empty if there is nothing to do.
std::string argumentOf(ControlId id, const PanelFacts& facts, const PanelOptions& options) {
  switch (id) {
    case ControlId::kModel: return nextOfKind(true, facts, options);
    case ControlId::kPicture: return nextOfKind(false, facts, options);
    case ControlId::kRateLess: return lessRate(facts.rate_hz);
    case ControlId::kRateMore: return moreRate(facts.rate_hz);
    case ControlId::kDetailLess: return detailTimes(facts, 1 / kDetailStep);
    case ControlId::kDetailMore: return detailTimes(facts, kDetailStep);
    case ControlId::kRateAuto:
    case ControlId::kDetailAuto: return "auto";
    default: return "";
  }
}

}  // namespace

Acts actsOf(ControlId id) noexcept { return controlOf(id).acts; }

std::string_view labelOf(ControlId id, const PanelFacts& facts, bool by_ball) noexcept {
  if (id == ControlId::kBall) return by_ball ? "Leave" : "Ball";
  if (id == ControlId::kMode) return facts.flies ? "viewer" : "content";
  return controlOf(id).label;
}

std::optional<Request> requestOf(ControlId id, const PanelFacts& facts,
                                 const PanelOptions& options) {
  const Control& control = controlOf(id);
  if (control.command.empty()) return std::nullopt;
  if (id == ControlId::kSnapshot && !options.snapshots) return std::nullopt;
  if (id == ControlId::kMode && facts.kind != ShownKind::kModel) return std::nullopt;
  const bool steps = id == ControlId::kPrevious || id == ControlId::kNext;
  if (steps && facts.slide.empty() && !hasOther(facts, options)) return std::nullopt;
  Request request{std::string(control.command)};
  if (isPlainCommand(control.command)) return request;
  request.argument = argumentOf(id, facts, options);
  if (request.argument.empty()) return std::nullopt;
  return request;
}

bool isLit(ControlId id, const PanelFacts& facts, bool by_ball) noexcept {
  switch (id) {
    case ControlId::kModel: return facts.kind == ShownKind::kModel;
    case ControlId::kPicture: return facts.kind != ShownKind::kModel;
    case ControlId::kBall: return by_ball;
    case ControlId::kRateAuto: return !facts.rate_by_hand;
    case ControlId::kDetailAuto: return !facts.detail_by_hand;
    case ControlId::kBlank: return facts.blank;
    case ControlId::kFreeze: return facts.frozen;
    case ControlId::kLampOff:
    case ControlId::kLampSlow:
    case ControlId::kLampFast:
    case ControlId::kLampOn:
      return facts.lamp ==
             static_cast<std::uint32_t>(id) - static_cast<std::uint32_t>(ControlId::kLampOff);
    case ControlId::kProjectorsOn: return facts.projectors_wanted == true;
    case ControlId::kProjectorsOff: return facts.projectors_wanted == false;
    case ControlId::kVideoA: return facts.video == 0U;
    case ControlId::kVideoB: return facts.video == 1U;
    default: return false;
  }
}

Motion motionOf(ControlId id, ShownKind kind) noexcept {
  constexpr float kTurn_rad_s = 1.0F, kShift_radii_s = 0.5F, kZoom_radii_s = 0.8F;
  const bool shifts = kind == ShownKind::kPicture;
  // Along the arrow: `right` and `up` are -1, 0 or 1.
  const auto along = [&](float right, float up) {
    Motion motion;
    if (shifts) motion.way_radii_s = {kShift_radii_s * right, kShift_radii_s * up, 0};
    if (kind == ShownKind::kModel) motion.turn_rad_s = {-kTurn_rad_s * up, kTurn_rad_s * right, 0};
    if (kind == ShownKind::kPanorama)
      motion.turn_rad_s = {kTurn_rad_s / 2 * up, -kTurn_rad_s / 2 * right, 0};
    return motion;
  };
  switch (id) {
    case ControlId::kUp: return along(0, 1);
    case ControlId::kDown: return along(0, -1);
    case ControlId::kLeft: return along(-1, 0);
    case ControlId::kRight: return along(1, 0);
    case ControlId::kNearer: return {{0, 0, kZoom_radii_s}, {}};
    case ControlId::kFarther: return {{0, 0, -kZoom_radii_s}, {}};
    default: return {};
  }
}

}  // namespace merlin::render::panel
