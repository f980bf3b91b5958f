// What an output of kind kms decides without a card: the faults of its settings, the choice of
// mode, connector and CRTC, the pixels of a buffer, and which buffer is used next.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "render/out/kms/buffer_turns.h"
#include "render/out/kms/choice.h"
#include "render/out/kms/settings.h"
#include "render/out/settings.h"
#include "tests/support/fake_card.h"

namespace merlin::render::out::kms {
namespace {

using test::mode;
using test::projector;

TEST(ModeNameTest, IsReadWithAndWithoutARate) {
  EXPECT_EQ(parseMode("1920x1080")->height, 1080);
  EXPECT_EQ(parseMode("1920x1080")->refresh_hz, 0);
  EXPECT_EQ(parseMode("640x480@59.94")->refresh_hz, 59.94);
  for (const char* bad :
       {"", "1920", "1920x", "x1080", "1920x1080@", "1920x1080@60Hz", "0x5", "-1x5", "1920 x 1080",
        "99999x5", "640x480@0", "640x480@1e9", "640x480@nan", "9999999999999x5"})
    EXPECT_FALSE(parseMode(bad)) << bad;
}

TEST(KmsSettingsTest, FaultsNameTheSettingAndTheWayOut) {
  const SettingFaults faults = validate(KmsSettings{"card0", "HDMI 1/../x", "big"});
  ASSERT_EQ(faults.size(), 3U);
  EXPECT_EQ(faults[0].pointer, "/card");
  EXPECT_NE(faults[0].what.find("/dev/dri/card0"), std::string::npos);
  EXPECT_EQ(faults[1].pointer, "/connector");
  EXPECT_EQ(faults[2].pointer, "/mode");
  EXPECT_TRUE(validate(KmsSettings{"/dev/dri/card1", "HDMI-A-1", "1920x1080@60"}).empty());
  EXPECT_TRUE(validate(KmsSettings{}).empty());
  EXPECT_TRUE(validate(KmsSettings{"", "*", ""}).empty());
  EXPECT_EQ(validate(KmsSettings{"", "HDMI-*", ""}).size(), 1U);
}

SettingFaults faultsOf(const std::vector<KmsSettings>& displays) {
  std::vector<OutputSettings> outputs;
  for (const KmsSettings& display : displays) {
    outputs.push_back(
        {.kind = OutputKind::kKms, .name = std::to_string(outputs.size()), .kms = display});
  }
  return out::validate(outputs, tiles::TilesSettings{});
}

TEST(KmsSettingsTest, ADisplayIsOneOutputs) {
  EXPECT_TRUE(faultsOf({{"", "A-1", ""}, {"", "A-2", ""}}).empty());
  EXPECT_TRUE(faultsOf({{"/dev/a", "A-1", ""}, {"/dev/b", "A-1", ""}}).empty());
  const SettingFaults twice = faultsOf({{"", "A-1", ""}, {"", "A-1", ""}});
  ASSERT_EQ(twice.size(), 1U);
  EXPECT_EQ(twice[0].pointer, "/1/kms/connector");
  EXPECT_EQ(faultsOf({{"", "A-1", ""}, {"", "", ""}}).size(), 1U) << "which connector is open";
  EXPECT_TRUE(faultsOf({{"", "A-1", ""}, {"", "*", ""}}).empty());
  EXPECT_EQ(faultsOf({{"", "*", ""}, {"", "*", ""}}).size(), 1U);
  EXPECT_EQ(faultsOf({{"", "A-1", ""}, {"/dev/a", "A-2", ""}}).size(), 1U)
      << "the unnamed card may be the named one";
}

TEST(ChooseModeTest, NamedModesAreTakenByTheirRate) {
  const Connector c = projector(1, "A-1");
  EXPECT_EQ(*chooseMode(c, "640x480@75", 640, 480), 3U);
  EXPECT_EQ(*chooseMode(c, "640x480@60", 640, 480), 1U);
  EXPECT_EQ(*chooseMode(c, "640x480@59.94", 640, 480), 2U);
  EXPECT_EQ(*chooseMode(c, "640x480", 640, 480), 3U) << "the fastest";
  EXPECT_EQ(*chooseMode(c, "1024x768", 640, 480), 0U) << "a smaller picture is shown in it";
}

TEST(ChooseModeTest, WithoutANameThePicturesSizeDecidesThenTheDisplay) {
  const Connector c = projector(1, "A-1");
  EXPECT_EQ(*chooseMode(c, "", 640, 480), 3U);
  EXPECT_EQ(*chooseMode(c, "", 1024, 768), 0U);
  EXPECT_EQ(*chooseMode(c, "", 800, 600), 0U) << "the preferred one";
}

TEST(ChooseModeTest, WhatIsNotThereIsSaidWithWhatIs) {
  const Connector c = projector(1, "A-1");
  const auto missing = chooseMode(c, "1920x1080", 640, 480);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().what,
            "A-1 has no mode 1920x1080; it has 1024x768@60, 640x480@60, 640x480@75");
  EXPECT_FALSE(chooseMode(c, "640x480@90", 640, 480));
  const auto large = chooseMode(c, "640x480", 800, 480);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, Errc::kInvalidArgument);
  EXPECT_FALSE(chooseMode(Connector{.name = "A-2"}, "", 640, 480));
}

