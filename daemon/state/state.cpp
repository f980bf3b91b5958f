#include "daemon/state/state.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "daemon/json/json_view.h"

namespace merlin::state {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestName = 64, kLongestPath = 4096;
constexpr int kLargest = 1 << 20;  // largest size [px], and largest number of columns or rows
constexpr double kLeastRate = 1, kMostRate = 240;
constexpr std::int64_t kMostMinutes = 5'000'000'000;  // minutes since 1970, local time
constexpr const char* kVersionKey = "merlin_state";

Json textOf(const Offset& o) { return Json::array({o.x, o.y}); }

// Returns the name for a corner, [COLUMN, ROW] for a point of the mesh.
Json textOf(const Place& place) {
  if (place.of == Place::Of::kPin) return nameOf(place);
  return Json::array({place.column, place.row});
}

Json textOf(const OutputAlignment& output) {
  Json moved = Json::array();
  for (const auto& [place, offset] : output.moved)
    moved.push_back({{"place", textOf(place)}, {"by", textOf(offset)}});
  const OutputForm& form = output.form;
  Json text{{"output", form.output},
            {"size", {form.width, form.height}},
            {"mesh", {form.mesh_columns, form.mesh_rows}},
            {"moved", std::move(moved)}};
  if (form.corners) text["corners"] = *form.corners;
  return text;
}

Json textOf(const Step& step) {
  Json changes = Json::array();
  for (const Change& c : step.changes) {
    changes.push_back(
        {{"place", textOf(c.place)}, {"before", textOf(c.before)}, {"after", textOf(c.after)}});
  }
  return {{"output", step.output}, {"changes", std::move(changes)}};
}

std::string lineOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Returns a pair of numbers. Adds a fault if one of them is outside `low` to `high`.
std::pair<double, double> pairOf(JsonView view, double low, double high) {
  if (view.expectArray(2, 2) != 2) return {};
  const double first = view.at(std::size_t{0}).number(low, high);
  return {first, view.at(std::size_t{1}).number(low, high)};
}

std::pair<int, int> countsOf(JsonView view) {
  if (view.expectArray(2, 2) != 2) return {};
  const auto first = static_cast<int>(view.at(std::size_t{0}).count(0, kLargest));
  return {first, static_cast<int>(view.at(std::size_t{1}).count(0, kLargest))};
}

Offset offsetOf(const JsonView& view) {
  const auto [x, y] = pairOf(view, -kMostSum, kMostSum);
  return {x, y};
}

Place placeOf(JsonView view, const OutputForm& form) {
  if (!view.isText()) {
    const auto [column, row] = countsOf(view);
    if (column >= form.mesh_columns || row >= form.mesh_rows) view.addFault("a point of the mesh");
    return {Place::Of::kMesh, column, row};
  }
  const auto corner = cornerNamed(view.text(kLongestName));
  if (!corner) view.addFault("the name of a corner");
  return corner.value_or(Place{});
}

std::array<double, 8> cornersOf(JsonView view) {
  std::array<double, 8> corners{};
  if (view.expectArray(corners.size(), corners.size()) != corners.size()) return corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = view.at(i).number(-kMostSum, kMostSum);
  return corners;
}

OutputAlignment outputOf(JsonView view) {
  view.allowKeys({"output", "size", "mesh", "corners", "moved"});
  OutputAlignment output;
  output.form.output = view.at("output").text(kLongestName);
  std::tie(output.form.width, output.form.height) = countsOf(view.at("size"));
  std::tie(output.form.mesh_columns, output.form.mesh_rows) = countsOf(view.at("mesh"));
  if (view.has("corners")) output.form.corners = cornersOf(view.at("corners"));
  JsonView moved = view.at("moved");
  const std::size_t count = moved.expectArray(0, kMostMoved);
  for (std::size_t i = 0; i < count; ++i) {
    JsonView one = moved.at(i);
    one.allowKeys({"place", "by"});
    output.moved[placeOf(one.at("place"), output.form)] = offsetOf(one.at("by"));
  }
  return output;
}

Step stepOf(JsonView view, const Alignment& alignment) {
  view.allowKeys({"output", "changes"});
  Step step{view.at("output").text(kLongestName), {}};
  const OutputAlignment* const of = alignment.find(step.output);
  if (!of) view.at("output").addFault("one of the outputs above");
  JsonView changes = view.at("changes");
  const std::size_t count = changes.expectArray(1, kMostChanges);
  for (std::size_t i = 0; of && i < count; ++i) {
    JsonView one = changes.at(i);
    one.allowKeys({"place", "before", "after"});
    step.changes.push_back({placeOf(one.at("place"), of->form), offsetOf(one.at("before")),
                            offsetOf(one.at("after"))});
  }
  return step;
}

// Returns true for "on" and false for "off"; anything else is a fault.
bool switchOf(JsonView view) {
  const std::string word = view.text(kLongestName);
  if (word != "on" && word != "off") view.addFault("on or off");
  return word == "on";
}

ProjectorSwitch projectorsOf(JsonView view) {
  view.allowKeys({"switched", "local_minute"});
  return {switchOf(view.at("switched")),
          static_cast<std::int64_t>(view.at("local_minute").count(0, kMostMinutes))};
}

Alignment alignmentOf(JsonView view) {
  view.allowKeys({"outputs", "steps", "done"});
  Alignment alignment;
  JsonView outputs = view.at("outputs");
  const std::size_t count = outputs.expectArray(0, kMostAligned);
  for (std::size_t i = 0; i < count; ++i) {
    auto output = outputOf(outputs.at(i));
    if (alignment.find(output.form.output)) outputs.at(i).addFault("each output once");
    alignment.outputs.push_back(std::move(output));
  }
  JsonView steps = view.at("steps");
  const std::size_t steps_count = steps.expectArray(0, kMostSteps);
  for (std::size_t i = 0; i < steps_count; ++i)
    alignment.steps.push_back(stepOf(steps.at(i), alignment));
  alignment.done = view.at("done").count(0, alignment.steps.size());
  return alignment;
}

SetAside setAsideOf(JsonView view) {
  SetAside aside;
  const std::size_t count = view.expectArray(0, kMostAside);
  for (std::size_t i = 0; i < count; ++i) {
    JsonView one = view.at(i);
    Alignment alignment = alignmentOf(one);
    if (alignment.outputs.size() != 1)
      one.addFault("the alignment of one output");
    else
      aside.add(std::move(alignment));
  }
  return aside;
}

State stateOf(JsonView root) {
  State state;
  const std::uint64_t version = root.at(kVersionKey).count(1, 1'000'000);
  if (version > kStateVersion) {
    root.at(kVersionKey)
        .addFault(fmt::format("{}, the version that this merlind reads; a newer merlind wrote the "
                              "file",
                              kStateVersion),
                  {}, Errc::kUnsupported);
    return state;
  }
  root.allowKeys(
      {kVersionKey, "rate_hz", "content", "playlist", "projectors", "set_aside", "alignment"});
  if (root.has("rate_hz")) state.rate_hz = root.at("rate_hz").number(kLeastRate, kMostRate);
  if (root.has("content")) state.content = root.at("content").text(kLongestPath);
  if (root.has("playlist")) state.playlist_off = !switchOf(root.at("playlist"));
  if (root.has("projectors")) state.projectors = projectorsOf(root.at("projectors"));
  if (root.has("set_aside")) state.set_aside = setAsideOf(root.at("set_aside"));
  state.alignment = alignmentOf(root.at("alignment"));
  return state;
}

// Returns the alignment as JSON, with a line for each output and each step.
std::string textOf(const Alignment& alignment) {
  std::vector<std::string> outputs, steps;
  for (const auto& output : alignment.outputs) outputs.push_back(lineOf(textOf(output)));
  for (const auto& step : alignment.steps) steps.push_back(lineOf(textOf(step)));
  return fmt::format("{{\"outputs\": [\n{}],\n\"steps\": [\n{}],\n\"done\": {}}}",
                     fmt::join(outputs, ",\n"), fmt::join(steps, ",\n"), alignment.done);
}

}  // namespace

