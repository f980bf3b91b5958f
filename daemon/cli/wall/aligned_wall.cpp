#include "daemon/cli/wall/aligned_wall.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/cli/roles.h"

namespace merlin::cli {
namespace {

constexpr Duration kAlignPollPeriod = std::chrono::milliseconds(20);
// Computing the warp for a display with many pixels takes seconds on a slow machine.
constexpr Duration kAlignPatience = std::chrono::seconds(60);

state::Offset offsetOf(const nlohmann::json& json) {
  return {json.at(0).get<double>(), json.at(1)};
}

AlignedPicture pictureOf(const nlohmann::json& json) {
  AlignedPicture picture{
      json.at("name"),
      json.at("width"),
      json.at("height"),
      json.at("pending"),
      {},
      {},
      {offsetOf(json.at("seen").at("right")), offsetOf(json.at("seen").at("down"))}};
  for (std::size_t i = 0; i < picture.corners.size(); ++i) {
    const nlohmann::json& corner = json.at("corners").at(state::kCornerNames[i]);
    picture.corners[i] = {offsetOf(corner.at("configured")), offsetOf(corner.at("moved"))};
  }
  picture.mesh_columns = json.at("mesh").at(0);
  picture.mesh_rows = json.at("mesh").at(1);
  for (const nlohmann::json& point : json.at("points"))
    picture.points.push_back({point.at("column"), point.at("row"), offsetOf(point.at("moved"))});
  return picture;
}

}  // namespace

bool AlignedPicture::isMoved() const {
  return !points.empty() || std::ranges::any_of(corners, [](const AlignedCorner& corner) {
    return corner.moved != state::Offset{};
  });
}

const AlignedPicture* AlignAnswer::find(const std::string& output) const {
  const auto found = std::ranges::find(outputs, output, &AlignedPicture::name);
  return found == outputs.end() ? nullptr : &*found;
}

Error wallsReason(Error error, std::string_view command) {
  const std::string before = fmt::format(": {}: ", command);
  const auto at = error.what.find(before);
  if (error.code == Errc::kInvalidArgument && at != std::string::npos)
    error.what.erase(0, at + before.size());
  return error;
}

Result<AlignAnswer> readAlignAnswer(const std::string& text) {
  try {
    const auto json = nlohmann::json::parse(text);
    AlignAnswer answer{{}, json.at("undo"), json.at("redo"), json.at("done"), text};
    for (const nlohmann::json& output : json.at("outputs"))
      answer.outputs.push_back(pictureOf(output));
    return answer;
  } catch (const nlohmann::json::exception& e) {
    return Error{Errc::kMalformed, fmt::format("merlind's answer cannot be read: {}", e.what())};
  }
}

Result<AlignAnswer> AlignedWall::ask(const state::AlignRequest& request) const {
  const auto answer = askRole(instance_, "wall", {"align", state::textOf(request)});
  if (!answer) return wallsReason(answer.error(), "align");
  return readAlignAnswer(*answer);
}

Result<AlignAnswer> AlignedWall::askAndWait(const state::AlignRequest& request) const {
  SystemClock clock;
  const Timestamp until = clock.now() + kAlignPatience;
  const auto first = ask(request);
  for (auto answer = first;; answer = ask(state::ListRequest{})) {
    if (!answer) return answer;
    if (std::ranges::none_of(answer->outputs, &AlignedPicture::pending)) {
      answer->done = first->done;
      return answer;
    }
    if (clock.now() > until) {
      return Error{Errc::kTimeout,
                   fmt::format("the alignment is changed and saved, but merlind does "
                               "not show it after {:.0f} s",
                               toSeconds(kAlignPatience))};
    }
    clock.sleepUntil(clock.now() + kAlignPollPeriod, {});
  }
}

std::vector<std::string> alignmentLines(const AlignAnswer& answer) {
  std::vector<std::string> lines;
  for (const AlignedPicture& output : answer.outputs) {
    lines.push_back(fmt::format("{} ({} x {})", output.name, output.width, output.height));
    for (std::size_t i = 0; i < output.corners.size(); ++i) {
      const auto& [configured, moved] = output.corners[i];
      std::string line = fmt::format("  {:<13} {:+g} {:+g}", state::kCornerNames[i],
                                     configured.x + moved.x, configured.y + moved.y);
      if (moved != state::Offset{}) {
        line += fmt::format("  (configured {:+g} {:+g}, moved {:+g} {:+g})", configured.x,
                            configured.y, moved.x, moved.y);
      }
      lines.push_back(std::move(line));
    }
    for (const AlignedPoint& point : output.points) {
      lines.push_back(fmt::format(
          "  {:<13} moved {:+g} {:+g}  (add {:+.6f} {:+.6f} to the point in the configuration)",
          fmt::format("point {} {}", point.column, point.row), point.moved.x, point.moved.y,
          point.moved.x / output.width, point.moved.y / output.height));
    }
  }
  lines.push_back(
      fmt::format("steps that can be undone: {}, redone: {}", answer.undo, answer.redo));
  return lines;
}

}  // namespace merlin::cli
