#include "daemon/role_commands.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "config/settings.h"
#include "daemon/status/documents.h"

namespace merlin {
namespace {

using Parts = RoleCommands::Parts;
using Answer = Result<std::string>;

Answer done() { return std::string("{}"); }
Answer lacks(std::string_view what) {
  return Error{Errc::kInvalidArgument, fmt::format("this process {}", what)};
}

struct Range {
  double least, most;
};

// Parses a number within the range; nothing for "auto".
Result<std::optional<double>> numberOrAuto(std::string_view argument, const Range& range) {
  if (argument == "auto") return std::optional<double>();
  double value = 0;
  const char* const end = argument.data() + argument.size();
  const auto [rest, error] = std::from_chars(argument.data(), end, value);
  if (error == std::errc() && rest == end && value >= range.least && value <= range.most)
    return std::optional(value);
  return Error{Errc::kInvalidArgument,
               fmt::format("\"{}\" is not a number from {} to {}, or auto", argument.substr(0, 64),
                           range.least, range.most)};
}

Answer request(const Parts& p, wall::WallLoop::Request what) {
  p.wall->request(what);
  return done();
}

// A number outside the limits of the content that is shown is clamped to them and not refused,
// because the panel and the page also step down from the least number. The answer has the number
// that is used.
Answer triangles(const Parts& p, const std::string& argument) {
  constexpr wall::Pace::Limits kWidest{4, 1'000'000'000};
  const auto number = numberOrAuto(argument, {kWidest.least, kWidest.most});
  if (!number) return number.error();
  if (!*number) {
    p.wall->hold(std::nullopt);
    return done();
  }
  const wall::Pace::Limits limits = p.wall->holdLimits().value_or(kWidest);
  const std::size_t used = std::clamp(static_cast<std::size_t>(**number), limits.least,
                                      std::max(limits.least, limits.most));
  p.wall->hold(used);
  return fmt::format(R"({{"used": {}}})", used);
}

// Fills `numbers` from the text, in which blanks separate them. False if the text has fewer numbers
// or anything after them, or if a number i is not from -most(i) to most(i).
template <typename Number, std::size_t count, typename Most>
bool readNumbers(std::string_view text, std::array<Number, count>& numbers, const Most& most) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < count; ++i) {
    while (at != end && *at == ' ') ++at;
    const auto [rest, error] = std::from_chars(at, end, numbers[i]);
    // not std::abs(), which overflows for the least int
    if (error != std::errc() || !(numbers[i] >= -most(i) && numbers[i] <= most(i))) return false;
    at = rest;
  }
  return at == end;
}

// Executes the command move, whose argument is six numbers (see kCommands). The limits keep a
// single command from moving the model out of reach.
Answer move(const Parts& p, std::string_view argument) {
  constexpr float kMostRadii = 10, kMostDegrees = 360;
  std::array<float, 6> step{};
  const auto most = [](std::size_t i) { return i < 3 ? kMostRadii : kMostDegrees; };
  if (!readNumbers(argument, step, most)) {
    return Error{
        Errc::kInvalidArgument,
        fmt::format("\"{}\" is not six numbers X Y Z RX RY RZ: X, Y and Z are from -{} to {} times "
                    "the model's radius, RX, RY and RZ from -{} to {} degrees",
                    argument.substr(0, 64), kMostRadii, kMostRadii, kMostDegrees, kMostDegrees)};
  }
  p.wall->move({step[0], step[1], step[2]}, {step[3], step[4], step[5]});
  return done();
}

Answer notice(const Parts& p, const std::string& text) {
  const auto shown = p.wall->notice(text);
  return shown ? done() : Answer(shown.error());
}

// Returns the request's number as JSON. shm::WallContent::finished has this number once the request
// is finished.
Answer requestOf(const Result<std::uint32_t>& request) {
  if (!request) return request.error();
  return fmt::format("{{\"request\": {}}}", *request);
}

Answer rate(const Parts& p, const std::string& argument) {
  const auto number = numberOrAuto(argument, {1, 240});
  if (!number) return number.error();
  p.wall->setRate(*number);
  p.keeper->change([&](state::State& s) { s.rate_hz = *number; });
  return done();
}

// Returns the number of the newest known frame. A frame with a higher number shows what was
// requested before this call.
std::uint64_t framesOf(const Parts& p) {
  const auto stats = p.wall->segment().stats.read();
  return stats ? stats->frames : 0;
}

// Returns, as JSON, the shared memory into which the signal of the output will be copied, and the
// number of the newest frame; the copy will be of a later frame.
Answer signal(const Parts& p, const std::string& output) {
  const auto segment = p.wall->outputs().signals().ask(output);
  if (!segment) return segment.error();
  return fmt::format("{{\"shared_memory\": \"{}\", \"after\": {}}}", *segment, framesOf(p));
}

// Executes an action of the alignment for a client, as for an input that is bound to it.
Answer alignAction(const Parts& p, std::string_view name) {
  wall::AlignInput input;
  const auto action = std::ranges::find(wall::kAlignActions, name);
  if (action == std::end(wall::kAlignActions)) return lacks("does not know the command");
  input.actions = {static_cast<std::uint8_t>(action - std::begin(wall::kAlignActions))};
  p.wall->outputs().aligner().ask(input);
  return done();
}

Answer playlist(const Parts& p, const std::string& argument) {
  wall::Attendance& attendance = p.wall->attendance();
  if (argument != "on" && argument != "off" && argument != "next") {
    return Error{Errc::kInvalidArgument,
                 fmt::format("\"{}\" is not on, off or next", argument.substr(0, 64))};
  }
  if (argument == "next") {
    attendance.nextOfPlaylist();
    return done();
  }
  const bool on = argument == "on";
  attendance.switchPlaylist(on);
  p.keeper->change([&](state::State& s) { s.playlist_off = !on; });
  return done();
}

// Switches blank or freeze on, or off if it is on.
Answer toggle(const Parts& p, void (wall::Attendance::*what)()) {
  (p.wall->attendance().*what)();
  return done();
}

// Counts a successful command as use of the wall, so that its alignment or test card is visible.
Answer seen(const Parts& p, Answer answer) {
  if (answer) p.wall->attendance().touch();
  return answer;
}

Answer testcard(const Parts& p, const std::string& name) {
  const auto shown = p.wall->outputs().aligner().showCard(name);
  if (!shown) return shown.error();
  return fmt::format("{{\"after\": {}}}", framesOf(p));
}

// Executes the command operator_pointer, whose argument is "X Y 0|1" or "out".
Answer operatorPointer(wall::OperatorPanel& panel, std::string_view argument) {
  std::array<int, 3> numbers{};
  const bool good = readNumbers(argument, numbers, [](std::size_t) { return 1'000'000; }) &&
                    (numbers[2] == 0 || numbers[2] == 1);
  if (!good && argument != "out") {
    return Error{
        Errc::kInvalidArgument,
        fmt::format("\"{}\" is neither X Y 0, X Y 1 nor out: the pointer at pixel X, Y of the "
                    "frame with its button released (0) or pressed (1), or outside the "
                    "frame",
                    argument.substr(0, 64))};
  }
  if (good)
    panel.point(render::panel::Point{numbers[0], numbers[1]}, numbers[2] == 1);
  else
    panel.point(std::nullopt, false);
  return done();
}

Answer operatorPanel(const Parts& p, std::string_view name, const std::string& argument) {
  wall::OperatorPanel* const panel = p.wall->panel();
  if (!panel) return lacks("has no panel on the operator's tile: /wall/operator/panel is off");
  if (name == "operator_pointer") return operatorPointer(*panel, argument);
  panel->toggleBall();
  return done();
}

Answer snapshot(const Parts& p) {
  if (!p.snapshots) return lacks("has no folder for snapshots: /wall/snapshots names none");
  p.snapshots->take();
  return done();
}

Answer flight(const Parts& p) {
  const auto files = p.devices->flight().dump();
  if (!files) return files.error();
  return status::textList(*files);
}

Answer projectors(const Parts& p, bool on) {
  if (!p.devices->projectors()) return lacks(fmt::format("has no {}", kProjectorsNeeded));
  const auto switched = p.devices->projectors()->switchAll(on);
  return switched ? done() : Answer(switched.error());
}

Answer ofWall(const Parts& p, std::string_view name, const std::string& argument) {
  if (!p.wall) return lacks("does not draw a wall");
  if (name == "reset_view") return request(p, wall::WallLoop::kResetView);
  if (name == "next_mode") return request(p, wall::WallLoop::kNextMode);
  if (name == "next_content") return request(p, wall::WallLoop::kNextContent);
  if (name == "previous_content") return request(p, wall::WallLoop::kPreviousContent);
  if (name == "show") return requestOf(p.wall->contents().show(argument));
  if (name == "show_file") return requestOf(p.wall->contents().showFile(argument));
  if (name == "notice") return notice(p, argument);
  if (name == "move") return move(p, argument);
  if (name == "snapshot") return snapshot(p);
  if (name == "triangles") return triangles(p, argument);
  if (name == "rate") return rate(p, argument);
  if (name == "align" && argument == "list") return p.wall->outputs().aligner().run(argument);
  if (name == "align") return seen(p, p.wall->outputs().aligner().run(argument));
  if (name == "testcard") return seen(p, testcard(p, argument));
  if (name == "signal") return signal(p, argument);
  if (name.starts_with("operator_")) return operatorPanel(p, name, argument);
  if (name == "blank") return toggle(p, &wall::Attendance::toggleBlank);
  if (name == "freeze") return toggle(p, &wall::Attendance::toggleFreeze);
  if (name == "playlist") return playlist(p, argument);
  return seen(p, alignAction(p, name));
}

Answer ofDevices(const Parts& p, const CommandInfo& command) {
  if (!p.devices) return lacks("has no devices");
  if (command.name == "flight") return flight(p);
  if (command.role != CommandOf::kPanel) return lacks("does not know the command");
  if (command.name == "projector_on") return projectors(p, true);
  if (command.name == "projector_off") return projectors(p, false);
  if (!p.devices->panel()) return lacks("has no panel: /gpio names no chip");
  const auto executed = p.devices->panel()->execute(std::string(command.name));
  return executed ? done() : Answer(executed.error());
}

Answer ofEachRole(const Parts& p, std::string_view name, const std::string& argument) {
  if (name == "reload" && p.reloader) return p.reloader->run(argument);
  return lacks("does not know the command");
}

}  // namespace

