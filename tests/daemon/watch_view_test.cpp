// The table of merlin watch: how a status document is arranged on a screen of a given size.
#include "daemon/cli/watch/watch_view.h"

#include <gtest/gtest.h>

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

const char* const kStatus = R"({
  "time_utc": "2026-11-25T14:05:07.000250Z", "roles": {"wall": {"pid": 1, "uptime_s": 7985.5}},
  "rate_asked": 30, "rate_held": 29.94, "late_percent": 0.02, "late_percent_1s": 0,
  "late_percent_1min": 1.5, "longest_late": 2, "moving": true, "grabbed": false, "shown": "picture",
  "work_median_ms": 12.44, "utilisation": 0.373, "rate_divisor": 1,
  "detail": {"step": 3, "steps": 12, "cost": 48210, "full_cost": 91204, "held_cost": 0,
             "unit": "triangles"},
  "content": {"name": "scan", "kind": "model", "slide": "", "refused": ""},
  "devices": {"glove": {"health": "ok", "rate_hz": 99.96, "identity": "CyberGlove", "reason": ""},
              "ball": {"health": "absent", "reason": "/dev/ttyS1: no such file"}},
  "outputs": {"left": {"kind": "kms", "health": "ok", "shown_hz": 30, "late_percent": 0.1},
              "right": {"kind": "kms", "health": "failed", "reason": "unplugged"}}})";

WatchedState state() {
  WatchedState s;
  s.name = "merlin";
  s.status = Json::parse(kStatus);
  s.events = {{"2026-11-25T14:03:00.5Z", "ball: absent"}, {"2026-11-25T14:04:59Z", "left: ok"}};
  for (int i = 0; i < 60; ++i) s.frame_times.add(12.5);
  return s;
}

std::vector<std::string> linesOf(const CellGrid& grid) {
  std::vector<std::string> lines;
  for (int row = 0; row < grid.rows(); ++row) lines.push_back(grid.line(row));
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

// Returns the style of the first cell of this text.
CellStyle styleOf(const CellGrid& grid, const std::string& text) {
  for (int row = 0; row < grid.rows(); ++row) {
    const auto at = grid.line(row).find(text);
    if (at != std::string::npos) return grid.at(row, static_cast<int>(at)).style;
  }
  ADD_FAILURE() << text << " is not shown";
  return CellStyle::kPlain;
}

TEST(WatchView, ShowsWallDevicesOutputsChartAndEvents) {
  const auto lines = linesOf(layOut(state(), {26, 80}, false));
  const std::string bars(60, '#'), period(60, '-');
  const std::vector<std::string> expected = {
      "merlin watch: merlin  14:05:07 UTC  up 2 h 13 min                         q quits",
      "rate      29.9 of 30 Hz, moving",
      "late      0.00 % (second), 1.50 % (minute), 0.02 % (all); at most 2 in a row",
      "frame     12.4 ms (median of the last second), 37 % of the period",
      "detail    48210 triangles, step 3 of 12; full 91204",
      "content   scan (model)",
      "",
      "devices",
      "  glove            ok        100.0 Hz  CyberGlove",
      "  ball             absent              /dev/ttyS1: no such file",
      "",
      "outputs",
      "  left             ok         30.0 Hz  kms, 0.10 % late",
      "  right            failed              unplugged",
      "",
      "frame times of the last minute  each second's median; ---- is the period",
      "    33.3 ms" + period,
      "",
      "",
      "           " + bars,
      "           " + bars,
      "           " + bars};
  ASSERT_GE(lines.size(), expected.size());
  // The first line, the title, also has a hint at its right edge.
  for (std::size_t i = 1; i < expected.size(); ++i) EXPECT_EQ(lines[i], expected[i]) << i;
  EXPECT_TRUE(lines[0].starts_with("merlin watch: merlin  14:05:07 UTC  up 2 h 13 min"));
  EXPECT_TRUE(lines[0].ends_with(" q quits"));
  EXPECT_EQ(lines[0].size(), 80U);
  EXPECT_EQ(lines.back(), "  14:04:59  left: ok");
}

TEST(WatchView, ColoursSayWhatIsWrong) {
  WatchedState s = state();
  const CellGrid grid = layOut(s, {26, 80}, false);
  EXPECT_EQ(styleOf(grid, "failed"), CellStyle::kBad);
  EXPECT_EQ(styleOf(grid, "absent "), CellStyle::kWarning);
  EXPECT_EQ(styleOf(grid, "0.00 % (second"), CellStyle::kGood);
  s.status["late_percent_1s"] = 4;
  EXPECT_EQ(styleOf(layOut(s, {26, 80}, false), "4.00 % (second"), CellStyle::kWarning);
}

TEST(WatchView, AServiceThatHasFailedIsShownWithItsReason) {
  WatchedState s = state();
  const std::size_t before = linesOf(layOut(s, {14, 80}, false)).size();
  s.status["services"] = Json::parse(
      R"({"shared memory": {"health": "ok", "reason": ""},
          "configuration": {"health": "failed", "reason": "merlin.json: line 3: unknown key"}})");
  const CellGrid grid = layOut(s, {17, 80}, false);
  const auto lines = linesOf(grid);
  ASSERT_EQ(lines.size(), before + 3);
  EXPECT_EQ(lines[15], "services");
  EXPECT_EQ(lines[16], "  configuration    failed              merlin.json: line 3: unknown key");
  EXPECT_EQ(styleOf(grid, "failed              merlin.json"), CellStyle::kBad);
  EXPECT_EQ(styleOf(grid, "unknown key"), CellStyle::kPlain);
}

