// Pictures that are drawn into the memory that displays show, on a fake card that shares it.
#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/out/kms/displays.h"
#include "tests/support/fake_card.h"
#include "tests/support/fake_clock.h"

namespace merlin::render::out::kms {
namespace {

using std::chrono::seconds;
using test::Bench;
using test::FakeCard;
using test::mode;

class KmsDrawTest : public testing::Test {
 protected:
  KmsDrawTest() { bench_.shares = true; }
  // Output 0 is at connector A-1; output 1 is at A-2, and its pictures are always copied.
  void add(const std::string& first_mode = "640x480@60") {
    displays_.add({"", "A-1", first_mode}, 640, 480);
    displays_.add({"", "A-2", "640x480@60"}, 640, 480);
    step();
  }
  void step() { displays_.step(Duration::zero()); }
  void secondLater() {
    clock_.advance(seconds(1));
    step();
  }
  static std::vector<std::uint8_t> picture(std::uint8_t blue) {
    std::vector<std::uint8_t> pixels(640 * 480 * 4);
    for (std::size_t i = 2; i < pixels.size(); i += 4) pixels[i] = blue;
    return pixels;
  }
  Id idOf(const DrawPlace& place) const {
    return place.buffer ? bench_.buffer_of.at(place.buffer.get()) : 0;
  }
  // Draws as a GPU would: sets the blue of each pixel. The fourth byte keeps its value, as it does
  // when a picture is copied.
  void draw(const DrawPlace& place, std::uint8_t blue) {
    auto& bytes = *bench_.buffers.at(idOf(place));
    for (std::size_t i = 0; i < bytes.size(); i += 4) bytes[i] = blue;
  }
  // Presents a frame, which is drawn for output 0 if the output has memory to draw into; returns
  // this memory.
  std::vector<DrawPlace> present(std::uint8_t blue) {
    const auto places = displays_.beginDrawing(0);
    for (const auto& place : places) draw(place, blue);
    ++sequence_;
    shown_ = displays_.present(0, places.empty() ? picture(blue) : std::vector<std::uint8_t>(),
                               sequence_);
    EXPECT_TRUE(displays_.present(1, picture(blue), sequence_).ok() || !displays_.fault(1).empty());
    return places;
  }

  Bench bench_;
  test::FakeClock clock_;
  Displays displays_{[this]() -> Result<std::unique_ptr<Card>> {
                       return std::unique_ptr<Card>(std::make_unique<FakeCard>(bench_));
                     },
                     clock_};
  std::uint64_t sequence_ = 0;
  Result<std::optional<Timestamp>> shown_ = std::optional<Timestamp>();
};

TEST_F(KmsDrawTest, ADrawnPictureIsCommittedWithoutACopy) {
  add();
  const auto places = present(7);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_EQ(places[0].buffer->width, 640);
  EXPECT_TRUE(shown_ && *shown_);
  step();
  ASSERT_EQ(bench_.commits.size(), 1U) << "together with the display that is copied to";
  EXPECT_EQ(bench_.commits[0].size(), 2U);
  EXPECT_EQ(bench_.commits[0][0].buffer, idOf(places[0]));
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 7}, {22, 7}}));
  EXPECT_EQ(displays_.readBack(0)->at(0).found.digest,
            digestOf({640, 480, picture(7), std::size_t{640} * 4}))
      << "the checks read it as any other";
}

TEST_F(KmsDrawTest, WhatIsShownOrOnItsWayIsNeverDrawnInto) {
  add();
  std::set<Id> drawn;
  Id shown = 0, pending = 0;
  for (int n = 0; n < 24; ++n) {
    bench_.answers_flips = n % 4 == 0;  // otherwise frames wait, and replace one another
    const Id into = idOf(present(static_cast<std::uint8_t>(n)).at(0));
    EXPECT_NE(into, shown) << n;
    EXPECT_NE(into, pending) << n;
    drawn.insert(into);
    const std::size_t before = bench_.commits.size();
    step();
    if (bench_.commits.size() > before) pending = bench_.commits.back()[0].buffer;
    if (n % 4 == 3) bench_.flips = {{21, clock_.now()}, {22, clock_.now()}};
    if (bench_.answers_flips || n % 4 == 3) {
      step();
      shown = pending;
      if (bench_.commits.size() > before + 1) pending = bench_.commits.back()[0].buffer;
    }
  }
  EXPECT_EQ(drawn.size(), 3U);
}

