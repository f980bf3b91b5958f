// A person at the operator's page: a headless Chromium, on a desktop and on a phone.
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/sanitizer.h"
#include "render/panel/panel_layout.h"
#include "tests/support/page_process.h"
#include "tests/support/pyramids.h"

namespace merlin::test {
namespace {

// Returns the pixel of the mode button in the frame; the operator's tile is the lower right one of
// the default wall.
std::string modeButton() {
  const auto layout = *render::panel::layOutPanel(640, 480, 13, {});
  const render::text::Rect r = layout.find(render::panel::ControlId::kMode)->at;
  return fmt::format("{} {}", 640 + layout.at.x + r.x + r.width / 2,
                     480 + layout.at.y + r.y + r.height / 2);
}

class Browser : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    for (const char* program : {"chromium", "chromedriver", "python3"}) {
      if (run({"which", program}).status != 0) GTEST_SKIP() << program << " is not installed";
    }
  }

  TempDir dir_;
};

TEST_P(Browser, ShowsTheWallAndSendsWhatAPersonDoes) {
  const int port = freePagePort();
  const std::string model = makeModel(dir_, 5);
  MerlindOptions options{.script = "still"};
  const std::string meadow = dir_ / "meadow.tif";
  writeText(meadow, pyramidBytes({.width = 1600, .height = 400}));
  options.also = {
      {"page", {{"port", port}}},
      {"wall",
       {{"operator", {{"panel", true}}},
        {"contents", {{{"model", model}, {"name", "again"}}, {{"picture", meadow}}}},
        {"outputs",
         {{{"kind", "shared_memory"}}, {{"kind", "png"}, {"path", dir_ / "out.png"}}}}}}};
  Merlind wall(dir_, model, "browser", options);
  ASSERT_TRUE(wall.ready()) << wall.process().output();
  std::filesystem::copy(meadow, dir_ / (wall.instance() + ".shown/valley.tif"));
  PageProcess page(dir_, wall.config(), wall.instance(), port);
  ASSERT_TRUE(page.ready()) << page.process().output();
  ASSERT_TRUE(eventually([&] { return page.runs("wall") && page.runs("devices"); }));

  const Outcome seen =
      run({"python3", "-B", kSource + "/tests/system/page_browser.py",
           fmt::format("http://127.0.0.1:{}/", port), page.token(),
           fmt::format("{} status --json --instance {}", kMerlin, wall.instance()), dir_.path(),
           GetParam(), modeButton(), std::to_string(wall.process().pid())});
  EXPECT_EQ(seen.status, 0) << seen.output << page.process().output();
  EXPECT_EQ(page.process().kill(SIGTERM), 0) << page.process().output();
}

// Only one size with a sanitizer: Chromium is not instrumented, and merlin-page does the same for
// both sizes.
#ifdef MERLIN_ANY_SANITIZER
const auto kSizes = testing::Values("phone");
#else
const auto kSizes = testing::Values("desktop", "phone");
#endif
INSTANTIATE_TEST_SUITE_P(Sizes, Browser, kSizes,
                         [](const auto& size) { return std::string(size.param); });

}  // namespace
}  // namespace merlin::test
