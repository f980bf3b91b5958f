#include "drivers/emulate/emulator.h"

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "drivers/cyberglove/protocol.h"
#include "drivers/emulate/wire.h"
#include "drivers/fastrak/protocol.h"
#include "tests/support/fake_clock.h"

namespace merlin::emulate {
namespace {

using namespace std::string_literals;
using std::chrono::milliseconds;
using std::chrono::seconds;

// Takes the place of the program at the other end of an emulator's line.
struct Box {
  explicit Box(const char* device, const EmulatorSettings& settings = {},
               const char* script_name = "visit")
      : emulator(
            findEmulator(device)->make(settings, *findMotionScript(script_name), clock.now())) {}

  // Sends `bytes`; returns the emulator's immediate answer.
  std::string ask(std::string_view bytes) {
    emulator->receive(std::as_bytes(std::span(bytes)), clock.now());
    std::string out;
    emulator->advance(clock.now(), out);
    return out;
  }

  // Returns everything that the emulator sends during `time`.
  std::string listen(Duration time) {
    std::string out;
    for (const Timestamp end = clock.now() + time;;) {
      const Timestamp due = std::max(emulator->nextDue(), clock.now());
      if (due >= end) {
        clock.advance(end - clock.now());
        return out;
      }
      clock.advance(std::max<Duration>(due - clock.now(), std::chrono::nanoseconds(1)));
      emulator->advance(clock.now(), out);
    }
  }

