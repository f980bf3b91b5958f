// The controls of the operator's panel, and the command of daemon/base/commands.h or the motion
// that each of them causes. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace merlin::render::panel {

enum class ControlId : std::uint8_t {
  kModel,
  kPicture,
  kPrevious,
  kNext,
  kUp,
  kLeft,
  kReset,
  kRight,
  kDown,
  kNearer,
  kFarther,
  kMode,
  kSnapshot,
  kBall,
  kRateLess,
  kRateMore,
  kRateAuto,
  kDetailLess,
  kDetailMore,
  kDetailAuto,
  kBlank,
  kFreeze,
  kLampOff,
  kLampSlow,
  kLampFast,
  kLampOn,
  kProjectorsOn,
  kProjectorsOff,
  kVideoA,
  kVideoB
};

// A command of daemon/base/commands.h.
struct Request {
  std::string command, argument{};

  bool operator==(const Request&) const = default;
};

// The kind of content that is shown. It decides how the content moves and what the panel's buttons
// say.
enum class ShownKind : std::uint8_t { kModel, kPicture, kPanorama };

struct PanelContent {
  std::string name;
  bool is_model = true;
};

// Which of the things that the panel can operate exist on this wall; constant while it runs.
struct PanelOptions {
  std::vector<PanelContent> contents;  // contents in the configuration, in their order
  bool snapshots = false;              // there is a folder for snapshots
  bool projectors = false, video = false, lamp = false;
};

// What the panel shows of the wall. Equal facts are drawn alike.
struct PanelFacts {
  // Names of the content and of its slide; slide is empty if there is none.
  std::string content, slide;
  std::vector<std::string> missing;  // names of contents that cannot be shown yet
  ShownKind kind = ShownKind::kModel;
  bool flies = false;  // the ball moves the viewer
  double rate_hz = 0;  // the requested frame rate
  bool rate_by_hand = false;
  std::uint32_t detail = 0;       // budget of moving frames, in detail_unit
  std::uint32_t full_detail = 0;  // cost of full detail; 0: not known
  bool detail_by_hand = false;
  std::string detail_unit;  // "triangles"
  bool blank = false, frozen = false;
  std::optional<std::uint32_t> lamp;   // a GpioSample::Lamp; nothing: not known
  std::optional<std::uint32_t> video;  // 0: A, 1: B; nothing: not known
  std::string projectors;              // "on", "warming", "off"; empty: not known
  // Whether they are on or being switched on; nothing: not known.
  std::optional<bool> projectors_wanted;
  std::string notice;  // why the last command was refused; empty: it was executed

  bool operator==(const PanelFacts&) const = default;
};

// When a control acts. kClick: when it is released. kStep: when it is pressed, and again and again
// while it is held. kMotion: as long as it is held.
enum class Acts : std::uint8_t { kClick, kStep, kMotion };

Acts actsOf(ControlId id) noexcept;
// Returns the text on a control's button. `by_ball`: the ball operates the panel.
std::string_view labelOf(ControlId id, const PanelFacts& facts, bool by_ball) noexcept;

// Returns the command that a control gives now; nothing if there is nothing to do, or if the
// control is for motion.
std::optional<Request> requestOf(ControlId id, const PanelFacts& facts,
                                 const PanelOptions& options);
// Returns whether a control's button is drawn as switched on.
bool isLit(ControlId id, const PanelFacts& facts, bool by_ball) noexcept;

// Speed of the motion that a control causes while it is held.
struct Motion {
  // Translation to the right, up, nearer; in radii of the content a second.
  std::array<float, 3> way_radii_s{};
  std::array<float, 3> turn_rad_s{};  // rotation about these axes
};
// A model is rotated, a picture is shifted, and in a panorama the view turns. The arrows on the
// buttons point where the content moves, or where the view of a panorama turns. Zero for controls
// that are not for motion.
Motion motionOf(ControlId id, ShownKind kind) noexcept;

}  // namespace merlin::render::panel
