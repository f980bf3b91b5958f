// Readers find the devices' slots by name. Slots that another release or a hostile writer has moved
// are either found, or refused with one error.
#include "daemon/shm/slot_table.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "daemon/shm/segment.h"
#include "tests/support/local_devices.h"
#include "tests/support/temp_dir.h"

namespace merlin::shm {
namespace {

// The devices' segment of a later release: it begins like that of this release, then has another
// header, and a device of an unknown kind before this release's slots; its table is last.
struct LaterSegment {
  Header header;
  alignas(64) SeqSlot<DeviceHealth> touch_health;
  alignas(64) DevicesSegment ours;  // the header and table of this part are not used
  alignas(64) Field fields[kMostDevicesFields];
};

// Returns the table of LaterSegment: this release's fields at their new offsets, and those of the
// new device.
std::vector<Field> laterFields() {
  std::vector<Field> fields;
  constexpr auto kMoved = static_cast<std::uint32_t>(offsetof(LaterSegment, ours));
  for (Field f : devicesFields(test::defaultSlotNames())) {
    if (std::string_view(f.name).starts_with("segment.")) {
      fields.push_back(f);
      continue;
    }
    f.offset += kMoved;
    if (f.slot != 0) f.slot += kMoved;
    if (f.ring != 0) f.ring += kMoved;
    fields.push_back(f);
  }
  for (const Field& f :
       slotFields<DeviceHealth>("touch.health", offsetof(LaterSegment, touch_health)))
    fields.push_back(f);
  return fields;
}

std::unique_ptr<LaterSegment> later() {
  auto segment = std::make_unique<LaterSegment>();
  setFields(segment->header, segment->fields, laterFields());
  return segment;
}

template <typename Segment>
Result<SlotTable> tableOf(const Segment& segment) {
  return SlotTable::read(std::as_bytes(std::span(&segment, 1)), "/it-devices");
}

TEST(DeviceSlots, AreFoundWhereALaterReleaseHasThem) {
  const auto segment = later();
  const auto table = tableOf(*segment);
  ASSERT_TRUE(table) << table.error().what;
  const auto slots = DeviceSlots::find(*table, segment->header);
  ASSERT_TRUE(slots) << slots.error().what;
  EXPECT_EQ(slots->glove()->samples, &segment->ours.glove[0].samples);
  EXPECT_EQ(slots->tracker()->stations[3], &segment->ours.tracker[0].stations[3]);
  EXPECT_EQ(slots->ball()->health, &segment->ours.health[test::kBall]);
  ASSERT_EQ(slots->actions.size(), 5U);
  EXPECT_EQ(slots->actions[3].source, "hand");
  EXPECT_EQ(slots->actions[3].slot, &segment->ours.actions[kFirstHandSource]);
  EXPECT_EQ(slots->actions[4].source, "panel") << "the last one";
  EXPECT_EQ(slots->actions[4].slot, &segment->ours.actions[kPanelSource]);
  EXPECT_EQ(slots->hand()->gesture, &segment->ours.gesture[0]);
  EXPECT_EQ(slots->glove()->posture_state, &segment->ours.glove[0].posture_state);
}

TEST(DeviceSlots, ADeviceOfANewKindIsOneMoreWithoutANewReader) {
  const auto segment = later();
  const auto slots = DeviceSlots::find(*tableOf(*segment), segment->header);
  ASSERT_TRUE(slots) << slots.error().what;
  std::vector<std::string> devices;
  for (const auto& [device, slot] : slots->health) devices.push_back(device);
  EXPECT_EQ(devices, (std::vector<std::string>{"glove", "tracker", "ball", "touch"}));
  EXPECT_EQ(slots->health[3].slot, &segment->touch_health);
}

TEST(DeviceSlots, OfThisReleaseAreTheMembersOfItsSegment) {
  const test::LocalDevices devices;
  EXPECT_EQ(devices.slots().glove()->samples, &devices->glove[0].samples);
  EXPECT_EQ(devices.slots().hand()->samples, &devices->hand[0]);
  EXPECT_EQ(devices.slots().tracker()->frames, &devices->tracker[0].frames);
  ASSERT_EQ(devices.slots().health.size(), 3U) << "without the panel";
}

TEST(DeviceSlots, SeveralOfAKindAreFoundByTheirNamesInTheOrderOfTheConfiguration) {
  const test::LocalDevices devices({{{"right", SampleKind::kGlove},
                                     {"desk", SampleKind::kBall},
                                     {"left", SampleKind::kGlove},
                                     {"room", SampleKind::kTracker},
                                     {"door", SampleKind::kBall}},
                                    {"right_hand", "left_hand"}});
  const DeviceSlots& slots = devices.slots();
  EXPECT_EQ(slots.glove(), slots.glove("right")) << "the first one";
  EXPECT_EQ(slots.glove("left")->samples, &devices->glove[1].samples);
  EXPECT_EQ(slots.glove("left")->posture, &devices->glove[1].posture);
  EXPECT_EQ(slots.glove("left")->health, &devices->health[2]);
  EXPECT_EQ(slots.ball("door")->samples, &devices->ball[1]);
  EXPECT_EQ(slots.ball("door")->health, &devices->health[4]);
  EXPECT_EQ(slots.tracker("room")->stations[1], &devices->tracker[0].stations[1]);
  EXPECT_EQ(slots.hand("left_hand")->samples, &devices->hand[1]);
  EXPECT_EQ(slots.actions[4].source, "door");
  EXPECT_EQ(slots.actions[4].slot, &devices->actions[4]);
  EXPECT_EQ(slots.ball("left"), nullptr) << "a glove";
  const auto table = tableOf(*devices);
  EXPECT_EQ(*table->channel<PostureSample>("posture"), &devices->glove[0].posture)
      << "the first glove's, without its name";
}

TEST(DeviceSlots, TheMostDevicesFitIntoTheTable) {
  SlotNames most;
  for (const auto& [kind, count] : {std::pair{SampleKind::kGlove, kMostGloves},
                                    {SampleKind::kTracker, kMostTrackers},
                                    {SampleKind::kBall, kMostBalls},
                                    {SampleKind::kTouch, kMostTouches}}) {
    for (std::size_t i = 0; i < count; ++i)
      most.devices.push_back({"sixteen_letters_"[0] + std::to_string(most.devices.size()), kind});
  }
  for (std::size_t i = 0; i < kMostHands; ++i) most.hands.push_back("hand" + std::to_string(i));
  ASSERT_EQ(most.devices.size(), kMostDevices);
  EXPECT_LE(devicesFields(most).size(), kMostDevicesFields * 9 / 10);
  const test::LocalDevices devices(most);
  EXPECT_EQ(devices.slots().health.size(), kMostDevices);
  EXPECT_EQ(devices.slots().hands.size(), kMostHands);
}

// A segment of this release; the tests damage its table.
class SlotTableTest : public testing::Test {
 protected:
  SlotTableTest() {
    setFields(segment_->header, segment_->fields, devicesFields(test::defaultSlotNames()));
  }