  test::FakeClock clock;
  std::unique_ptr<Emulator> emulator;
};

TEST(Emulators, AreFoundByName) {
  EXPECT_EQ(emulators().size(), 3u);
  for (const EmulatorEntry& entry : emulators()) EXPECT_EQ(findEmulator(entry.name), &entry);
  EXPECT_EQ(findEmulator("mouse"), nullptr);
}

TEST(Emulators, OneSeedGivesOneStream) {
  const auto stream = [](const char* device, std::uint64_t seed, int garbage_every) {
    Box box(device, {.seed = seed, .garbage_every = garbage_every});
    box.ask("SfC\rMSSV\r");  // starts the stream of any of the devices
    return box.listen(seconds(5));
  };
  for (const EmulatorEntry& entry : emulators()) {
    EXPECT_EQ(stream(entry.name, 1, 3), stream(entry.name, 1, 3)) << entry.name;
    EXPECT_NE(stream(entry.name, 1, 3), stream(entry.name, 2, 3)) << entry.name;
    EXPECT_GT(stream(entry.name, 1, 0).size(), 500u) << entry.name;
  }
}

TEST(Wire, HoldsWhatItsBaudRateLetsThrough) {
  const Timestamp start{seconds(1)};
  Wire wire(9600, 0, 1);
  std::string out;
  wire.record("0123456789", start, out);
  EXPECT_FALSE(wire.free(start + milliseconds(10)));
  EXPECT_TRUE(wire.free(start + milliseconds(11)));  // 100 bits at 9600 bit/s take 10.4 ms
  wire.reply("01234", start, out);
  EXPECT_FALSE(wire.free(start + milliseconds(15)));
  EXPECT_EQ(out, "012345678901234");
}

TEST(MotionScript, NeverLeavesItsPhases) {
  for (const MotionScript& script : motionScripts()) {
    Motion last = script.at(Duration::zero());
    // 200 s in steps of 10 ms, across every repetition of the script
    for (int i = 1; i < 20'000; ++i) {
      const Motion now = script.at(milliseconds(10 * i));
      for (std::size_t s = 0; s < kGloveSlots; ++s) {
        ASSERT_NEAR(now.glove_rad[s], last.glove_rad[s], 0.12) << script.name << " " << i;
      }
      for (std::size_t s = 0; s < 3; ++s) {
        ASSERT_NEAR(now.position_m[s], last.position_m[s], 0.02) << script.name << " " << i;
      }
      last = now;
    }
    script.at(std::chrono::hours(24 * 300));
  }
}

TEST(MotionScript, HoldsThePhaseThatTheCallerSays) {
  std::size_t phase = 0;
  MotionScript script = *findMotionScript("alignment");
  script.held = &phase;
  EXPECT_FLOAT_EQ(script.at(seconds(7)).position_m[1], 0.05F);
  EXPECT_FLOAT_EQ(script.at(seconds(700)).position_m[1], 0.05F);
  phase = 5;  // there are four phases, so phase 5 is the second one
  EXPECT_FLOAT_EQ(script.at(seconds(700)).position_m[1], 0.45F);
  EXPECT_FLOAT_EQ(script.at(Duration::zero()).position_m[1], 0.45F) << "at once";
  phase = 3;
  // Sine of half of 40 degrees.
  EXPECT_NEAR(script.at(seconds(1)).orientation_wxyz[3], 0.34202F, 1e-5F);
}

TEST(CybergloveEmulator, AnswersQueries) {  // fact sheet, section 4.5 and example 4
  Box box("cyberglove");
  EXPECT_EQ(box.ask("?M"), "\x3F\x4D\x7F\xFF\x7F\x00"s);
  EXPECT_EQ(box.ask("?K"), "\x3F\x4B\x7F\xFF\x7F\x00"s);
  EXPECT_EQ(box.ask("?G"), "\x3F\x47\x03\x00"s);
  EXPECT_EQ(box.ask("?D"), "\x3F\x44\x00\x00"s);
  EXPECT_EQ(box.ask("?F"), "\x3F\x46\x01\x00"s);
  EXPECT_EQ(box.ask("?W"), "\x3F\x57\x00\x00"s);
  EXPECT_EQ(box.ask("?N"), "\x3F\x4E\x16\x00"s);
  EXPECT_EQ(box.ask("?S"), "\x3F\x53\x16\x00"s);
  EXPECT_EQ(box.ask("?R"), "\x3F\x52\x01\x00"s);
  EXPECT_EQ(box.ask("?T"), "\x3F\x54\x04\x80\x00\x01\x00"s);
  EXPECT_EQ(box.ask("?P"), "\x3F\x50\x81\xD8\x00\x00"s);
  EXPECT_EQ(box.ask("?V").size(), 7u);
  const std::string info = box.ask("?i");
  EXPECT_NE(info.find("CyberGlove"), std::string::npos);
  EXPECT_LT(info.size(), 500u);
  EXPECT_EQ(info.find('\0'), info.size() - 1);
  EXPECT_EQ(Box("cyberglove", {.model = "18"}).ask("?K?S"), "?K\x3F\xBB\x7B\0?S\x12\0"s);
}

TEST(CybergloveEmulator, ObeysSetsAndRefusesTheRest) {  // fact sheet, sections 4.2, 4.3, 4.6
  Box box("cyberglove");
  EXPECT_EQ(box.ask("T\x05\xA0\x00\x01"s), "T\0"s);
  EXPECT_EQ(box.ask("?T"), "?T\x05\xA0\x00\x01\0"s);
  for (const char letter : "DFJLQUWY"s) {
    for (const char value : {'\1', '\0'}) {
      EXPECT_EQ(box.ask(std::string{letter, value}), (std::string{letter, '\0'}));
      EXPECT_EQ(box.ask(std::string{'?', letter}), (std::string{'?', letter, value, '\0'}));
    }
    EXPECT_EQ(box.ask(std::string{letter, '\2'}), "en\0"s);
  }
  EXPECT_EQ(box.ask("P\x86\x24\x01"s), "P\0"s);
  EXPECT_EQ(box.ask("?P"), "?P\x87\xE4\x01\0"s);
  EXPECT_EQ(box.ask("?D?U?W?L?Q?F?J"), "?D\1\0?U\1\0?W\1\0?L\1\0?Q\1\0?F\0\0?J\0\0"s);
  EXPECT_EQ(box.ask("M\xFF\x00\x00"s), "M\0"s);
  // The mask is combined with the existing sensors by AND.
  EXPECT_EQ(box.ask("?M?N"), "?M\x7F\0\0\0?N\7\0"s);
  EXPECT_EQ(box.ask("N\x08"), "en\0"s);
  EXPECT_EQ(box.ask("N\x03"), "N\0"s);
  EXPECT_EQ(box.ask("G").size(), 1 + 3 + 5 + 1 + 1u);
  EXPECT_EQ(box.ask("B\x08"), "B\0"s);
  EXPECT_EQ(box.ask("Z?Z"), "e?\0e?\0"s);
}

TEST(CybergloveEmulator, StopsAndStartsAgain) {  // fact sheet, section 4.1
  Box box("cyberglove");
  box.ask("SU\1");
  EXPECT_GT(box.listen(seconds(1)).size(), 2000u);
  EXPECT_EQ(box.ask("\x03"), "\x03\r\n\0"s);
  EXPECT_EQ(box.listen(seconds(1)), "");
  EXPECT_EQ(box.ask("\x09"), "\x09\r\n\0"s);
  box.ask("\x12");
  EXPECT_EQ(box.ask("?U"), "");  // does not answer while it resets
  EXPECT_EQ(box.listen(milliseconds(1749)), "");
  EXPECT_EQ(box.listen(milliseconds(2)), "\x12\r\n\0"s);
  EXPECT_EQ(box.ask("?U"), "?U\0\0"s);  // the command sent during the reset was discarded
}

TEST(CybergloveEmulator, NeverSendsAZeroInARecord) {
  Box box("cyberglove");
  box.ask("D\1U\1");
  for (int i = 0; i < 3000; ++i) {
    const std::string record = box.ask("G");
    ASSERT_EQ(record.size(), 30u);
    ASSERT_EQ(record.find('\0'), 29u);
    box.clock.advance(milliseconds(7));
  }
}

TEST(CybergloveEmulator, SaysThatItCannotSampleFaster) {
  Box box("cyberglove", {.baud = 115200});
  box.ask("T\x01\x00\x00\x01"s);  // 450 Hz
  box.ask("S");
  const std::string stream = box.listen(seconds(1));
  EXPECT_NEAR(static_cast<double>(stream.size()) / 26, 150, 2);  // 24 bytes and "es" in each record
  EXPECT_TRUE(stream.ends_with("es\0"s));
}

TEST(CybergloveEmulator, SendsWhatASlowLineHolds) {  // fact sheet, section 6
  Box box("cyberglove", {.baud = 9600});
  box.ask("S");
  EXPECT_NEAR(static_cast<double>(box.listen(seconds(10)).size()) / 24, 400, 2);
}

TEST(FastrakEmulator, StartsInAsciiAndInches) {  // fact sheet, sections 4 and 5
  Box box("fastrak", {}, "still");
  EXPECT_EQ(box.ask("S"), "21S3F0  0        3.00OutputCompensat CPG2030-003-10  \r\n");
  const std::string record = box.ask("P");
  ASSERT_EQ(record.size(), 47u);
  EXPECT_EQ(record.substr(0, 3), "01 ");
  EXPECT_NEAR(std::stod(record.substr(3, 7)), 0.60 / 0.0254, 0.2);
  EXPECT_NEAR(std::stod(record.substr(10, 7)), 0.05 / 0.0254, 0.2);
  EXPECT_NEAR(std::stod(record.substr(17, 7)), -0.15 / 0.0254, 0.2);
  EXPECT_NEAR(std::stod(record.substr(24, 7)), 0, 1);
  box.ask("fuDC");
  EXPECT_EQ(box.ask("S").substr(0, 6), "21S3FF");
}

TEST(FastrakEmulator, AnswersWhatIsAskedForAndKeepsWhatIsOmitted) {  // section 2
  Box box("fastrak", {.model = "2"});
  EXPECT_EQ(box.ask("l1\r"), "21l1100\r\n");
  EXPECT_EQ(box.ask("l2,0\rl\r"), "21l1000\r\n");
  EXPECT_EQ(box.ask("l3,1\rl3\r"), "23l1000\r\n");  // there is no receiver 3, so it stays off
  EXPECT_EQ(box.ask("O1\r"), "21O 2 4 1\r\n");
  EXPECT_EQ(box.ask("O1,2,11,0\rO1\r"), "21O 211 0\r\n");
  EXPECT_EQ(box.ask("H1\r"), "21H   1.00   0.00   0.00\r\n");
  EXPECT_EQ(box.ask("H1,,-1\rH1\r"), "21H   1.00  -1.00   0.00\r\n");
  EXPECT_EQ(box.ask("N1,\r\n"), "21N   0.00   0.00   0.00\r\n");
  EXPECT_EQ(box.ask("A1\r").size(), 68u);
  EXPECT_EQ(box.ask("G1\r").size(), 26u);
  EXPECT_EQ(box.ask("I1\r").size(), 12u);
  EXPECT_EQ(box.ask("x\r").size(), 33u);
  EXPECT_EQ(box.ask("X\r").size(), 37u);
  EXPECT_EQ(box.ask("Xhello P\rX\r").substr(0, 11), "2 Xhello P ");
  EXPECT_EQ(box.ask("R1\rb1\rB1\re1,0\ro384,N,8,0\ry0\rV1,1,1,1,-1,-1,-1\rD"), "");
}

TEST(FastrakEmulator, RefusesInTheManualsForm) {  // section 2
  for (const char* wrong : {"O1,3\r", "O1,,2\r", "O5,2,0\r", "Hx\r", "k1\r", "l9\r"}) {
    Box box("fastrak");
    const std::string error = box.ask(wrong);
    EXPECT_TRUE(error.starts_with("2 E*ERROR*")) << wrong;
    EXPECT_TRUE(error.ends_with("\r\n")) << wrong;
    EXPECT_EQ(box.ask("O1\r"), "21O 2 4 1\r\n");
  }
}

TEST(FastrakEmulator, GetsOutOfAnyLineByReinitialising) {  // VRPN's reset strings, section 7
  for (const char* reset : {"c", "\rc", "\r\x19", "\rt\x19", "\rYt\x19", "X no end \x19"}) {
    Box box("fastrak");
    box.ask("C");
    box.ask(reset);
    box.listen(milliseconds(1001));
    box.ask("c");
    EXPECT_EQ(box.listen(seconds(2)), "") << reset;
    EXPECT_EQ(box.ask("S").size(), 55u) << reset;
  }
}

TEST(FastrakEmulator, IsDeafWhileItStartsAndRemembersWhatWasSaved) {
  Box box("fastrak");
  box.ask(
      "u\x0B"
      "f\x19S");
  EXPECT_EQ(box.listen(milliseconds(999)), "");
  EXPECT_EQ(box.ask("S"), "");
  box.listen(milliseconds(2));
  // The saved values are in effect again: centimetres and ASCII.
  EXPECT_EQ(box.ask("S").substr(3, 3), "3F2");
  EXPECT_EQ(box.ask("WS").substr(3, 3), "3F0");
}

// Section 7: there are only two receivers, although VRPN asks for four stations.
TEST(FastrakEmulator, SpeaksWithVrpn) {
  Box box("fastrak", {.model = "2"});
  EXPECT_EQ(box.ask("c"), "");
  EXPECT_EQ(box.ask("S").size(), 55u);
  EXPECT_EQ(box.ask("O1,2,11,0\rO2,2,11,0\rO3,2,11,0\rO4,2,11,0\r"), "");
  EXPECT_EQ(box.ask("x0.2,0.2,0.8,0.8\rv0.2,0.2,0.8,0.8\rfC"), "");
  const std::string stream = box.listen(seconds(1));
  ASSERT_NEAR(static_cast<double>(stream.size()), 120 * 32, 64);
  for (std::size_t i = 0; i + 32 <= stream.size(); i += 32) {
    EXPECT_EQ(stream[i], '0');
    EXPECT_EQ(stream[i + 1], (i % 64 == 0) == (stream[1] == '1') ? '1' : '2');
    EXPECT_EQ(stream[i + 31], ' ');
  }
}

TEST(FastrakEmulator, SpeaksWithVrui) {  // section 7
  Box box("fastrak");
  box.ask("c\x19");
  box.listen(milliseconds(1001));
  EXPECT_TRUE(box.ask("S").starts_with("21S"));
  EXPECT_EQ(box.ask("l1,1\r\nR1\r\nb1\r\nH1,1,0,0\r\nO1,2,4,16,1\r\ne1,0\r\nF"), "");
  EXPECT_EQ(box.ask("N1,\r\n").back(), '\n');
  EXPECT_EQ(box.ask("dUfC"), "");
  const std::string stream = box.listen(seconds(1));
  EXPECT_NEAR(static_cast<double>(stream.size()), 120 * 31, 62);
  EXPECT_EQ(stream.substr(27, 4), " 0\r\n");
}

TEST(FastrakEmulator, DropsWhatItsLineCannotHold) {  // section 6
  Box box("fastrak");
  // 81.7 records of 47 bytes fit into a second at 38400 baud; every second one of 120 is sent
  box.ask("C");
  EXPECT_NEAR(static_cast<double>(box.listen(seconds(10)).size()) / 47, 600, 2);
  EXPECT_EQ(box.ask("\x13"), "");
  EXPECT_EQ(box.listen(seconds(1)), "");
  box.ask("\x11");
  EXPECT_GT(box.listen(seconds(1)).size(), 2000u);
}

TEST(FastrakEmulator, HasTheNoiseOfTheSpecification) {  // 0.03 inch and 0.15 degrees RMS
  Box box("fastrak", {.baud = 115200}, "still");
  box.ask("ufO1,2,11,0\rC");
  const std::string stream = box.listen(seconds(30));
  fastrak::Parser parser;
  double position = 0, angle = 0;
  int n = 0;
  for (const char c : stream) {
    const auto r = parser.feed(static_cast<std::byte>(c), 0);
    if (!r) continue;
    ++n;
    position += std::pow(r->position[0] - 60, 2);  // 60 cm is the true position
    // Rotation about x in radians, from the quaternion.
    angle += std::pow(2 * r->orientation_wxyz[1], 2);
  }
  ASSERT_GT(n, 3500);
  EXPECT_NEAR(std::sqrt(position / n), 0.076, 0.004);
  EXPECT_NEAR(std::sqrt(angle / n) * 180 / std::numbers::pi, 0.15, 0.008);
}

TEST(SpaceballEmulator, ResetsWithTheBannerThatEveryDriverTakes) {  // fact sheet, section 3
  Box box("spaceball", {.baud = 9600, .model = "4000"});
  EXPECT_EQ(box.ask("\r@RESET\r"), "");
  EXPECT_EQ(box.listen(milliseconds(500)),
            "\x11\r@1 Spaceball alive and well after a software reset.\r\n"
            "@2 Firmware version 2.43 created on 24-Oct-1997.\r\n");
}

TEST(SpaceballEmulator, AnswersCommands) {  // fact sheet, section 4
  Box box("spaceball", {.baud = 9600}, "still");
  EXPECT_EQ(box.ask("CB\rNT\rFT?\rP@r@r\r"), "CB@\rNT\rFT?\rP@r@r\r");
  EXPECT_EQ(box.ask("hm\r"), "Hm2003B\r");
  EXPECT_EQ(box.ask("k\r"), "K@@\r");
  EXPECT_EQ(box.ask("Z\r").size(), 14u);
  EXPECT_EQ(box.ask("BcCc\r"), "");
  EXPECT_EQ(box.ask("w\r"), "?w\r");
  EXPECT_EQ(box.ask("\n \r"), "");
  // Once on, a ball at rest sends one displacement of zero: example 1, except for its period.
  EXPECT_EQ(box.ask("MSSV\r"), "MSSV\r");
  const std::string rest = box.listen(seconds(5));
  EXPECT_EQ(rest[0], 'D');
  EXPECT_EQ(rest.substr(3), std::string(12, '\0') + "\r");
}

}  // namespace
}  // namespace merlin::emulate
