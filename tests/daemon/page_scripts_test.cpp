// The computations of the page's scripts, run by node.js; skipped where node.js is not installed.
#include <cstdlib>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "daemon/page/page_files.h"
#include "tests/support/temp_dir.h"

namespace merlin::page {
namespace {

// Returns the result of a function of the page, computed by node.js; nothing where node.js is not
// installed.
std::optional<std::string> runScript(const char* file, const std::string& expression) {
  const test::TempDir dir;
  const std::string script = dir / "script.mjs", result = dir / "result";
  std::string text(findPageFile(file)->content);
  text += "import fs from \"node:fs\";\nfs.writeFileSync(\"" + result + "\", JSON.stringify(" +
          expression + "));\n";
  test::writeText(script, text);
  if (std::system("node --version > /dev/null 2>&1") != 0) return std::nullopt;
  if (std::system(("node " + script).c_str()) != 0) return "node failed";
  return test::readText(result);
}

// Returns the values that `statements` pass to said(), as an array.
std::optional<std::string> saidBy(const char* file, const std::string& statements) {
  return runScript(file, "(() => { const all = [], said = v => all.push(v); " + statements +
                             " return all; })()");
}

TEST(PageScripts, SayEachServiceThatHasFailedOnce) {
  const auto said = runScript("/services.js", R"(failedServices({
    devices: {running: true, status: {services: {configuration: {health: "failed", reason: "line 3"},
                                                 state: {health: "ok", reason: ""}}}},
    wall: {running: true, status: {services: {configuration: {health: "failed", reason: "line 3"},
                                              input: {health: "failed", reason: "refused"}}}},
    gone: {running: false, status: {services: {state: {health: "failed", reason: "old"}}}},
    first: {running: true, status: null}, none: {running: true, status: {}}}))");
  if (!said) GTEST_SKIP() << "node.js is not installed";
  EXPECT_EQ(*said, R"(["Configuration failed: line 3","Input failed: refused"])");
  const std::string_view page = findPageFile("/page.js")->content;
  EXPECT_NE(page.find("of failedServices(roles)) banners.push("), std::string_view::npos);
}

// On a phone, a wide wall is a low strip, and a thumb's swipe over it once turned a model by 127
// degrees.
TEST(PageScripts, ADragTurnsAModelSanelyOnAPhoneAndMovesAPictureWithTheFinger) {
  const auto said = saidBy("/motion.js", R"(
    const motion = new Motion(), drag = (kind, height, right, down) => {
      motion.press(1, 100, 100);
      motion.drag(1, 100 + right, 100 + down, degreesPerPx(kind, height));
      motion.release(1);
      motion.drag(1, 500, 500, 1);
      said(motion.take());
    };
    drag("model", 85, 60, 0);
    drag("model", 600, 60, -30);
    drag("picture", 90, 45, 9);
    drag("panorama", 85, 60, 0);
    drag("model", 300, 10000, -10000);
    said(motion.take());)");
  if (!said) GTEST_SKIP() << "node.js is not installed";
  EXPECT_EQ(*said,
            R"(["0 0 0.0000 0.00 36.00 0","0 0 0.0000 -9.00 18.00 0","0 0 0.0000 18.00 90.00 0",)"
            R"("0 0 0.0000 0.00 36.00 0","0 0 0.0000 -360.00 360.00 0",""])");
}

TEST(PageScripts, TwoFingersAndTheWheelZoomAndTurnNothing) {
  const auto said = saidBy("/motion.js", R"(
    const motion = new Motion();
    motion.press(1, 100, 100);
    motion.press(2, 200, 100);
    motion.drag(2, 300, 100, 1);  // twice as far apart
    said(motion.take());
    motion.drag(1, 300, 300, 1);  // turned about each other
    said(motion.take());
    motion.release(2);
    motion.drag(1, 301, 300, 1);
    said(motion.take());
    motion.release(1);
    motion.wheel(-200);
    motion.notch(-1);
    said(motion.take());)");
  if (!said) GTEST_SKIP() << "node.js is not installed";
  EXPECT_EQ(*said, R"(["0 0 1.3863 0.00 0.00 0","","0 0 0.0000 0.00 1.00 0",)"
                   R"("0 0 0.1000 0.00 0.00 0"])");
}

TEST(PageScripts, SayWhatADragDoesToTheContent) {
  const auto said = saidBy("/motion.js", R"(
    for (const kind of ["model", "picture", "panorama", ""]) said(moveHint(kind, true));
    said(moveHint("picture", false));)");
  if (!said) GTEST_SKIP() << "node.js is not installed";
  EXPECT_EQ(*said, R"(["Drag to turn the model; pinch or turn the wheel to zoom.",)"
                   R"("Drag to move the picture; pinch or turn the wheel to zoom.",)"
                   R"("Drag to look around; pinch or turn the wheel to zoom.",)"
                   R"("Drag to move what is shown; pinch or turn the wheel to zoom.",)"
                   R"("Unlock to move the picture."])");
}

// The page has to use the same rules as PanelPointer of daemon/base.
TEST(PageScripts, WhatIsPressedOnTheOperatorsPanelIsToldInPixelsOfTheFrame) {
  const auto said = saidBy("/panel.js", R"(
    const panel = new PanelPointer(), all_told = now => {
      for (let told; (told = panel.take(now)); ) said(told);
    };
    said(panel.point(110, 60, false));  // it is not shown
    panel.place({x: 100, y: 50, width: 40, height: 20, to_frame_x: 1000, to_frame_y: -20});
    said(panel.point(99, 60, false));
    said(panel.point(139, 69, false));
    said(panel.point(110, 60, false));  // two motions are told as one
    all_told(1000);
    panel.point(110, 60, true);
    all_told(1000);
    said(panel.take(1499));
    said(panel.take(1500));             // it is still held
    said(panel.point(0, 0, true));      // what began on the panel belongs to it
    panel.point(0, 0, false);
    all_told(2000);
    said(panel.point(0, 0, true));      // what began elsewhere does not
    said(panel.point(110, 60, true));
    said(panel.take(9000));)");
  if (!said) GTEST_SKIP() << "node.js is not installed";
  EXPECT_EQ(*said, R"([false,false,true,true,"1139 49 0","1110 40 0","1110 40 1","","1110 40 1",)"
                   R"(true,"1000 -20 1","1000 -20 0","out",false,false,""])");
}

}  // namespace
}  // namespace merlin::page