  Field& field(std::string_view name) {
    Field* found = std::find_if(std::begin(segment_->fields), std::end(segment_->fields),
                                [&](const Field& f) { return name == f.name; });
    EXPECT_NE(found, std::end(segment_->fields)) << name;
    return *found;
  }
  // Returns the error when all slots are looked up; empty if there is none.
  std::string fault() const {
    const auto slots = DeviceSlots::find(*segment_);
    if (slots) return "";
    EXPECT_TRUE(slots.error().code == Errc::kMalformed || slots.error().code == Errc::kUnsupported);
    return slots.error().what;
  }

  std::unique_ptr<DevicesSegment> segment_ = std::make_unique<DevicesSegment>();
};

TEST_F(SlotTableTest, ASlotThatIsMissingIsNamed) {
  std::strcpy(field("ball.count").name, "bell.count");
  EXPECT_EQ(fault(),
            "shared memory of the devices: has no slot ball (no field ball.count); use this "
            "program and merlind from the same release");
}

TEST_F(SlotTableTest, AFieldThatIsMissingIsNamed) {
  std::strcpy(field("hand.delay_s").name, "hand.lag_s");
  EXPECT_NE(fault().find("its slot hand lacks the field hand.delay_s"), std::string::npos)
      << fault();
}

TEST_F(SlotTableTest, ASampleOfAnotherSizeIsRefused) {
  for (Field& f : segment_->fields) {
    if (std::string_view(f.name).starts_with("glove.") && f.ring != 0) f.ring_stride += 8;
  }
  EXPECT_NE(fault().find("its slot glove has the field glove.received_ns as"), std::string::npos)
      << fault();
  EXPECT_NE(fault().find("256 x 152; this program expects"), std::string::npos) << fault();
}

TEST_F(SlotTableTest, AFieldOfAnotherTypeCountOrPlaceIsRefused) {
  const auto damaged = [&](auto damage) {
    const Field before = field("tracker2.position_m");
    damage(field("tracker2.position_m"));
    const std::string what = fault();
    field("tracker2.position_m") = before;
    return what.find("slot tracker2 has the field tracker2.position_m") != std::string::npos;
  };
  EXPECT_TRUE(damaged([](Field& f) { f.type[0] = 'd'; }));
  EXPECT_TRUE(damaged([](Field& f) { f.count = 4; }));
  EXPECT_TRUE(damaged([](Field& f) { f.step = 8; }));
  EXPECT_TRUE(damaged([](Field& f) { f.offset += 4; }));
  EXPECT_TRUE(damaged([](Field& f) { f.slot += 8; }));
  EXPECT_TRUE(damaged([](Field& f) { f.ring += 8; }));
  EXPECT_TRUE(damaged([](Field& f) { f.ring_slots = 1 << 20; }));
  EXPECT_EQ(fault(), "");
}

// Moves all fields of a slot by the same offset, as a hostile writer may, so that they agree with
// each other.
void move(DevicesSegment& segment, const std::string& slot, std::uint32_t by) {
  for (Field& f : segment.fields) {
    if (!std::string_view(f.name).starts_with(slot + ".")) continue;
    f.offset += by;
    if (f.slot != 0) f.slot += by;
    if (f.ring != 0) f.ring += by;
  }
}

TEST_F(SlotTableTest, ASlotOutsideTheSegmentIsRefused) {
  const auto refused = [&](std::uint32_t by) {
    move(*segment_, "ball", by);
    const std::string what = fault();
    move(*segment_, "ball", 0U - by);
    return what.find("would be the bytes") != std::string::npos;
  };
  const auto last = static_cast<std::uint32_t>(
      sizeof(DevicesSegment) - sizeof(Channel<BallSample>) - offsetof(DevicesSegment, ball));
  EXPECT_FALSE(refused(last)) << "its last byte is the segment's";
  EXPECT_TRUE(refused(last + 64));
  EXPECT_TRUE(refused(1U << 31));
  constexpr auto kBack = static_cast<std::uint32_t>(offsetof(DevicesSegment, ball) - 64);
  EXPECT_TRUE(refused(0U - kBack)) << "in the header";
  EXPECT_TRUE(refused(8)) << "not aligned";
  EXPECT_EQ(fault(), "");
}

TEST_F(SlotTableTest, ATableOutsideTheSegmentIsRefused) {
  segment_->header.field_count = 1U << 31;
  EXPECT_NE(fault().find("its table of fields is not inside it"), std::string::npos) << fault();
  segment_->header.field_count = 10;
  segment_->header.field_offset = 0xFFFFFFF0;
  EXPECT_NE(fault().find("its table of fields is not inside it"), std::string::npos) << fault();
  segment_->header.field_offset = offsetof(DevicesSegment, fields);
  segment_->header.field_size = 8;
  EXPECT_NE(fault().find("its table of fields is not inside it"), std::string::npos) << fault();
  segment_->header.field_count = 0;
  EXPECT_NE(fault().find("has no slot actions.panel"), std::string::npos) << fault();
}

TEST_F(SlotTableTest, NamesWithoutAnEndAndNamesTwiceAreSurvived) {
  std::memset(field("gpio.health.state").name, 'x', sizeof(Field::name));
  EXPECT_EQ(fault(), "") << "nobody asks for the panel";
  const Field ball = field("ball.count");
  field("gpio.count") = ball;  // the first of two fields with the same name counts
  EXPECT_EQ(fault(), "");
}

TEST(DevicesReader, RefusesADamagedSegmentWithOneError) {
  const std::string name = segmentName(test::privateName("slots"), "devices");
  const auto writer = SegmentWriter<DevicesSegment>::make(
      name, devicesFields(test::defaultSlotNames()), 1, SystemClock().now(), {});
  ASSERT_TRUE(writer);
  ASSERT_TRUE(DevicesReader::open(name));
  EXPECT_TRUE(DevicesReader::open(name)->alive(SystemClock().now()));
  for (Field& f : (*writer)->fields) f.offset += 4;
  const auto refused = DevicesReader::open(name);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kMalformed);
  EXPECT_EQ(refused.error().what.find(name), std::string("shared memory ").size());
}

}  // namespace
}  // namespace merlin::shm