TEST(WatchView, ARoleThatWasKilledIsTheFirstRow) {
  WatchedState s = state();
  s.status["lost_roles"]["devices"] = {{"silent_s", 12.0},
                                       {"reason", "does not run; it ended 12 s ago"}};
  const CellGrid grid = layOut(s, {26, 80}, false);
  EXPECT_EQ(grid.line(1), "devices   does not run; it ended 12 s ago");
  EXPECT_EQ(styleOf(grid, "does not run"), CellStyle::kBad);
  EXPECT_TRUE(grid.line(2).starts_with("rate "));
}

TEST(WatchView, WhileNoDaemonAnswersTheLastStateIsDim) {
  WatchedState s = state();
  s.absent = "no merlind runs as \"merlin\"";
  const CellGrid grid = layOut(s, {26, 80}, false);
  EXPECT_EQ(grid.line(1), s.absent);
  EXPECT_EQ(styleOf(grid, s.absent), CellStyle::kBad);
  EXPECT_EQ(styleOf(grid, "29.9 of 30"), CellStyle::kDim);
}

TEST(WatchView, ATerminalThatIsTooSmallSaysSo) {
  for (int rows = 0; rows < 40; ++rows) {
    const CellGrid grid = layOut(state(), {rows, 80}, true);
    ASSERT_EQ(grid.rows(), rows);
    if (rows >= 2 && rows < 14) {
      EXPECT_TRUE(grid.line(rows - 1).ends_with(" more rows: make the terminal taller")) << rows;
    } else if (rows >= 14) {
      EXPECT_EQ(grid.line(13), "  right            failed              unplugged");
    }
  }
  EXPECT_EQ(layOut(state(), {5, 80}, false).line(4), "10 more rows: make the terminal taller");
  EXPECT_EQ(layOut(state(), {24, 0}, false).columns(), 0);
  EXPECT_EQ(layOut(state(), {-1, -1}, false).rows(), 0);
}

// If there is room for a few events only, the newest ones are shown.
TEST(WatchView, ManyEventsLeaveTheChartItsPlace) {
  WatchedState s = state();
  for (int i = 0; i < 50; ++i) s.events.push_back({"2026-11-25T15:00:00Z", std::to_string(i)});
  const auto lines = linesOf(layOut(s, {24, 80}, false));
  EXPECT_EQ(lines.back(), "  15:00:00  49");
  EXPECT_EQ(lines[15], "frame times of the last minute  each second's median; ---- is the period");
}

