// Correction of an output, from the configuration to the image file. The correction is given in the
// configuration itself, or by an MPCDI file.
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/correct/io/archive.h"
#include "render/image/image_file.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

class Correction : public testing::Test {
 protected:
  // Writes the configuration of a wall that shows only its background and has this correction on
  // the output "left"; returns its path.
  std::string file(const std::string& name, const json& correction,
                   const std::string& place = "auto") {
    const json png = {{"kind", "png"},
                      {"name", "left"},
                      {"path", dir_ / (name + ".png")},
                      {"tiles", json::array({{{"tile", "left"}}})},
                      {"correction", correction}};
    const json config = {{"instance", privateName("correct")},
                         {"run_directory", dir_.path()},
                         {"wall",
                          {{"model", model_},
                           {"scene", {{"model_distance_m", 1000}}},
                           {"render", {{"background", {0.2, 0.4, 0.6}}, {"correction", place}}},
                           {"outputs", json::array({{{"kind", "shared_memory"}}, png})}}}};
    writeText(dir_ / (name + ".json"), config.dump(1));
    return dir_ / (name + ".json");
  }

  // Runs merlind and returns the image that it wrote for the output "left".
  render::image::ImageFile shown(const std::string& name, const json& correction,
                                 const std::string& place = "auto") {
    const std::string config = file(name, correction, place), picture = dir_ / (name + ".png");
    run({"/bin/sh", "-c",
         fmt::format("{} --config {} & pid=$!; for i in $(seq 300); do [ -e {} ] && break; sleep "
                     "0.1; done; kill $pid; wait $pid",
                     kMerlind, config, picture)});
    auto read = render::image::readImage(picture);
    EXPECT_TRUE(read) << read.error().what;
    return read ? *std::move(read)
                : render::image::ImageFile{640, 480, std::vector<std::uint8_t>(921600)};
  }

  TempDir dir_;
  std::string model_ = makeModel(dir_, 2);
  const std::string mpcdi_ = dir_ / "wall.mpcdi";
};

const json kCorners = {40, 20, -30, 0, 5, -12, -8, -40};
const json kCorrection = {{"corners", {40, 20, -30, 0, 5, -12, -8, -40}},
                          {"blend", {{"right", 96}, {"gamma", 2.4}}},
                          {"black", {{"level", {0.02, 0.02, 0.02}}}}};

TEST_F(Correction, AnExportedCorrectionShowsTheSamePicture) {
  const std::string config = file("by_hand", kCorrection);
  const Outcome exported = run({kMerlin, "wall", "mpcdi", "export", mpcdi_, "-c", config});
  EXPECT_EQ(exported.status, 0) << exported.output;
  const std::string settings = dir_ / "correction.json";
  const Outcome imported = run({kMerlin, "wall", "mpcdi", "import", mpcdi_, "-o", settings});
  EXPECT_EQ(imported.status, 0) << imported.output;
  const json correction = json::parse(readText(settings))["left"]["correction"];
  EXPECT_EQ(correction["mpcdi"], mpcdi_);

  const auto by_hand = shown("by_hand", kCorrection), by_file = shown("by_file", correction);
  ASSERT_EQ(by_hand.pixels.size(), by_file.pixels.size());
  for (std::size_t i = 0; i < by_hand.pixels.size(); ++i)
    ASSERT_NEAR(by_hand.pixels[i], by_file.pixels[i], 1) << i / 3 % 640 << " " << i / 3 / 640;
  const auto at = [&](int x, int y) {
    return by_hand.pixels[static_cast<std::size_t>(3 * (640 * y + x) + 2)];
  };
  EXPECT_EQ(at(10, 10), 0) << "beyond the corner";
  EXPECT_NEAR(at(300, 200), 156, 1) << "0.6 ^ 2.4 * 0.98 + 0.02 of the light";
  EXPECT_LT(at(600, 200), 100) << "in the ramp";
}

