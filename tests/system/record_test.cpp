// merlin record, replay, flight and calibrate, run as a person would run them.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "drivers/io/pty_master.h"
#include "drivers/io/transcript.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

TEST(Record, WhatIsRecordedReplaysIntoTheSameSamples) {
  const TempDir dir;
  Process ball({kMerlin, "emulate", "spaceball", "--link", dir / "ball", "--script", "turning"});
  ASSERT_TRUE(ball.saysEventually("spaceball on")) << ball.output();
  const Outcome recorded = run({kMerlin, "record", "pty:" + dir / "ball", "--device", "spaceball",
                                "-o", dir / "ball.bytes", "--seconds", "2"});
  ASSERT_EQ(recorded.status, 0) << recorded.output;
  const auto first = io::readTranscript(dir / "ball.bytes");
  ASSERT_TRUE(first) << first.error().what;
  EXPECT_EQ((*first)["device"], "Spaceball 2003, firmware 2.13");

  Process replay({kMerlin, "replay", dir / "ball.bytes", "--link", dir / "again"});
  ASSERT_TRUE(replay.saysEventually("on pty:")) << replay.output();
  const Outcome second = run({kMerlin, "record", "pty:" + dir / "again", "--device", "spaceball",
                              "-o", dir / "again.bytes", "--seconds", "2"});
  ASSERT_EQ(second.status, 0) << second.output;
  EXPECT_EQ(replay.wait(), 0);
  std::string then, now;
  for (const auto& c : first->chunks) then += c.to_device ? "" : c.bytes;
  const auto again = io::readTranscript(dir / "again.bytes");
  ASSERT_TRUE(again);
  for (const auto& c : again->chunks) now += c.to_device ? "" : c.bytes;
  ASSERT_GT(now.size(), 300u);
  EXPECT_EQ(then.substr(0, now.size()), now);
}

TEST(Record, ADeviceOfAConfigurationIsReadWithItsOwnSettings) {
  const TempDir dir;
  Process tracker({kMerlin, "emulate", "fastrak", "--link", dir / "tracker"});
  ASSERT_TRUE(tracker.saysEventually("fastrak on")) << tracker.output();
  const std::string config = dir / "wall.json";
  writeText(config, R"({"devices": [{"name": "left", "driver": "cyberglove"},
      {"name": "eyes", "driver": "fastrak", "port": "pty:)" +
                        dir / "tracker" + R"(", "fastrak": {"centimetres": false}}]})");
  const auto record = [&](std::vector<std::string> more) {
    std::vector<std::string> command = {kMerlin, "record",           "--config",  config,
                                        "-o",    dir / "eyes.bytes", "--seconds", "1"};
    command.insert(command.end(), more.begin(), more.end());
    return run(command);
  };
  const Outcome recorded = record({"--device", "eyes"});
  ASSERT_EQ(recorded.status, 0) << recorded.output;
  const auto transcript = io::readTranscript(dir / "eyes.bytes");
  ASSERT_TRUE(transcript) << transcript.error().what;
  EXPECT_EQ((*transcript)["driver"], "fastrak");
  const auto said = [&](const std::string& text) {
    return std::ranges::any_of(transcript->chunks, [&](const auto& chunk) {
      return chunk.to_device && chunk.bytes == text;
    });
  };
  EXPECT_TRUE(said("U")) << "the unit is set to inches";
  EXPECT_FALSE(said("u"));

  const Outcome nobody = record({"--device", "nobody"});
  EXPECT_EQ(nobody.status, 2);
  EXPECT_EQ(nobody.output, "merlin: " + config +
                               ": /devices has no device named \"nobody\"; its devices: left, "
                               "eyes\n");
  const Outcome portless = record({"--device", "left"});
  EXPECT_EQ(portless.status, 2);
  EXPECT_EQ(portless.output, "merlin: " + config +
                                 ": the device \"left\" has no port: give one, such as "
                                 "serial:/dev/ttyUSB0\n");
  EXPECT_EQ(record({}).status, 2) << "which device is not said";
}

TEST(Record, BadInputIsOneClearMessage) {
  const TempDir dir;
  writeText(dir / "half.bytes", "# device: x\n@0.1 4400\n");
  const Outcome half = run({kMerlin, "replay", dir / "half.bytes"});
  EXPECT_EQ(half.status, 2);
  EXPECT_EQ(half.output,
            "merlin: " + dir / "half.bytes" +
                ": ends after line 2 without \"# end\": it was cut off; it is not a complete "
                "transcript\n");
  const Outcome none = run({kMerlin, "record", "usb:1", "-o", dir / "x"});
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.output.find("ports are serial:"), std::string::npos) << none.output;
  const Outcome absent = run({kMerlin, "record", "pty:" + dir / "nothing", "-o", dir / "x"});
  EXPECT_EQ(absent.status, 2) << absent.output;
  const Outcome unknown =
      run({kMerlin, "record", "pty:x", "--device", "spacebal", "-o", dir / "x"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.output.find("there is no driver \"spacebal\"; the drivers are cyberglove"),
            std::string::npos)
      << unknown.output;
  const Outcome portless = run({kMerlin, "record", "-o", dir / "x"});
  EXPECT_EQ(portless.status, 2);
  EXPECT_NE(portless.output.find("no port is given: name one"), std::string::npos)
      << portless.output;
}

