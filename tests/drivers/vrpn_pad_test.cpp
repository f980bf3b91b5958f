// Buttons and analogs of a VRPN server: their messages, how they act as a ball, and the driver's
// dialogue with a server.
#include <limits>

#include <gtest/gtest.h>

#include "drivers/port/plausible.h"
#include "drivers/vrpn/numbers.h"
#include "drivers/vrpn/pad_device.h"
#include "tests/support/count_allocations.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/recording_sink.h"
#include "tests/support/vrpn_messages.h"

namespace merlin::vrpn {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr auto& message = test::vrpnMessage;

// Numbers of senders and message types that the server of these tests uses.
constexpr std::int32_t kOther = 4, kStick = 7, kChange = 11, kStates = 12, kChannels = 13,
                       kPong = 14;

std::string descriptions() {
  return test::vrpnSender(0, kVrpnControl) + test::vrpnSender(kOther, "Wand") +
         test::vrpnSender(kStick, "Joystick0") + test::vrpnType(kChange, kVrpnButtonType) +
         test::vrpnType(kStates, kVrpnButtonsType) + test::vrpnType(kChannels, kVrpnChannelsType) +
         test::vrpnType(kPong, kVrpnPong);
}
std::string button(std::int32_t number, bool down, std::int32_t sender = kStick) {
  return message(sender, kChange, vrpnButton(number, down));
}
std::string channels(const std::vector<double>& values, std::int32_t sender = kStick) {
  return message(sender, kChannels, vrpnChannels(values));
}

TEST(VrpnButtons, APayloadIsReadWholeOrNotAtAll) {
  const auto change = readVrpnButton(vrpnButton(255, true));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->button, 255u);
  EXPECT_TRUE(change->down);
  EXPECT_FALSE(readVrpnButton(vrpnButton(0, false))->down);
  EXPECT_FALSE(readVrpnButton(vrpnButton(256, true)));
  EXPECT_FALSE(readVrpnButton(vrpnButton(-1, true)));
  const auto states = readVrpnButtons(vrpnButtons(0b1010, 4));
  ASSERT_TRUE(states);
  EXPECT_EQ(states->count, 4u);
  EXPECT_EQ(states->down.to_ulong(), 0b1010u);
  EXPECT_EQ(readVrpnButtons(vrpnButtons(0, 0))->count, 0u);
  const auto analog = readVrpnChannels(vrpnChannels(std::vector<double>{0.5, -2}));
  ASSERT_TRUE(analog);
  EXPECT_EQ(analog->count, 2u);
  EXPECT_EQ(analog->value[1], -2);
  const std::string payloads[] = {vrpnButton(3, true), vrpnButtons(5, 3),
                                  vrpnChannels(std::vector<double>{1, 2, 3})};
  for (const std::string& payload : payloads) {
    for (std::size_t n = 0; n < payload.size(); ++n) {
      const std::string prefix = payload.substr(0, n);
      EXPECT_FALSE(n != 8 && readVrpnButton(prefix)) << n;
      EXPECT_FALSE(readVrpnButtons(prefix) || readVrpnChannels(prefix)) << n;
    }
    EXPECT_FALSE(readVrpnButton(payload + "x") || readVrpnButtons(payload + "x") ||
                 readVrpnChannels(payload + "x"));
  }
}

TEST(VrpnButtons, AStateIsDownIfItIsOnOrAToggleThatIsOn) {
  for (const std::int32_t state : {0, 1, 2, 10, 20, 21, -1}) {
    std::string payload = vrpnButton(0, false);
    payload[7] = static_cast<char>(state);
    if (state < 0) payload[4] = '\xFF';
    EXPECT_EQ(readVrpnButton(payload)->down, state == 1 || state == 21) << state;
  }
}

TEST(VrpnButtons, NoMoreThanVrpnHasAndNoNumberThatIsNone) {
  std::string buttons = vrpnButtons(0, 1).substr(0, 4);
  buttons[2] = 1;  // 257
  EXPECT_FALSE(readVrpnButtons(buttons + std::string(257 * 4, '\0')));
  buttons[3] = 0;
  EXPECT_TRUE(readVrpnButtons(buttons + std::string(256 * 4, '\0')));
  EXPECT_TRUE(readVrpnChannels(vrpnChannels(std::vector<double>(kVrpnChannels, 1))));
  EXPECT_FALSE(readVrpnChannels(vrpnChannels(std::vector<double>(kVrpnChannels + 1, 1))));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double none : {nan, std::numeric_limits<double>::infinity()})
    EXPECT_FALSE(readVrpnChannels(vrpnChannels(std::vector<double>{0, none})));
  const std::string two = vrpnChannels(std::vector<double>{1, 2});
  const std::string count_nan = vrpnChannels(std::vector<double>{nan}).substr(8);
  EXPECT_FALSE(readVrpnChannels(count_nan + two.substr(8)));
}

