// How `merlin devices` presents the answers of VRPN servers, and how it asks several servers, of
// which one lies and one never answers.
#include "daemon/cli/devices/vrpn_offers.h"

#include <chrono>
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "config/loader.h"
#include "daemon/net/connection_server.h"
#include "drivers/vrpn/identity.h"
#include "tests/support/eventually.h"
#include "tests/support/vrpn_messages.h"
#include "tests/support/vrpn_speaker.h"

namespace merlin::cli {
namespace {

using test::vrpnMessage;
using test::vrpnSender;
using test::vrpnType;

constexpr const char* kLab = "tcp://lab:3883";

// The numbers that these servers give to message types.
constexpr std::int32_t kPose = 4, kButton = 5, kChannels = 6;

std::string allTypes() {
  return vrpnType(kPose, kVrpnPoseType) + vrpnType(kButton, kVrpnButtonType) +
         vrpnType(kChannels, kVrpnChannelsType);
}

VrpnAnswer answerOf(const std::string& bytes, const std::string& port = kLab) {
  VrpnAnswer answer{port, {}, {}};
  if (const auto taken = answer.catalog.take(vrpnCookie() + bytes); !taken)
    answer.fault = taken.error().what;
  return answer;
}

Settings settingsOf(const std::string& json) {
  const LoadedSettings loaded = loadSettings(json, "");
  EXPECT_EQ(loaded.verdict(), LoadedSettings::Verdict::kValid);
  return loaded.settings;
}

VrpnListing listingOf(const VrpnAnswer& answer, const Settings& settings = {},
                      const std::vector<std::string>& taken = {}) {
  return listOffers({answer}, settings, "merlin", taken).at(0);
}

const std::string kWand = vrpnSender(0, kVrpnControl) + vrpnSender(1, "Wand0") + allTypes() +
                          vrpnMessage(1, kPose, "x") + vrpnMessage(1, kButton, "x");

TEST(VrpnOffers, AWandHasAnEntryForItsPosesAndOneForItsButtons) {
  EXPECT_EQ(toText(listingOf(answerOf(kWand))),
            "  tcp://lab:3883, VRPN 07.38\n"
            "    Wand0: tracker, buttons\n"
            "      {\"name\": \"tracker\", \"driver\": \"vrpn\", \"port\": \"tcp://lab:3883\", "
            "\"vrpn\": {\"device\": \"Wand0\"}}\n"
            "      {\"name\": \"pad\", \"driver\": \"vrpn_pad\", \"port\": \"tcp://lab:3883\", "
            "\"vrpn_pad\": {\"device\": \"Wand0\"}}\n");
  const auto json = toJson(listingOf(answerOf(kWand)));
  EXPECT_EQ(json["devices"][0]["as"][1]["vrpn_pad"]["device"], "Wand0");
  EXPECT_EQ(json["devices"][0]["tracker"], true);
  EXPECT_EQ(json["devices"][0]["analog"], false);
}

TEST(VrpnOffers, WhatTheConfigurationReadsIsNotOfferedAgain) {
  const Settings settings = settingsOf(
      R"({"devices": [{"name": "eyes", "driver": "vrpn", "port": "tcp://lab:3883",
                       "vrpn": {"device": "Wand0"}}]})");
  const VrpnListing listing = listingOf(answerOf(kWand), settings);
  ASSERT_EQ(listing.devices.size(), 1u);
  ASSERT_EQ(listing.devices[0].uses.size(), 2u);
  EXPECT_EQ(listing.devices[0].uses[0].read_by, "eyes");
  EXPECT_EQ(listing.devices[0].uses[1].read_by, "") << "its buttons are not read yet";
  const auto json = toJson(listing);
  EXPECT_EQ(json["devices"][0]["read_by"][0], "eyes");
  ASSERT_EQ(json["devices"][0]["as"].size(), 1u);
  EXPECT_EQ(json["devices"][0]["as"][0]["driver"], "vrpn_pad");
  EXPECT_EQ(listingOf(answerOf(kWand, "tcp://lab2:3883"), settings).devices[0].uses[0].read_by, "")
      << "another server's device of this name";
}

