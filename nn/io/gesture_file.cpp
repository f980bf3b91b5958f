#include "nn/io/gesture_file.h"

#include <algorithm>
#include <exception>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/files.h"
#include "daemon/json/json_view.h"

namespace merlin::nn {
namespace {

using nlohmann::json;

constexpr std::uint64_t kGestureVersion = 1;
constexpr std::uint64_t kMostGestureVersions = 1000;
constexpr double kMostNumber = 1e6;
// Least diagonal element of a whitening matrix; small, since a feature that says nothing has a
// large deviation.
constexpr double kLeastDiagonal = 1e-6;
constexpr std::size_t kLongestOrigin = 200;
constexpr auto kMostStrokes = std::numeric_limits<std::uint64_t>::max();

template <typename Numbers>
void readNumbers(JsonView view, Numbers& numbers) {
  view.expectArray(numbers.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = static_cast<float>(view.at(i).number(-kMostNumber, kMostNumber));
}

void readFeatures(JsonView view) {
  view.expectArray(kFeatures, kFeatures);
  for (std::size_t i = 0; i < kFeatures; ++i) {
    JsonView name = view.at(i);
    if (name.text(kLongestOrigin) != kFeatureNames[i])
      name.addFault(fmt::format("\"{}\"", kFeatureNames[i]));
  }
}

TrainedGesture readGesture(JsonView view) {
  view.allowKeys({"name", "limit", "least_odds", "mean", "whitening", "discriminant"});
  TrainedGesture gesture;
  JsonView name = view.at("name");
  gesture.name = name.text(kLongestOrigin);
  if (!isGestureName(gesture.name))
    name.addFault(fmt::format("1 to {} letters, digits, - or _, and not \"{}\"",
                              kLongestGestureName, kNoGesture));
  gesture.limit = static_cast<float>(view.at("limit").number(kLeastDiagonal, kMostNumber));
  gesture.least_odds = static_cast<float>(view.at("least_odds").number(-kMostNumber, kMostNumber));
  readNumbers(view.at("mean"), gesture.strokes.mean);
  JsonView whitening = view.at("whitening");
  readNumbers(whitening, gesture.strokes.whitening);
  for (std::size_t row = 0, at = 0; row < kFeatures; at += ++row + 1)
    whitening.at(at).number(kLeastDiagonal, kMostNumber);
  JsonView discriminant = view.at("discriminant");
  if (discriminant.expectArray(0, kTerms) > 0)
    readNumbers(discriminant, gesture.discriminant.emplace());
  return gesture;
}

void readGestures(JsonView list, GestureModel& model) {
  const std::size_t size = list.expectArray(1, kMostGestures);
  for (std::size_t n = 0; n < size; ++n) {
    TrainedGesture gesture = readGesture(list.at(n));
    const bool twice = std::any_of(model.gestures.begin(), model.gestures.end(),
                                   [&](const auto& g) { return g.name == gesture.name; });
    if (twice) list.at(n).at("name").addFault("a name that no other gesture has");
    model.gestures.push_back(std::move(gesture));
  }
}

GestureProvenance readOrigin(JsonView view) {
  view.allowKeys({"how", "takes", "ordinary", "synthetic"});
  GestureProvenance trained;
  trained.how = view.at("how").text(kLongestOrigin);
  trained.takes = view.at("takes").count(0, kMostStrokes);
  trained.ordinary = view.at("ordinary").count(0, kMostStrokes);
  trained.synthetic = view.at("synthetic").boolean();
  return trained;
}

GestureFile readGestureDocument(JsonView root) {
  GestureFile file;
  JsonView version = root.at("version");
  if (version.count(0, kMostGestureVersions) != kGestureVersion) {
    version.addFault(
        fmt::format("{}, the version that this release of MERLIN reads", kGestureVersion), {},
        Errc::kUnsupported);
  }
  root.allowKeys({"version", "features", "gestures", "trained"});
  readFeatures(root.at("features"));
  readGestures(root.at("gestures"), file.model);
  file.trained = readOrigin(root.at("trained"));
  return file;
}

// Writes each number in fmt's shortest form that reads back as the same float; `+ 0` turns -0 into
// 0.
template <typename Numbers>
std::string formatNumbers(const Numbers& numbers) {
  std::string out = "[";
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out += fmt::format("{}{}", i == 0 ? "" : ", ", numbers[i] + 0.0F);
  return out + "]";
}

std::string formatGesture(const TrainedGesture& gesture) {
  return fmt::format(
      "    {{\"name\": \"{}\", \"limit\": {}, \"least_odds\": {},\n"
      "     \"mean\": {},\n     \"whitening\": {},\n     \"discriminant\": {}}}",
      gesture.name, gesture.limit, gesture.least_odds + 0.0F, formatNumbers(gesture.strokes.mean),
      formatNumbers(gesture.strokes.whitening),
      gesture.discriminant ? formatNumbers(*gesture.discriminant) : "[]");
}

}  // namespace

Result<GestureFile> parseGestures(std::string_view text, const std::string& file) {
  try {
    const auto document = parseJson(text);
    if (!document) return Error{document.error().code, file + ": " + document.error().what};
    std::optional<Error> error;
    GestureFile read = readGestureDocument(JsonView(&*document, "", file, error));
    if (error) return *std::move(error);
    return read;
  } catch (const std::exception& ex) {  // out of memory
    return Error{Errc::kMalformed, file + ": " + ex.what()};
  }
}

Result<GestureFile> loadGestures(const std::string& path) {
  const auto file = FileCopy::read(path, kMostJsonBytes + 1);
  if (!file) return file.error();
  return parseGestures(file->text(), path);
}

std::string formatGestures(const GestureFile& file) {
  constexpr auto kReplace = json::error_handler_t::replace;  // `how` may contain invalid UTF-8
  std::string features, gestures;
  for (const char* const name : kFeatureNames)
    features += fmt::format("{}\"{}\"", features.empty() ? "" : ", ", name);
  for (const TrainedGesture& gesture : file.model.gestures)
    gestures += (gestures.empty() ? "" : ",\n") + formatGesture(gesture);
  return fmt::format(
      "{{\n  \"version\": {},\n  \"features\": [{}],\n  \"gestures\": [\n{}\n  ],\n"
      "  \"trained\": {{\"how\": {}, \"takes\": {}, \"ordinary\": {}, \"synthetic\": {}}}\n}}\n",
      kGestureVersion, features, gestures, json(file.trained.how).dump(-1, ' ', false, kReplace),
      file.trained.takes, file.trained.ordinary, file.trained.synthetic);
}

Result<Ok> saveGestures(const std::string& path, const GestureFile& file) {
  const std::string text = formatGestures(file);
  if (const auto read = parseGestures(text, path); !read)
    return Error{Errc::kInvalidArgument, "not written: " + read.error().what};
  return writeFile(path, text);
}

}  // namespace merlin::nn