TEST(ChannelSources, AreNumbersReversedOnesPairsAndNone) {
  const auto parse = [](const char* text) { return parseAxisSource(text, channelNumber); };
  EXPECT_EQ(parse("5"), (AxisSource{5, -1, false}));
  EXPECT_EQ(parse("-0"), (AxisSource{0, -1, true}));
  EXPECT_EQ(parse("4-127"), (AxisSource{4, 127, false}));
  EXPECT_EQ(parse("none"), AxisSource{});
  for (const char* bad :
       {"", "-", "x", "128", "--1", "1-", "1-1", "-1-2", "1-2-3", "+1", " 1", "1.5", "99999999999"})
    EXPECT_FALSE(parse(bad)) << bad;
}

TEST(PadInput, ChannelsAreAxesAndButtonsAreButtonsUnlessTheConfigurationSaysOtherwise) {
  VrpnPadSettings settings;
  settings.dead_zone = 0;
  settings.curve = 1;
  PadInput plain(settings);
  VrpnChannels analog;
  analog.count = 3;
  analog.value = {0.25, -1, 7, 0.5};
  plain.take(analog);
  plain.take(VrpnButton{11, true});
  plain.take(VrpnButton{12, true});
  BallSample sample{};
  plain.fill(sample);
  EXPECT_FLOAT_EQ(sample.translation[0], 0.25F);
  EXPECT_FLOAT_EQ(sample.translation[1], -1);
  EXPECT_FLOAT_EQ(sample.translation[2], 1) << "a full push at most";
  EXPECT_FLOAT_EQ(sample.rotation[0], 0) << "a channel that was not sent";
  EXPECT_EQ(sample.raw[0], 250);
  EXPECT_EQ(sample.raw[2], -1000) << "a Spaceball's z points away";
  EXPECT_EQ(sample.buttons, 1U << 11);
  plain.rest();
  plain.fill(sample);
  EXPECT_EQ(sample.buttons, 0u);
  EXPECT_FLOAT_EQ(sample.translation[0], 0);

  settings.axes = {"-1", "none", "2-3", "0", "0", "0"};
  settings.buttons = {"200", "3"};
  settings.rest = 2.5;
  settings.full = 5;
  PadInput volts(settings);
  analog.count = 4;
  analog.value = {2.5, 5, 5, 3.75};
  volts.take(analog);
  volts.take(VrpnButton{3, true});
  volts.take(VrpnButton{0, true});
  volts.fill(sample);
  EXPECT_FLOAT_EQ(sample.translation[0], -1);
  EXPECT_FLOAT_EQ(sample.translation[1], 0);
  EXPECT_FLOAT_EQ(sample.translation[2], 0.5F);
  EXPECT_FLOAT_EQ(sample.rotation[2], 0);
  EXPECT_EQ(sample.buttons, 2u);
}

TEST(PadInput, SmallDeflectionsAreRestAndTheResponseIsCurved) {
  VrpnPadSettings settings;
  settings.dead_zone = 0.2;
  settings.curve = 2;
  PadInput input(settings);
  VrpnChannels analog;
  analog.count = 2;
  analog.value = {0.2, -0.6};
  input.take(analog);
  BallSample sample{};
  input.fill(sample);
  EXPECT_FLOAT_EQ(sample.translation[0], 0);
  EXPECT_FLOAT_EQ(sample.translation[1], -0.25F);
}

class VrpnPadTest : public testing::Test {
 protected:
  void connect(const VrpnPadSettings& settings = {}) {
    device_.emplace(settings, clock_, sink_);
    stream_.feed(vrpnCookie() + descriptions());
    const auto identity = device_->open(stream_);
    ASSERT_TRUE(identity) << identity.error().what;
    EXPECT_EQ(*identity, "VRPN buttons and analogs Joystick0 at server version 07.38");
  }
  // Returns the number of samples that the driver makes of these bytes.
  std::size_t samplesOf(const std::string& bytes) {
    const std::size_t before = sink_.ball.size();
    stream_.feed(bytes);
    const auto polled = device_->poll(stream_);
    EXPECT_TRUE(polled) << polled.error().what;
    return sink_.ball.size() - before;
  }

  test::FakeClock clock_;
  test::RecordingSink sink_;
  test::FakeStream stream_{clock_, nullptr};
  std::optional<VrpnPad> device_;
};