// The shader runs on whatever OpenGL driver there is, usually a software renderer.
TEST_F(Correction, TheShaderShowsTheCpusPicture) {
  const auto cpu = shown("cpu", kCorrection, "cpu"), gpu = shown("gpu", kCorrection, "gpu");
  ASSERT_EQ(cpu.pixels.size(), gpu.pixels.size());
  for (std::size_t i = 0; i < cpu.pixels.size(); ++i)
    ASSERT_NEAR(cpu.pixels[i], gpu.pixels[i], 1) << i / 3 % 640 << " " << i / 3 / 640;
}

TEST_F(Correction, WhatCannotBeUsedIsRefusedWithItsPlace) {
  const auto finding = [&](const json& correction) {
    const Outcome checked = run({kMerlind, "--check-config", file("bad", correction)});
    EXPECT_EQ(checked.status, 2) << checked.output;
    return checked.output;
  };
  EXPECT_NE(finding({{"corners", {900, 900, 0, 0, 0, 0, 0, 0}}})
                .find("/wall/outputs/1/correction/corners do not form a convex picture"),
            std::string::npos);
  EXPECT_NE(finding({{"mesh", {{"columns", 3}, {"rows", 3}}}})
                .find("/wall/outputs/1/correction/mesh/points has 0 points"),
            std::string::npos);
}

// One damaged file, for example after a power cut, must not keep the wall dark.
TEST_F(Correction, ADamagedMpcdiFileCostsOneOutputItsCorrection) {
  writeText(mpcdi_, "PK\x03\x04 but no more");
  const Outcome checked =
      run({kMerlind, "--check-config", file("cut", {{"mpcdi", mpcdi_}, {"corners", kCorners}})});
  EXPECT_EQ(checked.status, 1) << "adjusted: " << checked.output;
  EXPECT_NE(checked.output.find("/wall/outputs/1/correction/mpcdi cannot be used: " + mpcdi_ +
                                ": is not a complete zip archive"),
            std::string::npos)
      << checked.output;
  const auto cut = shown("cut", {{"mpcdi", mpcdi_}, {"corners", kCorners}}),
             without = shown("without", {{"corners", kCorners}});
  EXPECT_EQ(cut.pixels, without.pixels);
}

// Two cases: the region is a part of its buffer, as other programs write it; and the tool never
// filled the warp.
TEST_F(Correction, WhatAnMpcdiFileHasThatShowsAnotherPictureIsSaid) {
  const auto imported = [&](const std::string& place, const std::string& cells) {
    using Entries = std::vector<std::pair<std::string, std::string>>;
    const std::string xml = fmt::format(
        "<MPCDI profile='2d' version='2.0'><display><buffer id='wall'><region id='right' "
        "xResolution='640' yResolution='480' {}/></buffer></display><files><fileset "
        "region='right'><geometryWarpFile><path>w.pfm</path></geometryWarpFile></fileset></files>"
        "</MPCDI>",
        place);
    const auto bytes = render::correct::zipBytes(
        Entries{{"mpcdi.xml", xml}, {"w.pfm", "PF\n2 2\n-1.0\n" + cells}});
    writeText(mpcdi_, *bytes);
    return run({kMerlin, "wall", "mpcdi", "import", mpcdi_});
  };
  std::string cells;
  for (const float value :
       {0.25F, 0.25F, 0.F, 0.75F, 0.25F, 0.F, 0.25F, 0.75F, 0.F, 0.75F, 0.75F, 0.F})
    cells.append(reinterpret_cast<const char*>(&value), sizeof value);
  const Outcome part = imported("x='0.5' y='0' xSize='0.5' ySize='1'", cells);
  EXPECT_EQ(part.status, 0) << part.output;
  EXPECT_NE(part.output.find("region right shows only a part of the picture of buffer wall: x 0.5, "
                             "y 0, xSize 0.5, ySize 1. MERLIN takes the picture of the output for "
                             "that part: let its tiles show this part and no more"),
            std::string::npos)
      << part.output;
  const Outcome whole = imported("x='0' y='0' xSize='1' ySize='1'", cells);
  EXPECT_EQ(whole.output.find("only a part"), std::string::npos) << whole.output;
  const std::string fault =
      mpcdi_ + ": w.pfm: the warp of region \"right\" has (0, 0) in every cell";
  const Outcome zero = imported("", std::string(48, '\0'));
  EXPECT_EQ(zero.status, 2) << zero.output;
  EXPECT_NE(zero.output.find(fault), std::string::npos) << zero.output;
  const Outcome checked = run({kMerlind, "--check-config", file("zero", {{"mpcdi", mpcdi_}})});
  EXPECT_EQ(checked.status, 1) << "adjusted: " << checked.output;
  EXPECT_NE(checked.output.find("/wall/outputs/1/correction/mpcdi cannot be used: " + fault),
            std::string::npos)
      << checked.output;
}