// Drawing takes back the picture that waits for the display. A picture that waits for the other
// display belongs to the same frame, so it must wait too.
TEST_F(KmsDrawTest, NoDisplayChangesAloneWhileAPictureIsDrawnForAnother) {
  add();
  bench_.answers_flips = false;
  present(1);
  step();
  present(2);  // waits on both displays
  ASSERT_EQ(bench_.commits.size(), 1U);
  const auto places = displays_.beginDrawing(0);
  bench_.flips = {{21, clock_.now()}, {22, clock_.now()}};
  step();
  step();
  EXPECT_EQ(bench_.commits.size(), 1U);
  draw(places.at(0), 3);
  ASSERT_TRUE(displays_.present(0, {}, ++sequence_));
  step();
  EXPECT_EQ(bench_.commits.size(), 1U);
  ASSERT_TRUE(displays_.present(1, picture(3), sequence_));
  step();
  ASSERT_EQ(bench_.commits.size(), 2U);
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 3}, {22, 3}}));
}

TEST_F(KmsDrawTest, ASmallerPictureIsDrawnInTheMiddle) {
  add("1024x768");
  const auto places = displays_.beginDrawing(0);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_EQ(places[0].x, 192);
  EXPECT_EQ(places[0].y, 144);
  EXPECT_EQ(places[0].buffer->width, 1024);
}

TEST_F(KmsDrawTest, EveryDisplayOfAnOutputHasAPlaceOfItsOwn) {
  displays_.add({"", "*", ""}, 640, 480);
  step();
  const auto places = displays_.beginDrawing(0);
  ASSERT_EQ(places.size(), 2U);
  EXPECT_NE(idOf(places[0]), idOf(places[1]));
  draw(places[0], 5);
  draw(places[1], 6);
  ASSERT_TRUE(displays_.present(0, {}, 1));
  step();
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 5}, {22, 6}}));
}

TEST_F(KmsDrawTest, MemoryThatIsNotSharedIsAPlaceWithoutABuffer) {
  bench_.shares = false;
  add();
  const auto places = displays_.beginDrawing(0);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_EQ(places[0].buffer, nullptr);
  EXPECT_EQ(displays_.copyReason(0),
            "A-1: the driver of the display's card does not share the memory that is displayed");
  EXPECT_EQ(displays_.copyReason(1), "") << "nobody wanted to draw there";
  ASSERT_TRUE(displays_.present(0, picture(3), 1));
  ASSERT_TRUE(displays_.present(1, picture(3), 1));
  step();
  EXPECT_EQ(bench_.shown[21], 3);
}

// The picture that could not be drawn is copied, and drawing is not tried again before there is new
// memory.
TEST_F(KmsDrawTest, APictureThatIsNotDrawnIsCopiedAndSoAreTheNextOnes) {
  add();
  ASSERT_EQ(displays_.beginDrawing(0).size(), 1U);
  ASSERT_TRUE(displays_.present(0, picture(4), ++sequence_));
  ASSERT_TRUE(displays_.present(1, picture(4), sequence_));
  step();
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 4}, {22, 4}}));
  EXPECT_TRUE(present(5).empty());
  step();
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 5}, {22, 5}}));
  EXPECT_EQ(displays_.beginDrawing(1).size(), 1U) << "each output for itself";
  ASSERT_TRUE(displays_.present(1, {}, sequence_));

  bench_.connectors[0].connected = false;
  secondLater();
  bench_.connectors[0] = test::projector(11, "A-1");
  bench_.connectors[0].modes = {mode(640, 480, 60.2)};
  secondLater();
  EXPECT_EQ(present(6).size(), 1U) << "another display has other memory";

  displays_.showAgain(0);
  step();
  EXPECT_NE(displays_.copyReason(0), "");
  bench_.connectors[0].modes = {mode(640, 480, 60.1)};
  secondLater();
  EXPECT_EQ(displays_.copyReason(0), "") << "that was the memory before";
}

