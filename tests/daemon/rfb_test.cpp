// merlin-rfb without its library: which part of a frame it shows, what its input means, and the
// settings.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/base/commands.h"
#include "daemon/rfb/card.h"
#include "daemon/rfb/input_map.h"
#include "daemon/rfb/settings.h"
#include "daemon/rfb/view.h"
#include "tests/support/temp_dir.h"

namespace merlin::rfb {
namespace {

using render::out::CapturedFrame;
using render::out::framebuffer::TileRectangle;
using test::TempDir;
using test::writeText;

TileRectangle tile(const std::string& name, unsigned kind, const Rectangle& r, int wall_x,
                   int wall_y = 0) {
  TileRectangle made{};
  name.copy(made.name, sizeof made.name);
  made.kind = kind;
  made.x = r.x;
  made.y = r.y;
  made.width = r.width;
  made.height = r.height;
  made.wall_x = wall_x;
  made.wall_y = wall_x < 0 ? -1 : wall_y;
  return made;
}

// Returns a frame with two wall tiles above the operator's view; in the frame they are in the
// opposite order. A pixel's red is its x in the frame, its green its y.
CapturedFrame frameOfThree() {
  CapturedFrame frame;
  frame.width = 160;
  frame.height = 130;
  frame.wall_width = 160;
  frame.wall_height = 70;
  frame.tiles = {tile("left", 0, {80, 0, 80, 70}, 0), tile("right", 0, {0, 0, 80, 70}, 80),
                 tile("operator", 1, {0, 70, 90, 60}, -1)};
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      for (const int value : {x, y, 7, 255})
        frame.pixels.push_back(static_cast<std::uint8_t>(value));
    }
  }
  return frame;
}

struct Shown {
  int width, height;
  std::vector<std::uint8_t> pixels;
  // Returns the frame position from which the pixel at (x, y) was copied, read from its red and
  // green.
  std::pair<int, int> from(int x, int y) const {
    const auto at = static_cast<std::size_t>(4 * (y * width + x));
    return {pixels[at], pixels[at + 1]};
  }
};

Shown show(const CapturedFrame& frame, const View& view) {
  const auto layout = layoutOf(frame, view);
  EXPECT_TRUE(layout) << layout.error().what;
  Shown shown{layout->width, layout->height, {}};
  shown.pixels.resize(static_cast<std::size_t>(4 * shown.width * shown.height));
  copyChanged(frame, *layout, shown.pixels);
  return shown;
}

TEST(RfbView, OfTheWallHasItsTilesSideBySideInTheWallsOrder) {
  const Shown wall = show(frameOfThree(), {});
  EXPECT_EQ(wall.width, 160);
  EXPECT_EQ(wall.height, 70);
  EXPECT_EQ(wall.from(0, 0), std::pair(80, 0));
  EXPECT_EQ(wall.from(79, 69), std::pair(159, 69));
  EXPECT_EQ(wall.from(80, 1), std::pair(0, 1));
  EXPECT_EQ(wall.pixels, render::out::wallPicture(frameOfThree()).pixels);
}

TEST(RfbView, OfTheWallHasItsRows) {
  CapturedFrame frame = frameOfThree();
  frame.wall_width = 80;
  frame.wall_height = 140;
  frame.tiles[0] = tile("below", 0, {80, 0, 80, 70}, 0, 70);
  frame.tiles[1] = tile("above", 0, {0, 0, 80, 70}, 0, 0);
  const Shown wall = show(frame, {});
  EXPECT_EQ(wall.height, 140);
  EXPECT_EQ(wall.from(79, 69), std::pair(79, 69));
  EXPECT_EQ(wall.from(0, 70), std::pair(80, 0));
  EXPECT_EQ(wall.from(79, 139), std::pair(159, 69));
  EXPECT_EQ(wall.pixels, render::out::wallPicture(frame).pixels);
}

TEST(RfbView, OfTheOperatorOrATileIsThatTileAlone) {
  const Shown operators = show(frameOfThree(), {View::Kind::kOperator, ""});
  EXPECT_EQ(operators.width, 90);
  EXPECT_EQ(operators.height, 60);
  EXPECT_EQ(operators.from(89, 59), std::pair(89, 129));
  const Shown left = show(frameOfThree(), {View::Kind::kTile, "left"});
  EXPECT_EQ(left.width, 80);
  EXPECT_EQ(left.from(0, 0), std::pair(80, 0));
}