TEST(Flight, TheDaemonDumpsOnCommandAndOnAFault) {
  const TempDir dir;
  Merlind merlind(dir, "", "flight", {.script = "turning", .role = "devices"});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(merlind.healthIs("ball", HealthState::kOk));
  ASSERT_TRUE(eventually([&] { return merlind.devices()->ball()->samples->count() > 20; }));
  const Outcome asked = run({kMerlin, "flight", "--instance", merlind.instance()});
  ASSERT_EQ(asked.status, 0) << asked.output;
  const auto at = asked.output.find(dir / "flight/" + merlind.instance() + "-ball-");
  ASSERT_NE(at, std::string::npos) << asked.output;
  const auto dump =
      io::readTranscript(asked.output.substr(at, asked.output.find(".bytes", at) + 6 - at));
  ASSERT_TRUE(dump) << dump.error().what;
  EXPECT_EQ((*dump)["driver"], "spaceball");
  EXPECT_GT(dump->chunks.size(), 20u);
  for (const pid_t child : merlind.children("spaceball")) ::kill(child, SIGKILL);
  EXPECT_TRUE(merlind.process().saysEventually("the last bytes of ball are in"))
      << merlind.process().output();
}

TEST(Calibrate, WritesIntoAConfigurationThatTheDaemonAccepts) {
  const TempDir dir;
  const std::string config = dir / "merlin.json";
  writeText(config, "{\"instance\": \"kept\"}");
  EXPECT_EQ(run({kMerlin, "calibrate", "ball", "--axis-map", "1", "2", "-3", "4", "5", "-6",
                 "--full-scale-translation", "6000", "-o", config})
                .status,
            0);
  EXPECT_EQ(run({kMerlin, "calibrate", "tracker", "--station", "2", "--boresight", "0.6", "0", "0",
                 "0.8", "-o", config})
                .status,
            0);
  std::string vess;
  for (int i = 0; i < 23; ++i) vess += "60 40 200\n";
  writeText(dir / "vess", vess);
  const Outcome imported = run({kMerlin, "calibrate", "import", dir / "vess", "-o", config});
  EXPECT_EQ(imported.status, 0) << imported.output;
  const auto json = nlohmann::json::parse(readText(config));
  EXPECT_EQ(json["instance"], "kept");
  ASSERT_EQ(json["devices"].size(), 3u) << "the default list: " << json;
  EXPECT_EQ(json["devices"][2]["spaceball"]["full_scale_translation"], 6000);
  EXPECT_EQ(json["devices"][1]["fastrak"]["boresight2_wxyz"][3], 0.8);
  EXPECT_EQ(json["devices"][0]["cyberglove"]["offset"][4], 60);
  const Outcome checked = run({kMerlind, "--check-config", config, "--role", "devices"});
  EXPECT_EQ(checked.status, 0) << checked.output;
  const std::string before = readText(config);
  writeText(dir / "flipped", "60 200 40\n" + vess.substr(10));
  const Outcome flipped = run({kMerlin, "calibrate", "import", dir / "flipped", "-o", config});
  EXPECT_EQ(flipped.status, 2);
  EXPECT_NE(flipped.output.find("are they swapped?"), std::string::npos) << flipped.output;
  EXPECT_EQ(readText(config), before);
}

// The glove never answers. The bytes on its line show what the driver sent, and at which speed.
TEST(CalibrateGlove, SpeaksToTheGloveAsTheConfigurationsEntrySays) {
  const TempDir dir;
  const std::string config = dir / "merlin.json";
  const auto entry = [&](const char* dialogue, int baud) {
    writeText(config,
              fmt::format(R"({{"wall": {{"model": 7}}, "devices": [{{"driver": "spaceball"}},
        {{"name": "right", "driver": "cyberglove", "baud": {},
          "cyberglove": {{"dialogue": "{}", "rate_hz": 50}}}}]}})",
                          baud, dialogue));
  };
  const auto calibrate = [&](std::vector<std::string> also = {}) {
    std::vector<std::string> words = {kMerlin, "calibrate", "glove", "pty:" + dir / "glove",
                                      "-o",    config};
    words.insert(words.end(), also.begin(), also.end());
    return run(words);
  };
  const auto line = io::PtyMaster::open(dir / "glove");
  ASSERT_TRUE(line) << line.error().what;
  const auto asked = [&] {
    std::array<char, 256> bytes{};
    const ssize_t n = ::read(line->fd(), bytes.data(), bytes.size());
    return std::string(bytes.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  };
  entry("text", 115200);
  const Outcome text = calibrate();
  EXPECT_EQ(text.status, 1) << text.output;
  EXPECT_NE(asked().find("?i\r"), std::string::npos);
  EXPECT_EQ(line->baud(), 115200);
  EXPECT_EQ(calibrate({"--baud", "57600"}).status, 1);
  EXPECT_EQ(line->baud(), 57600);
  (void)asked();
  entry("binary", 0);
  EXPECT_EQ(calibrate().status, 1);
  EXPECT_EQ(asked().find('\r'), std::string::npos);
  EXPECT_EQ(line->baud(), 38400) << "the driver's usual one";
  entry("text", 9600);
  const Outcome slow = calibrate();
  EXPECT_EQ(slow.status, 2) << slow.output;
  EXPECT_NE(slow.output.find("merlin.json: /devices/1/cyberglove/rate_hz is 50, but a line of 9600 "
                             "baud carries 10 records"),
            std::string::npos)
      << slow.output;
}

}  // namespace
}  // namespace merlin::test