TEST(ChooseModeTest, InterlacedOnesAreTheLastChoice) {
  Connector c{.name = "A-1", .modes = {mode(1920, 1080, 60), mode(1920, 1080, 50)}};
  c.modes[0].interlaced = true;
  EXPECT_EQ(*chooseMode(c, "1920x1080", 1920, 1080), 1U);
  EXPECT_EQ(*chooseMode(c, "", 1920, 1080), 1U);
}

TEST(ChooseConnectorTest, ByNameOrTheFirstWithADisplay) {
  std::vector<Connector> all = {projector(1, "A-1"), projector(2, "A-2")};
  all[0].connected = false;
  EXPECT_EQ(*chooseConnector(all, "A-1", "card"), 0U);
  EXPECT_EQ(*chooseConnector(all, "", "card"), 1U);
  all[1].connected = false;
  EXPECT_EQ(*chooseConnector(all, "", "card"), 0U);
  EXPECT_EQ(chooseConnector(all, "B-1", "/dev/c").error().what,
            "/dev/c has no connector B-1; it has A-1, A-2");
  EXPECT_FALSE(chooseConnector({}, "", "card"));
}

TEST(AssignCrtcsTest, NobodyGoesWithoutIfThereIsAWay) {
  const std::uint32_t any[] = {0b11, 0b01};
  EXPECT_EQ(assignCrtcs(any, 0b11)[0], 1U) << "the second one can have the first CRTC alone";
  EXPECT_EQ(assignCrtcs(any, 0b11)[1], 0U);
  const std::uint32_t chain[] = {0b0011, 0b0110, 0b0001};
  const auto assigned = assignCrtcs(chain, ~0U);
  EXPECT_EQ(assigned[0], 1U);
  EXPECT_EQ(assigned[1], 2U);
  EXPECT_EQ(assigned[2], 0U);
  const std::uint32_t many[] = {0b11, 0b11, 0b11};
  const auto first_come = assignCrtcs(many, 0b11);
  EXPECT_TRUE(first_come[0] && first_come[1]);
  EXPECT_FALSE(first_come[2]);
  EXPECT_FALSE(assignCrtcs(any, 0b10)[1]) << "a CRTC without a plane is no use";
}

TEST(WritePictureTest, SwapsRedAndBlueInTheMiddle) {
  const std::uint8_t rgba[] = {1, 2, 3, 255, 4, 5, 6, 255};  // 2 x 1
  std::vector<std::uint8_t> buffer(3 * 20);                  // 4 x 3, a pitch of 5 pixels
  writePicture(rgba, 2, 1, buffer, 20, 4, 3);
  std::vector<std::uint8_t> expected(3 * 20);
  const std::uint8_t middle[] = {3, 2, 1, 255, 6, 5, 4, 255};
  std::copy(std::begin(middle), std::end(middle), expected.begin() + 24);
  EXPECT_EQ(buffer, expected);
}

TEST(WritePictureTest, RowsOfAnyLength) {
  const int width = 37;
  std::vector<std::uint8_t> rgba(width * 4 * 2), buffer(rgba.size());
  for (std::size_t i = 0; i < rgba.size(); ++i) rgba[i] = static_cast<std::uint8_t>(i);
  writePicture(rgba, width, 2, buffer, width * 4, width, 2);
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    EXPECT_EQ(buffer[i], rgba[i + 2]) << i;
    EXPECT_EQ(buffer[i + 1], rgba[i + 1]) << i;
    EXPECT_EQ(buffer[i + 2], rgba[i]) << i;
  }
}

TEST(BufferTurnsTest, WhatIsShownOrOnItsWayIsNeverWritten) {
  BufferTurns turns;
  std::set<std::size_t> used;
  const auto first = turns.beginWrite();
  EXPECT_FALSE(first.replaces);
  EXPECT_FALSE(turns.ready());
  turns.endWrite(first.buffer);
  turns.commit();
  EXPECT_TRUE(turns.isPending());
  turns.flipped();
  const auto second = turns.beginWrite();
  turns.endWrite(second.buffer);
  turns.commit();
  const auto third = turns.beginWrite();
  turns.endWrite(third.buffer);
  EXPECT_EQ((std::set{first.buffer, second.buffer, third.buffer}).size(), 3U);
  const auto newer = turns.beginWrite();
  EXPECT_TRUE(newer.replaces);
  EXPECT_EQ(newer.buffer, third.buffer);
  turns.endWrite(newer.buffer);
  turns.flipped();
  EXPECT_EQ(turns.ready(), newer.buffer);
  EXPECT_EQ(turns.beginWrite().buffer, newer.buffer);
}

TEST(BufferTurnsTest, ARefusedCommitWaitsAgainUnlessANewerOneDoes) {
  BufferTurns turns;
  turns.endWrite(turns.beginWrite().buffer);
  turns.commit();
  turns.uncommit();
  ASSERT_TRUE(turns.ready());
  turns.commit();
  turns.endWrite(turns.beginWrite().buffer);
  const auto newer = turns.ready();
  turns.uncommit();
  EXPECT_EQ(turns.ready(), newer);
  turns.commit();
  EXPECT_FALSE(turns.ready());
}

}  // namespace
}  // namespace merlin::render::out::kms