TEST(RfbView, ThatTheWallDoesNotHaveIsAnErrorWhichListsItsTiles) {
  const auto lost = layoutOf(frameOfThree(), {View::Kind::kTile, "centre"});
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().what, "this wall has no tile centre; its tiles are left, right, operator");
  CapturedFrame walls = frameOfThree();
  walls.tiles.pop_back();
  EXPECT_FALSE(layoutOf(walls, {View::Kind::kOperator, ""}));
  CapturedFrame none = frameOfThree();
  none.tiles.erase(none.tiles.begin(), none.tiles.begin() + 2);
  EXPECT_FALSE(layoutOf(none, {}));
  CapturedFrame large = frameOfThree();
  large.wall_width = large.wall_height = 524288;
  EXPECT_EQ(layoutOf(large, {}).error().what,
            "the wall's tiles in rows and columns are 524288 x 524288 pixels, too many for VNC; "
            "choose one tile, or the operator's view");
  TileRectangle unended = tile("", 0, {0, 0, 8, 8}, 0);
  std::fill(std::begin(unended.name), std::end(unended.name), 'x');
  none.tiles = {unended};
  EXPECT_EQ(layoutOf(none, {View::Kind::kTile, "y"}).error().what,
            "this wall has no tile y; its tiles are xxxxxxxxxxxxxxxx");
}

TEST(RfbView, ReportsTheBlocksThatChangedAndNoOthers) {
  CapturedFrame frame = frameOfThree();
  const auto layout = layoutOf(frame, {});
  std::vector<std::uint8_t> canvas(static_cast<std::size_t>(4 * 160 * 70));
  EXPECT_EQ(copyChanged(frame, *layout, canvas).size(), 8U);
  EXPECT_TRUE(copyChanged(frame, *layout, canvas).empty());
  // Frame position (5, 66) belongs to the tile right, at (85, 66) of the wall: in the block below
  // the first.
  frame.pixels[static_cast<std::size_t>(4 * (66 * frame.width + 5))] = 200;
  // This pixel is in the operator's view, which is not shown.
  frame.pixels[static_cast<std::size_t>(4 * (120 * frame.width + 5))] = 200;
  EXPECT_EQ(copyChanged(frame, *layout, canvas), (std::vector<Rectangle>{{80, 64, 64, 6}}));
  EXPECT_EQ(canvas[static_cast<std::size_t>(4 * (66 * 160 + 85))], 200);
}

TEST(RfbCard, WritesInTheMiddleOfAnySize) {
  for (const auto& [width, height] : {std::pair(640, 480), {1920, 480}, {16, 16}, {1, 1}}) {
    std::vector<std::uint8_t> canvas(static_cast<std::size_t>(4 * width * height));
    drawCard("no merlind shows a wall\nThe picture returns.", canvas, width, height);
    EXPECT_EQ(canvas[0], 48);
    if (width > 16) {
      EXPECT_GT(std::count(canvas.begin(), canvas.end(), 230), 1000);
    }
  }
}

constexpr std::uint32_t kShift = 0xFFE1, kArrowRight = 0xFF53, kHomeKey = 0xFF50,
                        kPageUpKey = 0xFF55;

TEST(RfbInput, ADragTurnsByHalfATurnOverThePicturesHeight) {
  InputMap map;
  map.pointer(0, 100, 100, 480);
  map.pointer(1, 100, 100, 480);
  map.pointer(1, 340, 100, 480);
  map.pointer(1, 340, 220, 480);
  EXPECT_EQ(map.take(), (Request{"move", "0.0000 0.0000 0.0000 45.000 90.000 0.000"}));
  EXPECT_FALSE(map.take());
  map.pointer(0, 0, 0, 480);  // the button is released
  map.pointer(0, 99, 99, 480);
  EXPECT_FALSE(map.take());
}

TEST(RfbInput, ADragWithShiftOrTheMiddleButtonMoves) {
  InputMap shift, middle;
  shift.key(kShift, true);
  for (InputMap* map : {&shift, &middle}) {
    const unsigned button = map == &shift ? 1 : 2;
    map->pointer(button, 0, 0, 300);
    map->pointer(button, 100, -50, 300);
    EXPECT_EQ(map->take(), (Request{"move", "0.5000 0.2500 0.0000 0.000 0.000 0.000"}));
  }
  shift.key(kShift, false);
  shift.pointer(1, 0, -50, 300);
  EXPECT_EQ(shift.take(), (Request{"move", "0.0000 0.0000 0.0000 0.000 -60.000 0.000"}));
}

TEST(RfbInput, EachNotchOfTheWheelMovesOnce) {
  InputMap map;
  for (const unsigned buttons : {8U, 8U, 0U, 8U, 0U, 16U, 0U, 16U, 0U, 16U, 0U})
    map.pointer(buttons, 1, 1, 9);
  EXPECT_EQ(map.take(), (Request{"move", "0.0000 0.0000 -0.1000 0.000 0.000 0.000"}));
}