TEST(WatchView, AnyDocumentIsShown) {
  WatchedState s = state();
  for (const char* document :
       {"{}", "[]", "null", R"({"rate_asked": "x", "devices": 5, "outputs": [1], "detail": null})",
        R"({"rate_asked": 1e300, "devices": {"a": 1, "b": {"health": 3}}, "time_utc": "short"})",
        R"({"roles": {"wall": {"uptime_s": 1e300}}, "outputs": {"x": {"reason": "\u001b[2J"}}})"}) {
    s.status = Json::parse(document);
    if (!s.status.is_object()) s.status = Json::object();
    const CellGrid grid = layOut(s, {24, 80}, true);
    for (int row = 0; row < grid.rows(); ++row) {
      for (const char c : grid.line(row)) EXPECT_NE(c, '\x1b');
    }
  }
}

TEST(CellGrid, WritesOneCellForEachCharacterAndNothingOutside) {
  CellGrid grid(2, 8);
  EXPECT_EQ(grid.put(0, 0, "M\xC3\xBCnchen\xFF\x1B"), 9);
  EXPECT_EQ(grid.line(0), "M\xC3\xBCnchen?");
  grid.put(1, 4, "\xE4\xBD\xA0\xCC\x81!");  // a wide character and a combining one
  EXPECT_EQ(grid.line(1), std::string("    ?") + "?!");
  grid.put(2, 0, "x");
  grid.put(-1, 0, "x");
  grid.put(1, -2, "abc");
  EXPECT_EQ(grid.line(1), std::string("c   ?") + "?!");
}

TEST(FrameChart, ABarIsAsHighAsItsTimeAndLateOnesAreBad) {
  FrameTimes times;
  times.add(10);
  times.add(std::nullopt);
  times.add(40);
  CellGrid grid(4, 29);
  drawChart(grid, {0, 0, 4, 29}, times, 20, false);
  // There are 20 columns of bars. The newest of three seconds is at the right; a bar of 40 ms is
  // four rows high.
  EXPECT_EQ(grid.line(0), "  40.0 ms" + std::string(19, ' ') + "#");
  EXPECT_EQ(grid.line(1), std::string(28, ' ') + "#");
  EXPECT_EQ(grid.line(2), "  20.0 ms" + std::string(19, '-') + "#");
  EXPECT_EQ(grid.line(3), std::string(26, ' ') + "# #");
  EXPECT_EQ(grid.at(3, 26).style, CellStyle::kGood);
  EXPECT_EQ(grid.at(3, 28).style, CellStyle::kBad);
}

TEST(FrameChart, BlocksShowEighthsOfARow) {
  FrameTimes times;
  for (int i = 0; i < 100; ++i) times.add(i < 99 ? 16.0 : 5.0);
  EXPECT_EQ(times.all().size(), FrameTimes::kSeconds);
  CellGrid grid(2, 69);
  drawChart(grid, {0, 0, 2, 69}, times, 0, true);
  EXPECT_EQ(grid.at(1, 68).glyph, U'\u2585');
  EXPECT_EQ(grid.at(1, 9).glyph, U'\u2588');
  EXPECT_EQ(grid.at(0, 68).glyph, U' ');
}

TEST(FrameChart, NoPlaceOrNoTimesDrawNoBar) {
  CellGrid grid(4, 29);
  drawChart(grid, {0, 0, 1, 29}, {}, 20, true);
  drawChart(grid, {0, 0, 4, 19}, {}, 20, true);
  EXPECT_EQ(grid.line(0), "");
  drawChart(grid, {0, 0, 4, 29}, {}, 0, true);
  EXPECT_EQ(grid.line(0), "   1.0 ms");
  EXPECT_EQ(grid.line(3), "");
}

}  // namespace
}  // namespace merlin::cli
