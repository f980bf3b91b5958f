// merlin trace writes JSON for a trace viewer, with the steps that the documentation names for one
// frame.
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/wall/status_text.h"
#include "daemon/cli/wall/trace_json.h"

namespace merlin::cli {
namespace {

using nlohmann::json;
using shm::StepKind;

// Returns two frames with a period of 33 ms: the first is 2 ms late, the second shows a still
// picture.
std::vector<shm::FrameTrace> frames() {
  shm::FrameTrace late{};
  late.begin_ns = 5'000'000'000;
  late.end_ns = 5'035'000'000;
  late.deadline_ns = 5'033'000'000;
  late.period = 7;
  late.cost = 1234;
  late.moving = late.late = 1;
  std::uint32_t at = 0;
  for (const StepKind kind :
       {StepKind::kInput, StepKind::kScene, StepKind::kGovernor, StepKind::kCut, StepKind::kUpload,
        StepKind::kDraw, StepKind::kReadBack, StepKind::kPresent}) {
    late.steps[late.count++] = {at, 1'500'500, kind, 2};
    at += 2'000'000;
  }
  shm::FrameTrace still = late;
  still.begin_ns = 5'036'000'000;
  still.end_ns = 5'060'000'000;
  still.deadline_ns = 5'066'000'000;
  still.moving = still.late = 0;
  still.count = 1;
  still.steps[0] = {0, 20'000'000, StepKind::kRefine, 0};
  return {late, still};
}

TEST(Trace, HasEachStepOfAFrameInsideOfIt) {
  const auto document = json::parse(traceJson(frames(), {}));
  std::map<std::string, json> by_name;
  for (const json& e : document["traceEvents"]) by_name[e["name"]] = e;
  const json frame = by_name.at("frame");
  EXPECT_EQ(frame["ts"], 0.0);
  EXPECT_EQ(frame["dur"], 35'000.0);
  EXPECT_EQ(frame["args"]["cost"], 1234);
  for (const char* step : {"input", "scene", "governor", "cut", "upload", "draw tile 3",
                           "read-back tile 3", "present"}) {
    ASSERT_TRUE(by_name.count(step)) << step;
    const json& e = by_name[step];
    EXPECT_EQ(e["ph"], "X") << step;
    EXPECT_EQ(e["tid"], frame["tid"]) << step;
    EXPECT_EQ(e["dur"], 1500.5) << step;
    EXPECT_GE(e["ts"], frame["ts"]) << step;
    EXPECT_LE(e["ts"].get<double>() + e["dur"].get<double>(),
              frame["ts"].get<double>() + frame["dur"].get<double>())
        << step;
  }
  EXPECT_EQ(by_name.at("late")["ts"], 33'000.0);
  EXPECT_EQ(by_name.at("still")["ts"], 36'000.0);
  EXPECT_EQ(by_name.at("refine")["ts"], 36'000.0);
}

TEST(Trace, HasASecondThreadsStepsOnATrackOfTheirOwn) {
  shm::FrameTrace frame = frames()[0];
  using enum StepKind;
  const std::vector<shm::TraceStep> steps = {
      {0, 10, kCut, 0},    {10, 10, kUpload, 0}, {20, 60, kDraw, 0},    {80, 5, kReadBack, 0},
      {11, 9, kUpload, 0}, {20, 70, kDraw, 1},   {90, 5, kReadBack, 1}, {100, 9, kPresent, 0}};
  frame.count = static_cast<std::uint32_t>(steps.size());
  std::copy(steps.begin(), steps.end(), frame.steps);
  const auto document = json::parse(traceJson(std::span(&frame, 1), {}));
  std::vector<int> tracks;
  for (const json& e : document["traceEvents"]) {
    if (e["ph"] == "X" && e["cat"] != "frame") tracks.push_back(e["tid"]);
  }
  EXPECT_EQ(tracks, (std::vector{1, 1, 1, 1, 100, 100, 100, 1}));
}

TEST(Trace, HasSamplesOnTracksOfTheirDevices) {
  const SampleInstant samples[] = {
      {"glove", 5'001'000'000}, {"ball", 5'002'000'000}, {"glove", 5'003'000'000}};
  const auto document = json::parse(traceJson(frames(), samples));
  std::set<int> tracks;
  int bytes = 0;
  for (const json& e : document["traceEvents"]) {
    if (e["name"] != "first byte") continue;
    ++bytes;
    tracks.insert(e["tid"].get<int>());
  }
  EXPECT_EQ(bytes, 3);
  EXPECT_EQ(tracks, (std::set<int>{2, 3}));
}

TEST(Trace, OfNothingIsADocumentAllTheSame) {
  EXPECT_TRUE(json::parse(traceJson({}, {}))["traceEvents"].is_array());
}

// The segment is hostile: a step count is beyond the array, or a kind of step is unknown.
TEST(Trace, BelievesNoCount) {
  auto hostile = frames();
  hostile[0].count = 4'000'000'000;
  hostile[0].steps[5].kind = static_cast<StepKind>(999);
  EXPECT_TRUE(json::accept(traceJson(hostile, {})));
}

TEST(Histogram, IsAChartOfEighthsOfThePeriod) {
  std::vector<std::uint32_t> buckets(32);
  EXPECT_EQ(histogramChart(buckets), "");
  buckets[12] = 20;
  buckets[13] = 60;
  buckets[14] = 20;
  buckets[31] = 1;
  const std::string chart = histogramChart(buckets);
  EXPECT_NE(chart.find("   75.0 -  87.5 %  ########################################  79.2 %"),
            std::string::npos)
      << chart;
  EXPECT_NE(chart.find("   87.5 - 100.0 %  ##########"), std::string::npos) << chart;
  EXPECT_NE(chart.find("  187.5 -  more %  #  "), std::string::npos) << chart;
  EXPECT_EQ(std::count(chart.begin(), chart.end(), '\n'), 11);
}

}  // namespace
}  // namespace merlin::cli