TEST(RfbInput, KeysAreCommandsAndDoNotRepeatWhileHeld) {
  InputMap map;
  for (int i = 0; i < 5; ++i) map.key('n', true);
  map.key('n', false);
  map.key(kHomeKey, true);
  map.key('x', true);
  EXPECT_EQ(map.take(), (Request{"next_content"}));
  EXPECT_EQ(map.take(), (Request{"reset_view"}));
  EXPECT_FALSE(map.take());
  for (const std::uint32_t key : {kPageUpKey, std::uint32_t{'p'}}) {
    map.key(key, true);
    EXPECT_EQ(map.take(), (Request{"previous_content"}));
  }
  for (int i = 0; i < 3; ++i) map.key(kArrowRight, true);  // arrow keys add up
  map.key('+', true);
  EXPECT_EQ(map.take(), (Request{"move", "0.0000 0.0000 0.1000 0.000 15.000 0.000"}));
}

TEST(RfbInput, WhatNobodyTakesStaysSmallAndWithinTheCommandsLimits) {
  InputMap map;
  for (int i = 0; i < 10'000; ++i) {
    map.key('r', true);
    map.key('r', false);
    map.key(static_cast<std::uint32_t>(1'000 + i), true);
    map.pointer(1, i % 2 * 1'000'000, 0, 1);
    map.pointer(8, 0, 0, 1);
    map.pointer(0, 0, 0, 1);
  }
  map.pointer(1, 0, 0, 1);
  map.pointer(1, 65535, 65535, 1);
  int commands = 0;
  while (map.take()->command == "reset_view") ++commands;
  EXPECT_EQ(commands, 8);
  map.pointer(1, 0, 0, 1);
  EXPECT_EQ(map.take()->argument, "0.0000 0.0000 0.0000 -360.000 -360.000 0.000");
}

TEST(RfbSettings, ListenIsAnAddressAndAPort) {
  const auto good = parseListen("192.168.1.7:5901");
  ASSERT_TRUE(good);
  EXPECT_EQ(good->address, "192.168.1.7");
  EXPECT_EQ(good->port, 5901);
  for (const char* bad : {"", ":", "5900", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536",
                          "127.0.0.1:-1", "127.0.0.1:5x", "localhost:5900", "[::1]:5900", "*:5900"})
    EXPECT_FALSE(parseListen(bad)) << bad;
}

TEST(RfbSettings, OnlyLoopbackNeedsNoPassword) {
  const auto valid = [](const std::string& address, const std::string& password) {
    RfbSettings settings;
    settings.listen.address = address;
    settings.password = password;
    return validate(settings).ok();
  };
  EXPECT_TRUE(valid("127.0.0.1", ""));
  EXPECT_TRUE(valid("127.9.9.9", ""));
  EXPECT_FALSE(valid("0.0.0.0", ""));
  EXPECT_FALSE(valid("192.168.1.7", ""));
  EXPECT_TRUE(valid("0.0.0.0", "secret"));
}

TEST(RfbSettings, ThePasswordsFileIsForItsOwnerOnly) {
  const TempDir dir;
  const std::string file = dir / "password";
  writeText(file, "s3cret!\nmore\n");
  const auto fault = [&](unsigned mode) {
    EXPECT_EQ(::chmod(file.c_str(), mode), 0);
    const auto read = readPassword(file);
    return read ? "" : read.error().what;
  };
  EXPECT_EQ(fault(0600), "");
  EXPECT_EQ(fault(0400), "");
  EXPECT_EQ(*readPassword(file), "s3cret!");
  for (const unsigned mode : {0640U, 0604U, 0620U, 0610U}) {
    EXPECT_NE(fault(mode).find("run chmod 600 " + file), std::string::npos) << fault(mode);
  }
  ::chmod(file.c_str(), 0600);
  for (const char* bad : {"", "\n", "123456789\n", "two words\n", "gr\xC3\xBC\n"}) {
    writeText(file, bad);
    EXPECT_NE(fault(0600).find("1 to 8 characters"), std::string::npos) << bad;
  }
  EXPECT_EQ(readPassword(dir / "none").error().code, Errc::kNotFound);
  EXPECT_NE(readPassword(dir.path()).error().what.find("not a regular file"), std::string::npos);
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  EXPECT_FALSE(readPassword(dir / "pipe"));  // the call does not wait for a writer
}

TEST(RfbInput, WhatIsOnTheOperatorsPanelDoesNotTurnTheModel) {
  InputMap map;
  map.panel().place(PanelPointer::Place{100, 0, 50, 50, 640, 480});
  const auto told = [&] { return map.panel().take(Timestamp()); };
  map.pointer(1, 110, 10, 480);
  map.pointer(1, 400, 300, 480);
  map.pointer(0, 400, 300, 480);
  EXPECT_FALSE(map.take());
  EXPECT_EQ(told(), "750 490 1");
  EXPECT_EQ(told(), "1040 780 1");
  map.pointer(1, 10, 10, 480);
  map.pointer(1, 110, 10, 480);
  EXPECT_TRUE(map.take()) << "a drag that began beside it";
  map.pointer(0, 110, 10, 480);
  map.pointer(2, 110, 10, 480);
  map.pointer(2, 120, 10, 480);
  EXPECT_TRUE(map.take()) << "another button";
}

}  // namespace
}  // namespace merlin::rfb
