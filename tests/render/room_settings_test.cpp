// Rooms for which no wall can be built: each is refused, and the message gives the reason and a
// remedy.
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "render/room/room_tiles.h"

namespace merlin::render {
namespace {

// Returns two panels of 2 x 1.5 m, hinged at 160 degrees; the eye is 3 m in front of the left one.
room::RoomSettings twoPanels() {
  room::RoomSettings room;
  room.panels = {{"left", 2, 1.5, 0, {-2, 0, -3}}, {"right", 2, 1.5, 160}};
  room.displays = {{"a", "left"}, {"b", "right"}};
  room.eye_m = {-0.5, 0.7, 0};
  return room;
}

struct Fault {
  const char* name;
  std::function<void(room::RoomSettings&)> change;
  const char* pointer;
  const char* message;
};

class WrongRoom : public testing::TestWithParam<Fault> {};

TEST_P(WrongRoom, IsRefused) {
  room::RoomSettings room = twoPanels();
  GetParam().change(room);
  const SettingFaults faults = validate(room, {});
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults[0].pointer, GetParam().pointer);
  EXPECT_EQ(faults[0].what, GetParam().message);
  const auto tiles = room::roomTiles(room, {});
  ASSERT_FALSE(tiles);
  EXPECT_EQ(tiles.error().code, Errc::kInvalidArgument);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void usePreset(room::RoomSettings& room, room::RoomPreset name) {
  room = {};
  room.preset.name = name;
}

const Fault kPanels[] = {
    {"NoPanels", [](room::RoomSettings& r) { r.panels.clear(); }, "",
     "the room has no panels: list them in /panels, or choose a preset in /preset/name (flat, "
     "three_160, three_120, six, hexagon, arc_160, arc_120)"},
    {"BehindTheViewer", [](room::RoomSettings& r) { r.eye_m[2] = -4; }, "/panels/0",
     "panel left does not face the viewer: the eye is 1.000 m behind it; check eye_m, yaw_deg and "
     "the hinges"},
    {"EdgeOn", [](room::RoomSettings& r) { r.eye_m[2] = -3; }, "/panels/0",
     "panel left does not face the viewer: the eye is in its plane"},
    {"TurnedAway", [](room::RoomSettings& r) { r.panels[1].hinge_deg = 300; }, "/panels/1",
     "panel right does not face the viewer: the eye is 1.933 m behind it; check eye_m, yaw_deg and "
     "the hinges"},
    {"HingeWithoutANeighbour", [](room::RoomSettings& r) { r.panels[0].hinge_deg = 160; },
     "/panels/0",
     "panel left is the first: it has no panel on its left that hinge_deg could refer to"},
    {"HingeAndPlace", [](room::RoomSettings& r) { r.panels[1].yaw_deg = 10; }, "/panels/1",
     "panel right has hinge_deg, from which its place follows: leave out lower_left_m, yaw_deg and "
     "pitch_deg, or hinge_deg"},
    {"HingeTooSharp", [](room::RoomSettings& r) { r.panels[1].hinge_deg = 5; }, "/panels/1",
     "panel right: hinge_deg is 5; allowed is 10 to 350 degrees"},
    {"HingeThatIsNoNumber", [](room::RoomSettings& r) { r.panels[1].hinge_deg = kNan; },
     "/panels/1", "panel right: hinge_deg is nan; allowed is 10 to 350 degrees"},
    {"NoSize", [](room::RoomSettings& r) { r.panels[1].width_m = 0; }, "/panels/1",
     "panel right: its size is 0 x 1.5 m; width and height must be 0.01 to 1000 m"},
    {"SizeThatIsNoNumber", [](room::RoomSettings& r) { r.panels[1].height_m = kNan; }, "/panels/1",
     "panel right: its size is 2 x nan m; width and height must be 0.01 to 1000 m"},
    {"PlaceThatIsNoNumber", [](room::RoomSettings& r) { r.panels[0].lower_left_m[1] = kNan; },
     "/panels/0",
     "panel left: lower_left_m, yaw_deg or pitch_deg is not a number, or is beyond 1000 m or 360 "
     "degrees"},
    {"EyeThatIsNoNumber", [](room::RoomSettings& r) { r.eye_m[0] = kInfinity; }, "/eye_m",
     "the eye at inf, 0.7, 0 is not within 1000 m of the room's origin"},
    {"TwoOfOneName", [](room::RoomSettings& r) { r.panels[1].name = "left"; }, "/panels/1",
     "two panels are named \"left\""},
    {"NoName", [](room::RoomSettings& r) { r.panels[0].name = ""; }, "/panels/0",
     "this panel has no name"},
    {"OneAtThePlaceOfTheOther",
     [](room::RoomSettings& r) {
       r.panels[1] = r.panels[0];
       r.panels[1].name = "right";
     },
     "/panels/1",
     "panels left and right are at the same place: give one hinge_deg, or lower_left_m and yaw_deg "
     "of its own"},
    {"TooMany", [](room::RoomSettings& r) { r.panels.resize(33); }, "/panels",
     "33 panels; a room has 32 at most"},
};

const Fault kDisplays[] = {
    {"OutOfItsPanel",
     [](room::RoomSettings& r) {
       r.displays[1].part_m = {1, 0, 1.2, 1.5};
     },
     "/displays/1",
     "display b reaches from 1, 0 to 2.2, 1.5 m and so exceeds panel right of 2 x 1.5 m"},
    {"LeftOfItsPanel",
     [](room::RoomSettings& r) {
       r.displays[1].part_m = {-0.1, 0, 1, 1};
     },
     "/displays/1",
     "display b reaches from -0.1, 0 to 0.9, 1 m and so exceeds panel right of 2 x 1.5 m"},
    {"WithoutArea",
     [](room::RoomSettings& r) {
       r.displays[1].part_m = {0.5, 0, 0, 1};
     },
     "/displays/1", "display b: its part of 0 x 1 m of the panel has no area"},
    {"AllBezel",
     [](room::RoomSettings& r) {
       r.displays[0].bezel_m = {1, 1, 0, 0};
     },
     "/displays/0", "display a: its bezels of 1, 1, 0, 0 m leave nothing of its 2 x 1.5 m"},
    {"PartThatIsNoNumber", [](room::RoomSettings& r) { r.displays[0].part_m[2] = kNan; },
     "/displays/0",
     "display a: part_m or bezel_m contains a value that is not a number, is negative or is beyond "
     "1000 m"},
    {"NegativeBezel", [](room::RoomSettings& r) { r.displays[0].bezel_m[3] = -0.1; }, "/displays/0",
     "display a: part_m or bezel_m contains a value that is not a number, is negative or is beyond "
     "1000 m"},
    {"OnNoPanel", [](room::RoomSettings& r) { r.displays[0].panel = "middle"; }, "/displays/0",
     "display a is on panel \"middle\"; the room's panels are left, right"},
    {"OnNoPanelOfSeveral", [](room::RoomSettings& r) { r.displays[0].panel = ""; }, "/displays/0",
     "display a is on panel \"\"; the room's panels are left, right"},
    {"TwoOfOneName", [](room::RoomSettings& r) { r.displays[1].name = "a"; }, "/displays/1",
     "two displays are named \"a\""},
    {"TheOperatorsName", [](room::RoomSettings& r) { r.displays[1].name = "operator"; },
     "/displays/1",
     "display operator has the name of the operator's tile: name it otherwise, or set "
     "operator_width and operator_height to 0"},
    {"ANameTooLong", [](room::RoomSettings& r) { r.displays[1].name = "a_very_long_name"; },
     "/displays/1", "display a_very_long_name: its name has 16 characters; at most 15 are allowed"},
    {"TooManyPixels", [](room::RoomSettings& r) { r.displays[1].width = 8193; }, "/displays/1",
     "display b: 8193 x 0 pixels; each of the two numbers is 0 to 8192"},
    {"TooNear",
     [](room::RoomSettings& r) {
       r.eye_m = {-1, 0.7, -2.995};
     },
     "/displays/0",
     "display a is 179.43 x 179.23 degrees wide and high for an eye 0.005 m away; each must be "
     "less than 179: move the eye back"},
    {"TooHigh",
     [](room::RoomSettings& r) {
       r.eye_m = {-1, 0.7, -2.995};
       r.displays[0].part_m = {0.99, 0, 0.02, 1.5};
     },
     "/displays/0",
     "display a is 126.87 x 179.23 degrees wide and high for an eye 0.005 m away; each must be "
     "less than 179: move the eye back"},
    {"TooMany", [](room::RoomSettings& r) { r.displays.resize(32, r.displays[0]); }, "/displays",
     "33 tiles including the operator's; a wall has 32 at most"},
    {"AnOperatorWithoutHeight", [](room::RoomSettings& r) { r.operator_height = 0; }, "",
     "the operator's tile of 640 x 0 pixels is not valid: 0 x 0 means no operator's tile, the "
     "largest is 8192 x 8192"},
    {"ACanvasTooLarge",
     [](room::RoomSettings& r) {
       r.displays.clear();
       for (int i = 0; i < 5; ++i)
         r.displays.push_back({std::to_string(i), "left", {}, 8192, 8192});
     },
     "",
     "its 6 tiles need a frame of 16384 x 24576 pixels; the largest is 16384 x 16384: use fewer or "
     "smaller displays"},
};

const Fault kPresets[] = {
    {"WithPanels", [](room::RoomSettings& r) { r.preset.name = room::RoomPreset::kSix; }, "/preset",
     "preset six has panels and displays of its own: leave out /panels and /displays, or leave out "
     "the preset and begin with what `merlin wall plan --panels` prints"},
    {"WithoutAName", [](room::RoomSettings& r) { r.preset.panels = 4; }, "/preset",
     "the preset has values but no name: choose one in /preset/name, or leave the preset out"},
    {"AnOverlapAcrossAHinge",
     [](room::RoomSettings& r) {
       usePreset(r, room::RoomPreset::kThree160);
       r.preset.overlap_m = 0.1;
     },
     "/preset/overlap_m",
     "preset three_160: each projector has a panel of its own, at an angle to its neighbour's; "
     "overlap_m is a setting of presets flat and six"},
    {"AnOverlapOfMoreThanTwo",
     [](room::RoomSettings& r) {
       usePreset(r, room::RoomPreset::kSix);
       r.preset.overlap_m = 0.7;
     },
     "/preset/overlap_m", "preset six: overlap_m is 0.7; allowed is 0 to 0.6 m, half of a panel"},
    {"AnOverlapOfFrames",
     [](room::RoomSettings& r) {
       usePreset(r, room::RoomPreset::kFlat);
       r.preset.overlap_m = 0.2;
       r.preset.bezel_m = 0.01;
     },
     "/preset/overlap_m",
     "preset flat: displays with a frame cannot overlap: leave out overlap_m or bezel_m"},
    {"AFixedNumber",
     [](room::RoomSettings& r) {
       usePreset(r, room::RoomPreset::kHexagon);
       r.preset.panels = 5;
     },
     "/preset/panels",
     "preset hexagon always has 6 panels; their number is a setting of preset flat alone"},
    {"TooMany",
     [](room::RoomSettings& r) {
       usePreset(r, room::RoomPreset::kFlat);
       r.preset.panels = 33;
     },
     "/preset/panels", "preset flat: 33 panels; a room has 1 to 32"},
    {"DistanceThatIsNoNumber",
     [](room::RoomSettings& r) {
       usePreset(r, room::RoomPreset::kFlat);
       r.preset.distance_m = kNan;
     },
     "/preset/distance_m", "preset flat: distance_m is nan; allowed is 0 to 1000 m"},
    {"ANegativeBezel",
     [](room::RoomSettings& r) {
       usePreset(r, room::RoomPreset::kFlat);
       r.preset.bezel_m = -0.01;
     },
     "/preset/bezel_m", "preset flat: bezel_m is -0.01; allowed is 0 to 1000 m"},
    {"AnEyeOutsideTheHexagon",
     [](room::RoomSettings& r) {
       usePreset(r, room::RoomPreset::kHexagon);
       r.eye_m = {0, 0, 2};
     },
     "/preset",
     "panel rear does not face the viewer: the eye is 0.614 m behind it; check eye_m, yaw_deg "
     "and the hinges"},
};

std::string nameOf(const testing::TestParamInfo<Fault>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Panels, WrongRoom, testing::ValuesIn(kPanels), nameOf);
INSTANTIATE_TEST_SUITE_P(Displays, WrongRoom, testing::ValuesIn(kDisplays), nameOf);
INSTANTIATE_TEST_SUITE_P(Presets, WrongRoom, testing::ValuesIn(kPresets), nameOf);

TEST(RoomSettings, AreValidAsTheyAreMeant) {
  EXPECT_TRUE(validate(twoPanels(), {}).empty());
  EXPECT_TRUE(twoPanels().isGiven());
  EXPECT_FALSE(room::RoomSettings{}.isGiven());
  room::RoomSettings room = twoPanels();
  room.displays.clear();
  EXPECT_TRUE(validate(room, {}).empty()) << "one display for each panel";
  room = twoPanels();
  room.displays[0].part_m = {0.5, 0.00005, 1.5, 1.5};
  EXPECT_TRUE(validate(room, {}).empty()) << "a rounding error of a person is none";
}

TEST(RoomSettings, EveryFaultIsFoundAtOnce) {
  room::RoomSettings room = twoPanels();
  room.panels[1].width_m = -1;
  room.displays[0].panel = "nowhere";
  room.eye_m[1] = kNan;
  EXPECT_EQ(validate(room, {}).size(), 3u);
}

}  // namespace
}  // namespace merlin::render
