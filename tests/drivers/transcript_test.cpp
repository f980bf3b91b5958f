// Streams other than pseudo-terminals: transcripts and their replay, the recorder, tcp://, adapters
// that add a delay.
#include "drivers/io/transcript.h"

#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "daemon/base/unique_fd.h"
#include "drivers/io/cpu_latency.h"
#include "drivers/io/low_latency.h"
#include "drivers/io/open_stream.h"
#include "drivers/io/recording_stream.h"
#include "drivers/io/replay_stream.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/temp_dir.h"

namespace merlin::io {
namespace {

using namespace std::string_literals;
using std::chrono::milliseconds;

constexpr std::string_view kBall =
    "# device: Spaceball 2003, firmware unknown      # synthetic: yes (merlin emulate, seed 7)\n"
    "# serial: 9600 8N1 xonxoff\n"
    "\n"
    "@0.100000 to 0d 40  <- a reset\n"
    "@0.250000 4400100001ffff0100000000000000 0d   <- hex, white space and <- comments ignored\n"
    "440010000100000d\n"
    "# end\n";

TEST(Transcript, IsReadAsItIsWritten) {
  const auto t = parseTranscript(kBall);
  ASSERT_TRUE(t) << t.error().what;
  EXPECT_EQ((*t)["device"], "Spaceball 2003, firmware unknown");
  EXPECT_EQ((*t)["synthetic"], "yes (merlin emulate, seed 7)");
  EXPECT_EQ(t->baud(), 9600);
  ASSERT_EQ(t->chunks.size(), 3u);
  EXPECT_TRUE(t->chunks[0].to_device);
  EXPECT_EQ(t->chunks[0].bytes, "\r@");
  EXPECT_EQ(t->chunks[1].bytes.size(), 16u);
  EXPECT_EQ(t->chunks[1].at, milliseconds(250));
  // Before this chunk there are 16 bytes, which take ten bits each at 9600 baud.
  EXPECT_EQ(t->chunks[2].at, milliseconds(250) + std::chrono::nanoseconds(16'666'666));
}

TEST(Transcript, SurvivesARoundTrip) {
  const auto first = parseTranscript(kBall);
  ASSERT_TRUE(first);
  const std::string text = formatTranscript(*first);
  const auto second = parseTranscript(text);
  ASSERT_TRUE(second) << second.error().what;
  EXPECT_EQ(formatTranscript(*second), text);
}

TEST(Transcript, CutAnywhereItIsNoTranscript) {
  for (std::size_t n = 0; n + 1 < kBall.size(); ++n) {
    if (kBall.substr(0, n).ends_with("# end")) continue;
    const auto t = parseTranscript(kBall.substr(0, n));
    ASSERT_FALSE(t) << n;
    EXPECT_EQ(t.error().code, Errc::kMalformed);
  }
  EXPECT_EQ(parseTranscript("# device: x\n44 00\n").error().what,
            "ends after line 2 without \"# end\": it was cut off");
}

TEST(Transcript, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(parseTranscript("440\n# end\n").error().what, "line 1 ends in the middle of a byte");
  EXPECT_EQ(parseTranscript("44\n4x\n# end\n").error().what,
            "line 2 has \"x\" where hex digits are expected");
  EXPECT_EQ(parseTranscript("@2 44\n@1 44\n# end\n").error().what,
            "line 2 has a time before that of the line above");
  EXPECT_EQ(parseTranscript("@nan 44\n# end\n").error().what,
            "line 1 has no valid time, in seconds, after its @");
  EXPECT_EQ(parseTranscript("# end\n44\n").error().what, "line 2 comes after \"# end\"");
}

TEST(Transcript, OfAFileThatIsCutNamesTheFile) {
  const test::TempDir dir;
  test::writeText(dir / "half.bytes", std::string(kBall.substr(0, 150)));
  const auto t = openPort({PortKind::kReplay, dir / "half.bytes", {}}, 9600);
  ASSERT_FALSE(t);
  EXPECT_NE(t.error().what.find("half.bytes: "), std::string::npos) << t.error().what;
}

TEST(ReplayStream, GivesBytesAtTheirTimesAndEnds) {
  test::FakeClock clock;
  const Timestamp start = clock.now();
  ReplayStream stream(*parseTranscript("@0.5 0102\n@1.5 03\n# end\n"), clock);
  std::byte buffer[8];
  EXPECT_EQ(stream.read(buffer, milliseconds(100)).error().code, Errc::kTimeout);
  EXPECT_EQ(*stream.read(buffer, std::chrono::seconds(1)), 2u);
  EXPECT_EQ(clock.now() - start, milliseconds(500));
  EXPECT_EQ(*stream.read(buffer, std::chrono::seconds(9)), 1u);
  EXPECT_EQ(clock.now() - start, milliseconds(1500));
  EXPECT_EQ(stream.read(buffer, milliseconds(100)).error().code, Errc::kClosed);
}

TEST(ReplayStream, AnswersAsLateAfterTheQuestionAsItDidThen) {
  test::FakeClock clock;
  ReplayStream stream(*parseTranscript("@1.0 to 6869\n@1.2 0102\n# end\n"), clock);
  std::byte buffer[8];
  clock.advance(milliseconds(700));
  const Timestamp asked = clock.now();
  ASSERT_TRUE(stream.write(std::as_bytes(std::span("hi", 2)), {}));
  EXPECT_EQ(*stream.read(buffer, std::chrono::seconds(1)), 2u);
  EXPECT_EQ(clock.now() - asked, milliseconds(200));
}

TEST(ReplayStream, WaitsTwoSecondsForAHostThatSaysLess) {
  test::FakeClock clock;
  ReplayStream stream(*parseTranscript("@0 to 6869\n@0.1 01\n# end\n"), clock);
  const Timestamp start = clock.now();
  std::byte buffer[8];
  ASSERT_TRUE(stream.write(std::as_bytes(std::span("h", 1)), {}));
  EXPECT_EQ(*stream.read(buffer, std::chrono::seconds(9)), 1u);
  EXPECT_EQ(clock.now() - start, milliseconds(2100));
}

TEST(ReplayStream, AnInterruptEndsIt) {
  test::FakeClock clock;
  ReplayStream stream(*parseTranscript("@5 01\n# end\n"), clock);
  stream.interrupt();
  std::byte buffer[8];
  EXPECT_EQ(stream.read(buffer, std::chrono::seconds(9)).error().code, Errc::kClosed);
}

TEST(RecordingStream, TellsWhatWentBothWays) {
  struct Tap final : ByteTap {
    void opened(Timestamp) noexcept override { all += "o"; }
    void heard(Timestamp, std::span<const std::byte> b) noexcept override { add('<', b); }
    void said(Timestamp, std::span<const std::byte> b) noexcept override { add('>', b); }
    void add(char way, std::span<const std::byte> b) {
      all += way + std::string(reinterpret_cast<const char*>(b.data()), b.size());
    }
    std::string all;
  } tap;
  test::FakeClock clock;
  auto inner = std::make_unique<test::FakeStream>(clock, nullptr);
  inner->feed("yes");
  RecordingStream stream(std::move(inner), tap, clock);
  std::byte buffer[8];
  ASSERT_TRUE(stream.write(std::as_bytes(std::span("you?", 4)), {}));
  ASSERT_TRUE(stream.read(buffer, {}));
  EXPECT_FALSE(stream.read(buffer, {}));
  EXPECT_EQ(tap.all, "o>you?<yes");
}

TEST(Ports, AreNamedInFourWays) {
  EXPECT_EQ(parsePort("serial:/dev/ttyS0")->kind, PortKind::kSerial);
  EXPECT_EQ(parsePort("replay:a.bytes")->path, "a.bytes");
  const auto tcp = parsePort("tcp://lab.example:4001");
  ASSERT_TRUE(tcp);
  EXPECT_EQ(tcp->path, "lab.example");
  EXPECT_EQ(tcp->service, "4001");
  EXPECT_EQ(parsePort("tcp://[::1]:4001")->path, "::1");
  for (const char* bad : {"tcp://host", "tcp://:4001", "tcp://host:0", "tcp://host:x", "usb:1", ""})
    EXPECT_FALSE(parsePort(bad)) << bad;
}

// A TCP server on this machine that passes on raw serial bytes.
struct Server {
  Server() : fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(fd.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::listen(fd.get(), 1), 0);
    ::getsockname(fd.get(), reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
  }
  UniqueFd fd;
  int port = 0;
};

TEST(TcpStream, CarriesBytesBothWaysAndSaysWhenTheServerIsGone) {
  Server server;
  const auto address = parsePort("tcp://127.0.0.1:" + std::to_string(server.port));
  ASSERT_TRUE(address);
  auto stream = openPort(*address, 9600);
  ASSERT_TRUE(stream) << stream.error().what;
  UniqueFd peer(::accept(server.fd.get(), nullptr, nullptr));
  ASSERT_TRUE((*stream)->write(std::as_bytes(std::span("S", 1)), std::chrono::seconds(1)));
  char heard = 0;
  ASSERT_EQ(::read(peer.get(), &heard, 1), 1);
  EXPECT_EQ(heard, 'S');
  ASSERT_EQ(::write(peer.get(), "ok", 2), 2);
  std::byte buffer[8];
  EXPECT_EQ(*(*stream)->read(buffer, std::chrono::seconds(5)), 2u);
  peer.reset();
  const Error gone = (*stream)->read(buffer, std::chrono::seconds(5)).error();
  EXPECT_EQ(gone.code, Errc::kClosed);
  EXPECT_EQ(gone.what, "the other end hung up");
}

// The server closes its socket with bytes that it has not read, so that the connection is reset.
TEST(TcpStream, AServerThatBreaksTheConnectionOffIsGoneToo) {
  Server server;
  auto stream = openPort({PortKind::kTcp, "127.0.0.1", std::to_string(server.port)}, 9600);
  ASSERT_TRUE(stream) << stream.error().what;
  UniqueFd peer(::accept(server.fd.get(), nullptr, nullptr));
  ASSERT_TRUE((*stream)->write(std::as_bytes(std::span("S", 1)), std::chrono::seconds(1)));
  pollfd item{peer.get(), POLLIN, 0};
  ASSERT_EQ(::poll(&item, 1, 5000), 1);
  peer.reset();
  std::byte buffer[8];
  const Error gone = (*stream)->read(buffer, std::chrono::seconds(5)).error();
  EXPECT_EQ(gone.code, Errc::kClosed) << "absent, not failed";
  EXPECT_EQ(gone.what, "the other end hung up (read: Connection reset by peer)");
}

TEST(TcpStream, SaysThatNobodyListens) {
  int port = 0;
  { port = Server().port; }
  const auto stream = openPort({PortKind::kTcp, "127.0.0.1", std::to_string(port)}, 9600);
  ASSERT_FALSE(stream);
  EXPECT_EQ(stream.error().what,
            "tcp://127.0.0.1:" + std::to_string(port) + ": Connection refused");
}

TEST(AdapterWarning, NamesTheDelayAndTheWayOut) {
  const test::TempDir dir;
  std::filesystem::create_directories(dir / "class/tty/ttyUSB0/device");
  const std::string timer = dir / "class/tty/ttyUSB0/device/latency_timer";
  test::writeText(dir / "ttyUSB0", "");
  std::filesystem::create_symlink(dir / "ttyUSB0", dir / "by-id");
  EXPECT_EQ(adapterWarning(dir / "by-id", dir.path()), "") << "no timer, no warning";
  test::writeText(timer, "16\n");
  EXPECT_EQ(
      adapterWarning(dir / "by-id", dir.path()),
      dir / "by-id: its USB adapter delays bytes by up to 16 ms; to limit this to 1 ms: echo 1 > " +
          timer);
  test::writeText(timer, "1\n");
  EXPECT_EQ(adapterWarning(dir / "by-id", dir.path()), "");
}

// The kernel's interface is a 32-bit number, which is in effect as long as the device file is open.
TEST(CpuLatency, WritesTheLimitAndSaysWhereItCannot) {
  const test::TempDir dir;
  const std::string device = dir / "cpu_dma_latency";
  const auto none = limitCpuLatency(20, device);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::kNotFound);
  EXPECT_NE(none.error().what.find(device + ": No such file"), std::string::npos);
  test::writeText(device, "");
  const auto limit = limitCpuLatency(20, device);
  ASSERT_TRUE(limit);
  EXPECT_TRUE(limit->valid());
  EXPECT_EQ(test::readText(device), std::string("\x14\0\0\0", 4));
}

// A device's name may contain any bytes.
TEST(Transcript, AHeaderStaysOneLineWhateverIsInIt) {
  Transcript transcript;
  transcript.header = {{"device", "Fastrak\n4400 no comment\x1b[2J"}};
  const auto read = parseTranscript(formatTranscript(transcript));
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ((*read)["device"], "Fastrak\\x0a4400 no comment\\x1b[2J");
  EXPECT_TRUE(read->chunks.empty());
}

}  // namespace
}  // namespace merlin::io
