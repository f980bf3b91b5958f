// Stereo from the configuration to the image files: the pictures of both eyes, and how an output
// combines them.
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/image/image_file.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

class Stereo : public testing::Test {
 protected:
  // Returns the settings of an output with one tile.
  json output(const std::string& name, const std::string& tile) {
    return {{"kind", "png"},
            {"name", name},
            {"path", dir_ / (name + ".png")},
            {"tiles", json::array({{{"tile", tile}}})}};
  }
  std::string file(const json& stereo, const json& outputs) {
    const json config = {{"instance", privateName("stereo")},
                         {"run_directory", dir_.path()},
                         {"wall", {{"model", model_}, {"stereo", stereo}, {"outputs", outputs}}}};
    writeText(dir_ / "wall.json", config.dump(1));
    return dir_ / "wall.json";
  }
  // Runs merlind until the last of the images exists.
  void show(const std::string& config, const std::string& last) const {
    run({"/bin/sh", "-c",
         fmt::format("{} --config {} & pid=$!; for i in $(seq 300); do [ -e {} ] && break; sleep "
                     "0.1; done; sleep 0.3; kill $pid; wait $pid",
                     kMerlind, config, dir_ / (last + ".png"))});
  }
  render::image::ImageFile image(const std::string& name) const {
    auto read = render::image::readImage(dir_ / (name + ".png"));
    EXPECT_TRUE(read) << read.error().what;
    return read ? *std::move(read) : render::image::ImageFile{};
  }

  TempDir dir_;
  std::string model_ = makeModel(dir_, 2);
};

TEST_F(Stereo, AnOutputsAnaglyphIsMadeOfBothEyesPictures) {
  show(file({{"mode", "anaglyph"}, {"eye_separation_m", 0.2}}, {{{"kind", "shared_memory"}},
                                                                output("left", "centre.L"),
                                                                output("right", "centre.R"),
                                                                output("both", "centre")}),
       "both");
  const auto left = image("left"), right = image("right"), both = image("both");
  ASSERT_EQ(both.width, 640);
  ASSERT_EQ(both.height, 480);
  ASSERT_EQ(left.pixels.size(), both.pixels.size());
  ASSERT_EQ(right.pixels.size(), both.pixels.size());
  EXPECT_NE(left.pixels, right.pixels);
  for (std::size_t i = 0; i < both.pixels.size(); i += 3) {
    const double light =
        0.299 * left.pixels[i] + 0.587 * left.pixels[i + 1] + 0.114 * left.pixels[i + 2];
    ASSERT_NEAR(both.pixels[i], light, 1) << i / 3;
    ASSERT_EQ(both.pixels[i + 1], right.pixels[i + 1]) << i / 3;
    ASSERT_EQ(both.pixels[i + 2], right.pixels[i + 2]) << i / 3;
  }
}

// The combined picture is as large as the tile; each half shows one eye's picture.
TEST_F(Stereo, SideBySideIsTheLeftEyesPictureOnTheLeft) {
  show(file({{"mode", "side_by_side"}, {"eye_separation_m", 0.2}},
            {{{"kind", "shared_memory"}}, output("left", "centre.L"), output("both", "centre")}),
       "both");
  const auto left = image("left"), both = image("both");
  ASSERT_EQ(left.width, 320);
  ASSERT_EQ(both.width, 640);
  ASSERT_EQ(both.height, 480);
  int differs_on_the_right = 0;
  for (std::size_t y = 0; y < 480; ++y) {
    for (std::size_t x = 0; x < 960; ++x) {
      ASSERT_EQ(both.pixels[1920 * y + x], left.pixels[960 * y + x]) << x << " " << y;
      differs_on_the_right += both.pixels[1920 * y + 960 + x] != left.pixels[960 * y + x] ? 1 : 0;
    }
  }
  EXPECT_GT(differs_on_the_right, 1000);
}

TEST_F(Stereo, WhatCannotBeShownIsRefusedWithItsPlace) {
  const Outcome checked = run(
      {kMerlind, "--check-config",
       file({{"mode", "two_outputs"}}, {{{"kind", "shared_memory"}}, output("left", "centre.L")})});
  EXPECT_EQ(checked.status, 2);
  EXPECT_NE(checked.output.find("/wall/stereo/mode is two_outputs, and tile left has no output for "
                                "each eye: let one output show left.L and another one left.R "
                                "(/wall/outputs/N/tiles)"),
            std::string::npos)
      << checked.output;
}

}  // namespace
}  // namespace merlin::test