TEST(VrpnOffers, NamesOfEntriesAreFreeAndDiffer) {
  const std::string two = kWand + vrpnSender(2, "Head") + vrpnMessage(2, kPose, "x");
  const auto all = listOffers({answerOf(two), answerOf(kWand, "tcp://lab2:3883")}, {}, "merlin",
                              {"tracker", "pad_2"});
  EXPECT_EQ(all[0].devices[0].uses[0].name, "tracker_2");
  EXPECT_EQ(all[0].devices[0].uses[1].name, "pad");
  EXPECT_EQ(all[0].devices[1].uses[0].name, "tracker_3");
  EXPECT_EQ(all[1].devices[0].uses[0].name, "tracker_4");
  EXPECT_EQ(all[1].devices[0].uses[1].name, "pad_3");
}

TEST(VrpnOffers, OfADeviceThatHasSentNothingTheKindIsNotKnown) {
  const VrpnListing any = listingOf(answerOf(vrpnSender(1, "Quiet") + allTypes()));
  EXPECT_NE(
      toText(any).find("Quiet: its kind is not known: it has sent nothing that MERLIN reads\n"),
      std::string::npos);
  EXPECT_EQ(any.devices[0].uses.size(), 2u) << "it may be either";
  const VrpnListing trackers =
      listingOf(answerOf(vrpnSender(1, "Quiet") + vrpnType(kPose, kVrpnPoseType)));
  ASSERT_EQ(trackers.devices[0].uses.size(), 1u) << "its server serves nothing else";
  EXPECT_EQ(trackers.devices[0].uses[0].driver, "vrpn");
  const VrpnListing none = listingOf(answerOf(vrpnSender(1, "Dial") + vrpnType(1, "vrpn_Dial")));
  EXPECT_TRUE(none.devices[0].uses.empty());
  EXPECT_NE(toText(none).find("describes nothing that MERLIN reads"), std::string::npos);
}

TEST(VrpnOffers, MerlindIsNotOfferedItsOwnServer) {
  const std::string own = kWand + vrpnType(9, std::string(kVrpnInstance) + "merlin");
  const std::string other = kWand + vrpnType(9, std::string(kVrpnInstance) + "other");
  EXPECT_TRUE(listingOf(answerOf(own)).own);
  EXPECT_TRUE(listingOf(answerOf(own)).devices.empty());
  EXPECT_EQ(
      toText(listingOf(answerOf(own))),
      "  tcp://lab:3883: merlind's own server (/serve/vrpn_port), which merlind does not read\n");
  EXPECT_EQ(listingOf(answerOf(other)).devices.size(), 1u) << "another daemon's is a server";
  EXPECT_TRUE(listingOf(answerOf(other), settingsOf(R"({"instance": "other"})")).own);
  const Settings serves = settingsOf(R"({"serve": {"vrpn_port": 4000}})");
  EXPECT_TRUE(listingOf(answerOf(kWand, "tcp://localhost:4000"), serves).own)
      << "one that does not say whose it is";
  EXPECT_FALSE(listingOf(answerOf(kWand, "tcp://localhost:3883"), serves).own);
  EXPECT_FALSE(listingOf(answerOf(kWand, "tcp://lab:4000"), serves).own);
}

// The entry has to be valid JSON for a configuration, whatever the device's name is.
TEST(VrpnOffers, AnEntryIsJsonWhateverTheName) {
  const std::string name = R"(a "b"}, {"name": "evil" \)";
  const VrpnListing listing =
      listingOf(answerOf(vrpnSender(1, name) + vrpnSender(2, "\x1B]0;x\x07") +
                         vrpnSender(3, "a\nb") + allTypes() + vrpnMessage(1, kPose, "x")));
  ASSERT_EQ(listing.devices.size(), 1u);
  EXPECT_EQ(listing.left_out, 2u);
  const std::string entry = entryText(listing.port, listing.devices[0], listing.devices[0].uses[0]);
  const Settings settings = settingsOf("{\"devices\": [" + entry + "]}");
  ASSERT_EQ(settings.devices.list.size(), 1u);
  EXPECT_EQ(settings.devices.list[0].own.vrpn.device, name);
  EXPECT_EQ(nlohmann::json::parse(entry),
            nlohmann::json::parse(toJson(listing)["devices"][0]["as"][0].dump()));
  const std::string text = toText(listing);
  EXPECT_EQ(text.find('\x1B'), std::string::npos);
  EXPECT_NE(
      text.find("    2 more devices are not listed: their names cannot be used in a configuration"),
      std::string::npos);
}

