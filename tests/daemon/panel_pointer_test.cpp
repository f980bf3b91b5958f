// Which pointer events belong to the operator's panel, and what merlind is sent of them.
#include "daemon/base/panel_pointer.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace merlin {
namespace {

using std::chrono::milliseconds;

class PanelPointerTest : public testing::Test {
 protected:
  PanelPointerTest() { pointer_.place(PanelPointer::Place{400, 100, 200, 300, 640, 480}); }
  std::vector<std::string> told(Duration later = {}) {
    now_ += later;
    std::vector<std::string> all;
    while (const auto one = pointer_.take(now_)) all.push_back(*one);
    return all;
  }

  PanelPointer pointer_;
  Timestamp now_{std::chrono::seconds(100)};
};

using Told = std::vector<std::string>;

TEST_F(PanelPointerTest, APressOnThePanelIsItsOwnUntilItIsReleased) {
  EXPECT_TRUE(pointer_.point(400, 100, false));
  EXPECT_TRUE(pointer_.point(400, 100, true));
  EXPECT_TRUE(pointer_.point(10, 20, true)) << "dragged away";
  EXPECT_TRUE(pointer_.point(10, 20, false));
  EXPECT_FALSE(pointer_.point(10, 20, true));
  EXPECT_EQ(told(), (Told{"1040 580 0", "1040 580 1", "650 500 1", "650 500 0", "out"}));
}

TEST_F(PanelPointerTest, ADragThatBeganElsewhereIsNotThePanels) {
  EXPECT_FALSE(pointer_.point(399, 100, true));
  EXPECT_FALSE(pointer_.point(450, 200, true));
  EXPECT_FALSE(pointer_.point(600, 200, true));
  EXPECT_EQ(told(), Told{});
  EXPECT_TRUE(pointer_.point(450, 200, false)) << "released there, it hovers";
  EXPECT_EQ(told(), Told{"1090 680 0"});
}

TEST_F(PanelPointerTest, MotionsAreOneAndPressesStayWhereTheyWere) {
  for (int x = 401; x < 420; ++x) pointer_.point(x, 150, false);
  pointer_.point(420, 150, true);
  for (int x = 421; x < 440; ++x) pointer_.point(x, 150, true);
  pointer_.point(440, 150, false);
  EXPECT_EQ(told(), (Told{"1041 630 0", "1059 630 0", "1060 630 1", "1079 630 1", "1080 630 0"}));
}

TEST_F(PanelPointerTest, WhatIsHeldIsToldAgain) {
  pointer_.point(450, 200, true);
  EXPECT_EQ(told(), Told{"1090 680 1"});
  EXPECT_EQ(told(milliseconds(499)), Told{});
  EXPECT_EQ(told(milliseconds(1)), Told{"1090 680 1"});
  pointer_.point(450, 200, false);
  EXPECT_EQ(told(), Told{"1090 680 0"});
  EXPECT_EQ(told(milliseconds(5000)), Told{});
}

TEST_F(PanelPointerTest, ItLeavesOnce) {
  pointer_.point(450, 200, false);
  told();
  pointer_.point(10, 10, false);
  pointer_.point(11, 10, false);
  pointer_.leave();
  EXPECT_EQ(told(), Told{"out"});
}

TEST_F(PanelPointerTest, APanelThatIsGoneLetsGo) {
  pointer_.point(450, 200, true);
  pointer_.place(std::nullopt);
  EXPECT_EQ(told(), (Told{"1090 680 1", "out"}));
  EXPECT_FALSE(pointer_.point(450, 200, true));
  EXPECT_EQ(told(), Told{});
}

TEST_F(PanelPointerTest, WhatNobodyTakesIsBoundedAndTheNewestIsKept) {
  for (int i = 0; i < 1000; ++i) pointer_.point(450, 200, i % 2 == 0);
  pointer_.point(451, 200, true);
  const Told all = told();
  EXPECT_LE(all.size(), 32U);
  EXPECT_EQ(all.back(), "1091 680 1");
}

}  // namespace
}  // namespace merlin
