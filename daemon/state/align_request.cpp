#include "daemon/state/align_request.h"

#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/printable_text.h"

namespace merlin::state {
namespace {

using Json = nlohmann::ordered_json;

// Splits words off the front of a text; the rest of it is the name of an output.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  std::string_view next() {
    const std::size_t end = rest_.find(' ');
    const std::string_view word = rest_.substr(0, end);
    rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
    return word;
  }
  std::optional<double> number(double most) {
    const std::string_view word = next();
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool good = error == std::errc() && end == word.data() + word.size() &&
                      std::abs(value) <= most;  // also rejects NaN
    return good ? std::optional(value) : std::nullopt;
  }
  std::optional<int> index() {
    const auto value = number(kMostOffset);
    if (!value || *value < 0 || *value != std::floor(*value)) return std::nullopt;
    return static_cast<int>(*value);
  }
  std::string rest() const { return std::string(rest_); }

 private:
  std::string_view rest_;
};

Error malformed(std::string_view argument) {
  return {Errc::kInvalidArgument,
          fmt::format(
              "\"{}\" is not a valid request; allowed are: {}; CORNER is {}; DX and DY are pixels "
              "of the output, at most {} either way, x to the right and y down",
              excerpt(argument), kAlignForms, fmt::join(kCornerNames, ", "), kMostOffset)};
}

std::optional<AlignRequest> moveRequest(Words words, std::optional<Place> place) {
  const auto x = words.number(kMostOffset), y = words.number(kMostOffset);
  std::string output = words.rest();
  if (!place || !x || !y || output.empty()) return std::nullopt;
  return MoveRequest{std::move(output), *place, {*x, *y}};
}

std::optional<AlignRequest> requestOf(std::string_view argument) {
  Words words(argument);
  const std::string_view verb = words.next();
  if (verb == "move") {
    const auto corner = cornerNamed(words.next());
    return moveRequest(words, corner);
  }
  if (verb == "point") {
    const auto column = words.index(), row = words.index();
    if (!column || !row) return std::nullopt;
    return moveRequest(words, Place{Place::Of::kMesh, *column, *row});
  }
  if (verb == "select") {
    const auto corner = cornerNamed(words.next());
    if (!corner || words.rest().empty()) return std::nullopt;
    return SelectRequest{words.rest(), *corner};
  }
  if (verb == "reset" && !words.rest().empty()) return ResetRequest{words.rest()};
  if (argument == "list") return ListRequest{};
  if (argument == "undo") return UndoRequest{};
  if (argument == "redo") return RedoRequest{};
  return std::nullopt;
}

struct TextOf {
  std::string operator()(const ListRequest&) const { return "list"; }
  std::string operator()(const MoveRequest& r) const {
    return fmt::format("{}{} {} {} {}", r.place.of == Place::Of::kPin ? "move " : "",
                       nameOf(r.place), r.by.x, r.by.y, r.output);
  }
  std::string operator()(const ResetRequest& r) const { return fmt::format("reset {}", r.output); }
  std::string operator()(const SelectRequest& r) const {
    return fmt::format("select {} {}", nameOf(r.place), r.output);
  }
  std::string operator()(const UndoRequest&) const { return "undo"; }
  std::string operator()(const RedoRequest&) const { return "redo"; }
};

Json json(const Offset& o) { return Json::array({o.x, o.y}); }

Json json(const SeenAxes& axes) { return {{"right", json(axes.right)}, {"down", json(axes.down)}}; }

Json json(const ReportedOutput& output, const Alignment& alignment) {
  const OutputForm& form = output.form;
  Json corners = Json::object();
  for (std::size_t i = 0; i < 4; ++i) {
    corners[kCornerNames[i]] = {
        {"configured", {output.configured[2 * i], output.configured[2 * i + 1]}},
        {"moved", json(alignment.offset(form.output, cornerAt(i)))}};
  }
  Json points = Json::array();
  if (const OutputAlignment* const of = alignment.find(form.output)) {
    for (const auto& [place, offset] : of->moved) {
      if (place.of != Place::Of::kMesh) continue;
      points.push_back({{"column", place.column}, {"row", place.row}, {"moved", json(offset)}});
    }
  }
  return {{"name", form.output},           {"width", form.width},
          {"height", form.height},         {"mesh", {form.mesh_columns, form.mesh_rows}},
          {"pending", output.pending},     {"seen", json(output.axes)},
          {"corners", std::move(corners)}, {"points", std::move(points)}};
}

}  // namespace

Result<AlignRequest> parseAlignRequest(std::string_view argument) {
  if (const auto request = requestOf(argument)) return *request;
  return malformed(argument);
}

std::string textOf(const AlignRequest& request) { return std::visit(TextOf{}, request); }

std::string reportText(const AlignReport& report, const Alignment& alignment) {
  Json outputs = Json::array();
  for (const ReportedOutput& output : report.outputs) outputs.push_back(json(output, alignment));
  const Json all = {
      {"outputs", std::move(outputs)},
      {"selected", {{"output", report.selected}, {"place", nameOf(report.selected_place)}}},
      {"undo", alignment.done},
      {"redo", alignment.steps.size() - alignment.done},
      {"done", report.done},
      {"test_card", report.test_card}};
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace merlin::state