Result<std::string> RoleCommands::run(std::string_view name, const std::string& argument) const {
  const CommandInfo* const command = findCommand(name);
  if (!command)
    return Error{Errc::kInvalidArgument, fmt::format("\"{}\" is not a known command", name)};
  auto answer = command->role == CommandOf::kEachRole ? ofEachRole(parts_, name, argument)
                : command->role == CommandOf::kWall   ? ofWall(parts_, name, argument)
                                                      : ofDevices(parts_, *command);
  if (answer && name == "operator_pointer") runPanel();
  if (answer) return answer;
  return Error{answer.error().code, fmt::format("{}: {}", name, answer.error().what)};
}

void RoleCommands::runPanel() const {
  wall::OperatorPanel* const panel = parts_.wall ? parts_.wall->panel() : nullptr;
  if (!panel) return;
  for (const render::panel::Request& request : panel->takeRequests()) {
    const CommandInfo* const command = findCommand(request.command);
    const bool of_devices =
        command && (command->role == CommandOf::kPanel || command->role == CommandOf::kDevices);
    if (of_devices && parts_.beside) {
      const auto sent = parts_.beside->send(request.command, clock_.now());
      if (!sent) panel->refuse(sent.error().what);
      continue;
    }
    const auto executed = run(request.command, request.argument);
    if (!executed) panel->refuse(executed.error().what);
  }
}

std::vector<status::Command> RoleCommands::of(CommandOf role) const {
  std::vector<status::Command> commands;
  for (const CommandInfo& c : kCommands) {
    if (c.role != role || c.bindable == Bindable::kHeld) continue;
    if (c.name == "status" || c.name == "events") continue;  // added by the servers
    status::Command command{std::string(c.name), std::string(c.help), nullptr, nullptr};
    if (c.argument.empty())
      command.run = [this, name = c.name] { return run(name); };
    else
      command.run_with = [this, name = c.name](const std::string& a) { return run(name, a); };
    commands.push_back(std::move(command));
  }
  return commands;
}

}  // namespace merlin