TEST(VrpnOffers, AServerThatBreaksOffIsListedWithItsFault) {
  const VrpnListing listing = listingOf(answerOf(kWand + std::string(24, '\xFF')));
  EXPECT_TRUE(listing.answers);
  EXPECT_EQ(listing.devices.size(), 1u);
  EXPECT_NE(toText(listing).find("\n    the server sent a message with an invalid length\n"),
            std::string::npos);
  VrpnAnswer foreign{kLab, {}, {}};
  foreign.fault = foreign.catalog.take("SSH-2.0-OpenSSH_9.2p1 Debian").error().what;
  EXPECT_EQ(toText(listingOf(foreign)),
            "  tcp://lab:3883: the greeting \"SSH-2.0-OpenSSH_9.2p1 De\" "
            "is not that of a server of VRPN 7\n");
}

TEST(VrpnServers, HostsAreNamedWithAndWithoutAPort) {
  EXPECT_EQ(vrpnPort("lab"), kLab);
  EXPECT_EQ(vrpnPort("lab:4000"), "tcp://lab:4000");
  EXPECT_EQ(vrpnPort("tcp://lab:4000"), "tcp://lab:4000");
  EXPECT_EQ(vrpnPort("[::1]"), "tcp://[::1]:3883");
  for (const char* bad : {"", "*", "a b", "lab:port", "lab:0", "300.1.1.1", "tcp://", "a:b:1x"})
    EXPECT_FALSE(vrpnPort(bad)) << bad;
}

// A server's device is matched by the identity that the running driver has reported.
TEST(VrpnServers, WhatARunningMerlindReadsIsKnown) {
  const auto tracker = vrpnDeviceOf("eyes", kLab, vrpn::trackerIdentity("Wand0", "07.38"));
  ASSERT_TRUE(tracker);
  EXPECT_EQ(tracker->name + " " + tracker->line.driver + " " + tracker->line.port,
            "eyes vrpn " + std::string(kLab));
  EXPECT_EQ(tracker->own.vrpn.device, "Wand0");
  const auto pad = vrpnDeviceOf("pad", kLab, vrpn::padIdentity("a at server version b", "07.38"));
  ASSERT_TRUE(pad);
  EXPECT_EQ(pad->line.driver, "vrpn_pad");
  EXPECT_EQ(pad->own.vrpn_pad.device, "a at server version b");
  EXPECT_FALSE(vrpnDeviceOf("glove", kLab, "CyberGlove, 22 sensors"))
      << "a terminal server gets no word of VRPN";
  EXPECT_FALSE(vrpnDeviceOf("eyes", kLab, "")) << "not opened yet";
}

TEST(VrpnServers, EachServerIsAskedOnce) {
  const Settings settings = settingsOf(
      R"({"devices": [{"name": "a", "driver": "vrpn", "port": "tcp://lab:3883"},
                      {"name": "b", "driver": "vrpn_pad", "port": "tcp://lab:3883"},
                      {"name": "c", "driver": "vrpn_pad", "port": "tcp://localhost:3883"},
                      {"name": "ball", "driver": "spaceball", "port": "tcp://ser2net:3001"}]})");
  EXPECT_EQ(serversToAsk(settings.devices, {"tcp://other:4000", kLab}),
            (std::vector<std::string>{"tcp://127.0.0.1:3883", kLab, "tcp://other:4000"}))
      << "and the terminal server with the ball's line is left alone";
}

TEST(VrpnServers, OneThatNeverAnswersOrIsNotThereKeepsNoOtherWaiting) {
  const auto silent = net::listenTcp("127.0.0.1", 0);
  ASSERT_TRUE(silent);
  const int none = [] { return net::portOf(net::listenTcp("127.0.0.1", 0)->get()); }();
  const test::VrpnSpeaker wand(vrpnCookie() + kWand);
  const auto at = [](int port) { return fmt::format("tcp://127.0.0.1:{}", port); };
  const std::vector<std::string> ports = {at(net::portOf(silent->get())), at(none),
                                          at(wand.port())};
  std::vector<VrpnAnswer> answers;
  // The test repeats this, since a busy machine may take longer than the servers' time limit.
  EXPECT_TRUE(test::eventually([&] {
    const auto began = std::chrono::steady_clock::now();
    answers = askServers(ports, std::chrono::milliseconds(300));
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
    return !answers[1].catalog.greeted() && answers[2].catalog.devices().size() == 1 &&
           answers[2].catalog.devices()[0].sent.buttons;
  }));
  EXPECT_EQ(answers[0].fault, "no answer within 0.3 s");
  EXPECT_EQ(answers[1].fault, "Connection refused");
  EXPECT_EQ(answers[2].fault, "");
}

}  // namespace
}  // namespace merlin::cli