TEST_F(VrpnPadTest, PublishesAtEachMessageOfItsDevice) {
  connect();
  EXPECT_TRUE(sink_.ball.empty()) << "what rests is silent";
  clock_.advance(milliseconds(40));
  EXPECT_EQ(samplesOf(button(1, true)), 1u);
  EXPECT_EQ(sink_.ball.back().buttons, 2u);
  EXPECT_EQ(sink_.ball.back().counter, 1u);
  EXPECT_EQ(sink_.ball.back().received_ns, toNanoseconds(clock_.now()));
  EXPECT_EQ(samplesOf(message(kStick, kStates, vrpnButtons(0b100, 3))), 1u);
  EXPECT_EQ(sink_.ball.back().buttons, 4u);
  EXPECT_EQ(samplesOf(channels({0, 0, 0, 0, 1})), 1u);
  EXPECT_FLOAT_EQ(sink_.ball.back().rotation[1], 1);
  EXPECT_EQ(sink_.ball.back().buttons, 4u);
  EXPECT_EQ(samplesOf(button(5, true, kOther) + channels({1}, kOther) + button(5, true, 99) +
                      message(kStick, 99, vrpnButton(5, true))),
            0u)
      << "of other devices and types";
  EXPECT_EQ(device_->counters().samples, 3u);
  EXPECT_EQ(device_->counters().bad_packets, 0u);
}

TEST_F(VrpnPadTest, APushThatIsHeldIsPublishedAgainAndEndsWithTheConnection) {
  connect();
  EXPECT_EQ(samplesOf(channels({1}) + button(0, true)), 2u);
  const std::size_t before = sink_.ball.size();
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(device_->poll(stream_));
  EXPECT_EQ(sink_.ball.size(), before + 4) << "each 50 ms";
  EXPECT_FLOAT_EQ(sink_.ball.back().translation[0], 1);
  stream_.feed(vrpnCookie() + descriptions());
  ASSERT_TRUE(device_->open(stream_));
  EXPECT_EQ(sink_.ball.back().buttons, 0u) << "nobody saw the release";
  EXPECT_FLOAT_EQ(sink_.ball.back().translation[0], 0);
  EXPECT_EQ(sink_.ball.back().counter, before + 5) << "the counter goes on";
  EXPECT_EQ(samplesOf(button(0, true)), 1u);
  stream_.feed(vrpnCookie() + descriptions() + button(3, true));
  ASSERT_TRUE(device_->open(stream_));
  EXPECT_EQ(sink_.ball.back().buttons, 8u);
  EXPECT_EQ(sink_.ball.size(), before + 7) << "what is held now says that enough";
}

TEST_F(VrpnPadTest, AMessageThatNoDeviceSendsIsDroppedAndCounted) {
  connect();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(samplesOf(button(256, true) + button(-1, true) + channels({0, nan}) +
                      message(kStick, kChange, "") + message(kStick, kStates, "\xFF\xFF\xFF\xFF") +
                      message(kStick, kChannels, std::string(4000, 'x'))),
            0u);
  for (int i = 0; i < 5; ++i) (void)samplesOf("");
  EXPECT_EQ(device_->counters().bad_packets, 6u);
  EXPECT_EQ(samplesOf(channels(std::vector<double>(kVrpnChannels, 0.5))), 0u);
  EXPECT_EQ(samplesOf(""), 1u) << "the longest message, of which the first read has a part";
}

TEST_F(VrpnPadTest, RestIsNoFaultWhileTheServerAnswers) {
  connect();
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(samplesOf(message(kStick, kPong, "")), 0u);
    clock_.advance(seconds(1));
  }
  EXPECT_STREQ(device_->complaint(), "");
  Result<Ok> polled = Ok{};
  while (polled) polled = device_->poll(stream_);
  EXPECT_EQ(polled.error().what, "the server has sent nothing for 3.0 s");
}

TEST_F(VrpnPadTest, ADeviceOrAServerThatHasNoneIsSaid) {
  VrpnPadSettings settings;
  settings.device = "Stick";
  device_.emplace(settings, clock_, sink_);
  stream_.feed(vrpnCookie() + descriptions());
  const auto opened = device_->open(stream_);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().what, "the server has no \"Stick\"; it has \"Wand\", \"Joystick0\"");
  settings.device = "Tracker0";
  device_.emplace(settings, clock_, sink_);
  stream_.feed(vrpnCookie() + message(1, kVrpnDescribeSender, vrpnName("Tracker0")) +
               message(1, kVrpnDescribeType, vrpnName(kVrpnPoseType)));
  ASSERT_TRUE(device_->open(stream_));
  EXPECT_EQ(samplesOf(""), 0u);
  EXPECT_STREQ(device_->complaint(), "the server serves neither buttons nor analogs");
}

