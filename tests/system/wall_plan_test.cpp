// merlin wall plan: the drawing, the table, a preset as panels, and rooms that are refused.
#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/eventually.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

const std::string kHinged = MERLIN_SOURCE_DIR "/config/wall-three-160.json";

class WallPlan : public testing::Test {
 protected:
  std::string room(const json& settings) {
    writeText(dir_ / "room.json", json{{"wall", {{"room", settings}}}}.dump(1));
    return dir_ / "room.json";
  }
  TempDir dir_;
};

// Number of occurrences of `part` in `text`.
int countOf(const std::string& part, const std::string& text) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST_F(WallPlan, DrawsPanelsPicturesAndFrustaWithTheTableBelow) {
  const Outcome done = run({kMerlin, "wall", "plan", "-c", kHinged, "-o", dir_ / "room.svg"});
  ASSERT_EQ(done.status, 0) << done.output;
  const std::string svg = readText(dir_ / "room.svg");
  EXPECT_TRUE(svg.starts_with("<svg ")) << svg.substr(0, 80);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_EQ(countOf("<polygon", svg), 3 * 3 + 1) << "panel, picture and frustum each; the arrow";
  EXPECT_EQ(countOf("<path", svg), 2) << "an arc at each hinge";
  for (const char* const words : {">left 28.3°<", ">centre 29.9°<", ">160°<", ">eye 0, 1.6, 0 m<",
                                  ">centre 1.6 x 1.2 m<", ">0.5 m<"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_NE(svg.find("28.27 x 21.87"), std::string::npos) << "the table";
  EXPECT_NE(done.output.find("The frame has 2048 x 1536 pixels."), std::string::npos);
}

TEST_F(WallPlan, PrintsItsTableAsJson) {
  const auto table =
      json::parse(run({kMerlin, "wall", "plan", "--preset", "hexagon", "--json"}).output);
  EXPECT_EQ(table["frame_width"], 1280);
  EXPECT_EQ(table["frame_height"], 1920);
  ASSERT_EQ(table["tiles"].size(), 7u);
  double total_deg = 0;
  for (const json& tile : table["tiles"]) {
    if (tile["kind"] == "operator") continue;
    total_deg += tile["horizontal_deg"].get<double>();
    EXPECT_NEAR(tile["screen"]["distance_m"].get<double>(), 1.38564, 1e-5);
    EXPECT_NEAR(tile["screen"]["pixel_pitch_mm"][1].get<double>(), 2.5, 1e-9);
  }
  EXPECT_NEAR(total_deg, 360, 1e-3);
  EXPECT_EQ(table["tiles"][5]["name"], "rear");
  EXPECT_NEAR(table["tiles"][5]["yaw_deg"].get<double>(), 180, 1e-4);
  EXPECT_TRUE(table["overlaps"].empty());
}

TEST_F(WallPlan, APresetsProjectorsMayOverlap) {
  const Outcome done = run(
      {kMerlin, "wall", "plan", "--preset", "flat", "--overlap", "0.3", "-o", dir_ / "flat.svg"});
  ASSERT_EQ(done.status, 0) << done.output;
  EXPECT_NE(done.output.find("panel_1 and panel_2 overlap by 0.300 x 1.200 m: 107 x 480 pixels of "
                             "panel_1, 107 x 480 of panel_2."),
            std::string::npos)
      << done.output;
  EXPECT_NE(readText(dir_ / "flat.svg")
                .find("panel_2 and panel_3 overlap by 0.300 x 1.200 m: 107 x 480 "),
            std::string::npos);
  EXPECT_NE(run({kMerlin, "wall", "plan", "--preset", "hexagon", "--overlap", "0.3"}).status, 0);
  EXPECT_NE(run({kMerlin, "wall", "plan", "--overlap", "0.3"}).status, 0);
}

TEST_F(WallPlan, APresetIsPrintedAsPanelsThatMakeTheSameWall) {
  for (const char* const preset :
       {"flat", "three_160", "three_120", "six", "hexagon", "arc_160", "arc_120"}) {
    const Outcome printed = run({kMerlin, "wall", "plan", "--preset", preset, "--panels"});
    ASSERT_EQ(printed.status, 0) << printed.output;
    for (const char* noise : {"00000", "99999", "camera", "\"view\""})
      EXPECT_EQ(printed.output.find(noise), std::string::npos) << printed.output;
    writeText(dir_ / "panels.json", printed.output);
    const auto table = [&](const std::string& option, const std::string& value) {
      return json::parse(run({kMerlin, "wall", "plan", option, value, "--json"}).output);
    };
    const json own = table("--config", dir_ / "panels.json"), common = table("--preset", preset);
    ASSERT_EQ(own["tiles"].size(), common["tiles"].size());
    for (std::size_t i = 0; i < own["tiles"].size(); ++i) {
      EXPECT_EQ(own["tiles"][i]["name"], common["tiles"][i]["name"]);
      EXPECT_NEAR(own["tiles"][i]["horizontal_deg"].get<double>(),
                  common["tiles"][i]["horizontal_deg"].get<double>(), 1e-4);
    }
  }
}

TEST_F(WallPlan, SaysWhereProjectorsOverlap) {
  const std::string file = room({{"panels",
                                  {{{"name", "screen"},
                                    {"width_m", 3},
                                    {"height_m", 1.2},
                                    {"lower_left_m", {-1.5, -0.6, -3}}}}},
                                 {"displays",
                                  {{{"name", "<a>"}, {"part_m", {0, 0, 1.6, 1.2}}},
                                   {{"name", "b"}, {"part_m", {1.4, 0, 1.6, 1.2}}}}}});
  const Outcome done = run({kMerlin, "wall", "plan", "-c", file, "-o", dir_ / "room.svg"});
  EXPECT_NE(done.output.find("<a> and b overlap by 0.200 x 1.200 m: "), std::string::npos)
      << done.output;
  EXPECT_EQ(readText(dir_ / "room.svg").find("<a>"), std::string::npos) << "escaped";
}

// Six by five displays, each an output of its own beside the shared memory.
TEST_F(WallPlan, AWallOfThirtyDisplaysShowsEachOfThem) {
  json displays = json::array(), outputs = {{{"kind", "shared_memory"}}};
  for (int i = 0; i < 30; ++i) {
    const std::string name = "display" + std::to_string(i);
    displays.push_back({{"name", name},
                        {"part_m", {0.4 * (i % 6), 0.3 * (i / 6), 0.4, 0.3}},
                        {"width", 32},
                        {"height", 24}});
    outputs.push_back({{"kind", "png"},
                       {"name", name},
                       {"path", dir_ / (name + ".png")},
                       {"interval_s", 1},
                       {"tiles", {{{"tile", name}}}}});
  }
  const json panel = {
      {"name", "screen"}, {"width_m", 2.4}, {"height_m", 1.5}, {"lower_left_m", {-1.2, -0.75, -3}}};
  MerlindOptions options;
  options.also["wall"] = {{"room", {{"panels", {panel}}, {"displays", displays}}},
                          {"outputs", outputs}};
  Merlind wall(dir_, makeModel(dir_, 2), "many", options);
  ASSERT_TRUE(wall.ready()) << wall.process().output();
  EXPECT_TRUE(eventually([&] {
    const json shown = wall.status()["outputs"];
    return shown.size() == 31 && std::all_of(shown.begin(), shown.end(), [](const json& output) {
             return output["health"] == "ok" && output["frames"] > 0;
           });
  })) << wall.status().dump(1);
  for (int i = 0; i < 30; ++i)
    EXPECT_TRUE(std::filesystem::exists(dir_ / ("display" + std::to_string(i) + ".png"))) << i;
}

TEST_F(WallPlan, TilesByHandAreDrawnToo) {
  writeText(dir_ / "c.json", "{}");
  const Outcome done = run({kMerlin, "wall", "plan", "-c", dir_ / "c.json", "-o", dir_ / "w.svg"});
  EXPECT_EQ(done.status, 0) << done.output;
  EXPECT_NE(readText(dir_ / "w.svg").find(">left 40°<"), std::string::npos);
  const Outcome panels = run({kMerlin, "wall", "plan", "-c", dir_ / "c.json", "--panels"});
  EXPECT_EQ(panels.status, 2);
  EXPECT_EQ(panels.output,
            "merlin: this wall has no panels: its tiles are set by hand (/wall/tiles/tiles)\n");
}

TEST_F(WallPlan, RefusesWhatItCannotDraw) {
  const std::string behind = room({{"preset", {{"name", "three_160"}}}, {"eye_m", {0, 0, -9}}});
  const Outcome bad = run({kMerlin, "wall", "plan", "-c", behind, "-o", dir_ / "room.svg"});
  EXPECT_EQ(bad.status, 2);
  EXPECT_NE(
      bad.output.find("/wall/room/preset cannot be used: panel left does not face the viewer"),
      std::string::npos)
      << bad.output;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "room.svg"));
  EXPECT_EQ(run({kMerlin, "wall", "plan", "-c", kHinged, "-o", dir_ / "room.png"}).output,
            "merlin: " + (dir_ / "room.png") + ": the name of a drawing must end in .svg\n");
  EXPECT_EQ(run({kMerlin, "wall", "plan", "-c", kHinged, "--preset", "six"}).output,
            "merlin: wall plan: give --config or --preset, not both\n");
  EXPECT_EQ(run({kMerlin, "wall", "plan", "--preset", "cave"}).status, 2);
  EXPECT_EQ(run({kMerlin, "wall", "plan", "-c", dir_ / "none.json"}).status, 2);
}

}  // namespace
}  // namespace merlin::test