const OutputAlignment* alignmentFor(const State& state, const OutputForm& now) {
  const OutputAlignment* const own = state.alignment.find(now.output);
  if (own && own->form.fits(now)) return own;
  const std::vector<Alignment>& aside = state.set_aside.alignments();
  for (std::size_t i = aside.size(); i-- > 0;) {
    const OutputAlignment& one = aside[i].outputs.front();
    if (one.form.fits(now)) return &one;
  }
  return nullptr;
}

std::string stateText(const State& state) {
  std::string text = fmt::format("{{\"{}\": {},\n", kVersionKey, kStateVersion);
  if (state.rate_hz) text += fmt::format("\"rate_hz\": {},\n", lineOf(*state.rate_hz));
  if (!state.content.empty()) text += fmt::format("\"content\": {},\n", lineOf(state.content));
  if (state.playlist_off) text += "\"playlist\": \"off\",\n";
  if (const auto& p = state.projectors) {
    // A clock with an empty battery may show a time before 1970, which parseState() would refuse.
    const auto minute = std::clamp<std::int64_t>(p->local_minute, 0, kMostMinutes);
    text += fmt::format("\"projectors\": {{\"switched\": \"{}\", \"local_minute\": {}}},\n",
                        p->on ? "on" : "off", minute);
  }
  std::vector<std::string> aside;
  for (const Alignment& alignment : state.set_aside.alignments())
    aside.push_back(textOf(alignment));
  if (!aside.empty()) text += fmt::format("\"set_aside\": [\n{}],\n", fmt::join(aside, ",\n"));
  text += fmt::format("\"alignment\": {}}}\n", textOf(state.alignment));
  return text;
}

Result<State> parseState(std::string_view text, const std::string& file) {
  const auto tree = parseJson(text);
  if (!tree) return Error{Errc::kMalformed, fmt::format("{}: {}", file, tree.error().what)};
  std::optional<Error> error;
  State state = stateOf(JsonView(&*tree, "", file, error));
  if (error) return *std::move(error);
  return state;
}

}  // namespace merlin::state