TEST_F(KmsDrawTest, ADisplayThatWasFoundToShowSomethingElseIsCopiedTo) {
  add();
  present(1);
  step();
  EXPECT_EQ(displays_.copyReason(0), "");
  displays_.showAgain(0);
  step();
  EXPECT_TRUE(present(2).empty());
  step();
  EXPECT_EQ(bench_.shown[21], 2);
  EXPECT_EQ(displays_.copyReason(0),
            "A-1: pictures are copied since the checks found another picture on it");
  EXPECT_EQ(displays_.beginDrawing(1).size(), 1U) << "the other output was right";
}

// Nothing was ever drawn for this output, so there is no reason to report why its pictures are
// copied.
TEST_F(KmsDrawTest, ADisplayThatWasAlwaysCopiedToIsSoForNoReason) {
  add();
  present(1);
  step();
  displays_.showAgain(1);
  step();
  EXPECT_EQ(displays_.copyReason(1), "");
}

TEST_F(KmsDrawTest, NothingIsDrawnForADisplayThatShowsNoFrames) {
  add();
  present(1);
  step();
  bench_.other_is_master = true;
  secondLater();
  EXPECT_TRUE(present(2).empty());
  EXPECT_NE(displays_.fault(0).find("desktop (77)"), std::string::npos);
  bench_.other_is_master = false;
  secondLater();
  EXPECT_EQ(present(3).size(), 1U) << "and again once the displays are back";
  step();
  EXPECT_EQ(bench_.shown[21], 3);
  bench_.connectors[0].connected = false;
  secondLater();
  EXPECT_TRUE(present(4).empty());
  step();
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 3}, {22, 4}}));
}

TEST_F(KmsDrawTest, ADisplayThatIsPulledWhileItsPictureIsDrawnDoesNotStopTheOthers) {
  add();
  present(1);
  step();
  const auto places = displays_.beginDrawing(0);
  bench_.connectors[0].connected = false;
  secondLater();
  draw(places.at(0), 2);
  EXPECT_FALSE(displays_.present(0, {}, ++sequence_)) << "the fault";
  ASSERT_TRUE(displays_.present(1, picture(2), sequence_));
  step();
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 1}, {22, 2}}));
}

// The memory remains in use until the picture is presented, although the display has other memory
// by then.
TEST_F(KmsDrawTest, AModeThatChangesWhileAPictureIsDrawnLeavesItsMemory) {
  add("");
  const auto places = displays_.beginDrawing(0);
  const Id drawn = idOf(places.at(0));
  bench_.connectors[0].modes = {mode(640, 480, 50)};
  secondLater();
  draw(places.at(0), 2);
  ASSERT_EQ(bench_.buffers.count(drawn), 1U);
  ASSERT_TRUE(displays_.present(0, {}, ++sequence_));
  EXPECT_EQ(bench_.buffers.count(drawn), 0U) << "nobody needs it any more";
  EXPECT_TRUE(displays_.wantsFrame(0)) << "for the new mode";
  const auto next = present(3);
  ASSERT_EQ(next.size(), 1U);
  step();
  EXPECT_EQ(bench_.shown[21], 3);
}

TEST_F(KmsDrawTest, ADisplayThatIsLitAgainWhileItsPictureIsDrawnAsksForAFrame) {
  add();
  present(1);
  step();
  ASSERT_FALSE(displays_.wantsFrame(0));
  const auto places = displays_.beginDrawing(0);
  bench_.connectors[0].link_bad = true;
  secondLater();
  draw(places.at(0), 2);
  ASSERT_TRUE(displays_.present(0, {}, ++sequence_));
  EXPECT_TRUE(displays_.wantsFrame(0));
}

}  // namespace
}  // namespace merlin::render::out::kms