TEST_F(Correction, AnMpcdiRegionThatIsNotThereCostsOneOutputItsCorrectionAndTheStatusSaysSo) {
  ASSERT_EQ(
      run({kMerlin, "wall", "mpcdi", "export", mpcdi_, "-c", file("by_hand", kCorrection)}).status,
      0);
  json config = json::parse(readText(file("other", {{"mpcdi", mpcdi_}, {"mpcdi_region", "zz"}})));
  const std::string instance = privateName("region");
  config["instance"] = instance;
  writeText(dir_ / "other.json", config.dump(1));
  Process wall({kMerlind, "--config", dir_ / "other.json"});
  EXPECT_TRUE(eventually([&] {
    const Outcome status = run({kMerlin, "status", "--json", "--instance", instance});
    const json now = json::parse(status.output, nullptr, false);
    if (!now.is_object() || !now.contains("services")) return false;
    const json service = now["services"].value("correction", json::object());
    return service.value("health", "") == "failed" &&
           service.value("reason", "").find("has no region \"zz\"") != std::string::npos;
  }));
  EXPECT_EQ(wall.kill(SIGTERM), 0) << wall.output();
}

// A region of another size or name is used nevertheless, since only a person can see whether it
// fits.
TEST_F(Correction, AnMpcdiRegionOfAnotherOutputIsUsedAndSaid) {
  const std::string config = file("by_hand", kCorrection);
  ASSERT_EQ(run({kMerlin, "wall", "mpcdi", "export", mpcdi_, "-c", config}).status, 0);
  json other = json::parse(readText(file("other", {{"mpcdi", mpcdi_}})));
  json second = other["wall"]["outputs"][1];
  second["name"] = "wide";
  second["path"] = dir_ / "wide.png";
  second["tiles"] = json::array({{{"tile", "left"}}, {{"tile", "right"}, {"x", 640}}});
  other["wall"]["outputs"].push_back(second);
  writeText(dir_ / "other.json", other.dump(1));
  const Outcome checked = run({kMerlind, "--check-config", dir_ / "other.json"});
  EXPECT_EQ(checked.status, 1) << "adjusted: " << checked.output;
  for (const char* const said :
       {"/wall/outputs/2/correction/mpcdi is the region that the output left uses too",
        "/wall/outputs/2/correction/mpcdi was measured for 640 x 480 pixels and the output has "
        "1280 x 480: its warp and blend are stretched to that"})
    EXPECT_NE(checked.output.find(said), std::string::npos) << checked.output;
  EXPECT_EQ(checked.output.find("/wall/outputs/1"), std::string::npos) << checked.output;
}

TEST_F(Correction, BadWordsAndFilesOfTheCommandAreSaid) {
  const auto refused = [&](std::vector<std::string> words, const std::string& what) {
    words.insert(words.begin(), {kMerlin, "wall", "mpcdi"});
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_NE(outcome.output.find(what), std::string::npos) << outcome.output;
  };
  const std::string none = file("none", json::object());
  refused({"export", mpcdi_, "-c", none}, "no output has a correction");
  refused({"export", mpcdi_, "-c", none, "--output", "right"}, "there are shared_memory, left");
  refused({"export", dir_ / "a.zip", "-c", none}, "must end in .mpcdi");
  refused({"import", none}, "is not a complete zip archive");
  EXPECT_EQ(
      run({kMerlin, "wall", "mpcdi", "export", mpcdi_, "-c", none, "--output", "left"}).status, 0);
  refused({"import", mpcdi_, "--region", "x"}, "has no region \"x\"; its regions are left");
}

}  // namespace
}  // namespace merlin::test