TEST_F(VrpnPadTest, ADeviceThatLeavesItsServerIsSaidAndLetsGo) {
  connect();
  EXPECT_EQ(samplesOf(button(1, true) + channels({1})), 2u);
  EXPECT_EQ(samplesOf(test::vrpnSender(kStick, "Wand")), 1u);
  EXPECT_STREQ(device_->complaint(), "the server no longer has the device");
  EXPECT_EQ(sink_.ball.back().buttons, 0u);
  EXPECT_FLOAT_EQ(sink_.ball.back().translation[0], 0);
  EXPECT_EQ(samplesOf(message(kOther, kPong, "")), 0u);
  EXPECT_EQ(samplesOf(test::vrpnSender(kStick, "Joystick0") + button(2, true)), 1u);
  EXPECT_STREQ(device_->complaint(), "");
  EXPECT_EQ(sink_.ball.back().buttons, 4u);
}

// Every byte of a stream is damaged in turn. No sample may be implausible, and the driver may end
// only by refusing the server.
TEST_F(VrpnPadTest, OneDamagedByteHarmsNothingElse) {
  const std::string good = descriptions() + button(2, true) +
                           message(kStick, kStates, vrpnButtons(7, 5)) + channels({0.5, -0.25}) +
                           button(2, false);
  for (std::size_t i = 0; i < good.size(); ++i) {
    connect();
    std::string bytes = good;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x80);
    stream_.feed(bytes + message(0, kVrpnDisconnect, ""));
    Result<Ok> polled = Ok{};
    while (polled && sink_.ball.size() < 200) polled = device_->poll(stream_);
    ASSERT_FALSE(polled) << i;
    for (const BallSample& s : sink_.ball) EXPECT_TRUE(plausible(s)) << i;
    sink_.ball.clear();
  }
}

TEST_F(VrpnPadTest, PollAllocatesNothing) {
  connect();
  sink_.ball.reserve(10'000);
  std::string all;
  for (int i = 0; i < 20; ++i)
    all += descriptions() + button(i, i % 2 == 0) + channels({0.1, 0.9}) + button(999, true);
  stream_.feed(all);
  const long before = test::allocations;
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(device_->poll(stream_));
  EXPECT_EQ(test::allocations, before);
  EXPECT_GE(sink_.ball.size(), 40u);
}

TEST(VrpnPadSettings, NamesAxesAndButtonsThatCannotBe) {
  const auto faults = [](const VrpnPadSettings& settings, const char* port = "") {
    std::string text;
    for (const SettingFault& f : validate(settings, {"vrpn_pad", port}))
      text += f.pointer + " " + f.what + "\n";
    return text;
  };
  VrpnPadSettings s;
  EXPECT_EQ(faults(s, "tcp://lab:3883") + faults(s, "pty:x"), "");
  EXPECT_EQ(faults(s, "udp:3883"),
            "/port is \"udp:3883\", at which no VRPN server can be; the driver \"vrpn_pad\" needs "
            "tcp://HOST:PORT, usually port 3883\n");
  s.device = "Joystick0@lab";
  s.buttons = {"3", "256", "x", "3"};
  s.axes = {"0", "1", "2", "3", "4", "128"};
  s.full = s.rest;
  EXPECT_EQ(
      faults(s),
      "/vrpn_pad/device is \"Joystick0@lab\"; needed is the name alone, \"Joystick0\": the host "
      "belongs in the port, tcp://HOST:3883\n"
      "/vrpn_pad/axes/5 is \"128\"; allowed are the server's number of a channel, 0 to 127, for "
      "example 3; such a number after a minus sign, if the channel is reversed: -3; two numbers "
      "joined by a minus sign, for a pair of triggers, the second of which acts in the opposite "
      "direction: 5-2; and the word none, for no channel\n"
      "/vrpn_pad/buttons/1 is \"256\"; allowed are the server's numbers of buttons, 0 to 255\n"
      "/vrpn_pad/buttons/2 is \"x\"; allowed are the server's numbers of buttons, 0 to 255\n"
      "/vrpn_pad/buttons/3 is \"3\", which is listed before; each button of the server can be only "
      "one button\n"
      "/vrpn_pad/full is 0, as \"rest\" is; needed is a channel's value at full deflection, which "
      "differs from that at rest\n");
  s = {};
  s.axes = {"0"};
  s.buttons = std::vector<std::string>(13, "0");
  EXPECT_NE(faults(s).find("/vrpn_pad/axes has 1 texts; it needs 6"), std::string::npos);
  EXPECT_NE(faults(s).find("/vrpn_pad/buttons has 13 numbers; a ball has at most 12 buttons"),
            std::string::npos);
}

}  // namespace
}  // namespace merlin::vrpn
