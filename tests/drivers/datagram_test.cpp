// The port of kind udp: (its address, its records, its socket), and the OSC messages of a datagram.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include "daemon/base/random.h"
#include "daemon/base/unique_fd.h"
#include "drivers/io/open_stream.h"
#include "drivers/port/datagram_line.h"
#include "drivers/port/osc_packet.h"
#include "drivers/port/port_address.h"
#include "tests/support/osc_packets.h"

namespace merlin {
namespace {

using test::datagram;
using test::oscBundle;
using test::oscMessage;
using test::oscText;
using test::oscWord;

struct Got {
  std::uint32_t sender;
  std::string bytes;
  bool operator==(const Got&) const = default;
};

std::vector<Got> parse(DatagramParser& parser, std::string_view bytes) {
  std::vector<Got> all;
  for (const char c : bytes) {
    const auto d = parser.feed(static_cast<std::byte>(c));
    if (d)
      all.push_back({d->sender, {reinterpret_cast<const char*>(d->bytes.data()), d->bytes.size()}});
  }
  return all;
}

TEST(DatagramLine, ReadsWhatIsAppendedAndEveryPrefixWaits) {
  const std::string bytes = datagram("abc", 0x01020304) + datagram(std::string(65507, 'x'), 7);
  DatagramParser parser;
  EXPECT_EQ(parse(parser, bytes),
            (std::vector<Got>{{0x01020304, "abc"}, {7, std::string(65507, 'x')}}));
  EXPECT_EQ(parser.badBytes(), 0u);
  for (std::size_t n = 0; n < 11; ++n) {
    DatagramParser part;
    EXPECT_TRUE(parse(part, bytes.substr(0, n)).empty()) << n;
    EXPECT_EQ(part.inside(), n > 0) << n;
  }
}

TEST(DatagramLine, FindsTheNextDatagramAfterRubbish) {
  DatagramParser parser;
  const std::string no_length = std::string("\xDA\x67\0\0", 4);
  const std::string too_long = std::string("\xDA\x67\xFF\xFF", 4);
  EXPECT_EQ(parse(parser, "\xDA\xDA" + no_length + "junk" + too_long + datagram("abc", 5)),
            (std::vector<Got>{{5, "abc"}}));
  EXPECT_EQ(parser.badBytes(), 14u);
  EXPECT_EQ(parser.badPackets(), 1u);
}

TEST(DatagramLine, OneDamagedByteLosesNoMoreThanItsDatagram) {
  const std::string good = datagram("0123456789abcdef", 3);
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bytes = good;
      bytes[i] = static_cast<char>(bytes[i] ^ 1 << bit);
      DatagramParser parser;
      bytes += good;
      const auto got = parse(parser, bytes);
      ASSERT_FALSE(got.empty()) << i << " " << bit;
      EXPECT_EQ(got.back(), (Got{3, "0123456789abcdef"})) << i << " " << bit;
    }
  }
}

TEST(UdpPort, IsOfThisMachineAloneUnlessItsAddressSaysOtherwise) {
  const auto own = parsePort("udp:3333");
  ASSERT_TRUE(own);
  EXPECT_EQ(own->kind, PortKind::kUdp);
  EXPECT_EQ(own->path, "127.0.0.1");
  EXPECT_EQ(own->service, "3333");
  EXPECT_EQ(parsePort("udp://0.0.0.0:3333")->path, "0.0.0.0");
  EXPECT_EQ(parsePort("udp://[::1]:9000")->path, "::1");
  for (const char* bad : {"udp:", "udp:0", "udp:65536", "udp:x", "udp://lab:3333", "udp://:3333",
                          "udp://1.2.3:3333", "udp://1.2.3.4", "udp:3333 "})
    EXPECT_FALSE(parsePort(bad)) << bad;
}

TEST(UdpPort, IsReadByDriversOfDatagramsAlone) {
  LineSettings line;
  line.port = "udp:3333";
  line.driver = "tuio";
  EXPECT_TRUE(validate(line).empty());
  line.driver = "spaceball";
  ASSERT_EQ(validate(line).size(), 1u);
  EXPECT_EQ(
      validate(line)[0].what,
      "is \"udp:3333\", a port for datagrams, which the driver \"spaceball\" does not read; the "
      "drivers \"tuio\" and \"osc\" do");
}

// Returns a UDP port that the system has just assigned to a socket that is closed again.
std::string freePort() {
  const UniqueFd probe(::socket(AF_INET, SOCK_DGRAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (::bind(probe.get(), reinterpret_cast<sockaddr*>(&address), size) != 0) return "";
  ::getsockname(probe.get(), reinterpret_cast<sockaddr*>(&address), &size);
  return std::to_string(ntohs(address.sin_port));
}

void send(const std::string& port, std::string_view bytes) {
  const UniqueFd socket(::socket(AF_INET, SOCK_DGRAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(port)));
  EXPECT_EQ(::sendto(socket.get(), bytes.data(), bytes.size(), 0,
                     reinterpret_cast<sockaddr*>(&address), sizeof address),
            static_cast<ssize_t>(bytes.size()));
}

TEST(UdpPort, PassesOnWholeDatagramsInPiecesAndIsTakenByOneProgramOnly) {
  const std::string port = freePort();
  const auto address = parsePort("udp:" + port);
  ASSERT_TRUE(address);
  auto stream = io::openPort(*address, 0);
  ASSERT_TRUE(stream) << stream.error().what;
  const auto second = io::openPort(*address, 0);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kBusy);
  EXPECT_EQ(second.error().what, "udp://127.0.0.1:" + port +
                                     ": another device of this configuration, or another program, "
                                     "receives at this port; give each its own");
  send(port, "first");
  send(port, "");
  send(port, std::string(3000, 'y'));
  DatagramParser parser;
  std::vector<Got> got;
  std::array<std::byte, 100> buffer{};
  for (int i = 0; i < 100 && got.size() < 2; ++i) {
    const auto n = (*stream)->read(buffer, std::chrono::seconds(5));
    if (!n) continue;  // the empty datagram
    for (const Got& d : parse(parser, {reinterpret_cast<const char*>(buffer.data()), *n}))
      got.push_back(d);
  }
  ASSERT_EQ(got.size(), 2u);
  EXPECT_EQ(got[0].bytes, "first");
  EXPECT_EQ(got[1].bytes, std::string(3000, 'y'));
  EXPECT_NE(got[0].sender, got[1].sender);  // two sockets on two ports
  EXPECT_EQ(parser.badBytes(), 0u);
  EXPECT_FALSE((*stream)->write(buffer, std::chrono::seconds(1)));
  (*stream)->interrupt();
  EXPECT_EQ((*stream)->read(buffer, std::chrono::seconds(5)).error().code, Errc::kClosed);
}

TEST(UdpPort, AnAddressThatIsNotThisMachinesIsSaidToBe) {
  const auto stream = io::openPort({PortKind::kUdp, "192.0.2.1", "3333"}, 0);
  ASSERT_FALSE(stream);
  EXPECT_EQ(stream.error().what, "udp://192.0.2.1:3333: this machine does not have this address");
}

// Writes as text the messages that it receives.
struct Lines final : OscSink {
  void take(const OscMessage& message) noexcept override {
    text += message.address;
    for (const OscArgument& a : message.arguments) {
      switch (a.kind) {
        case OscArgument::kInteger: text += " i" + std::to_string(a.integer); break;
        case OscArgument::kReal: text += " r" + std::to_string(a.number); break;
        case OscArgument::kText: text += " t" + std::string(a.text); break;
        case OscArgument::kOther: text += " ?"; break;
      }
    }
    text += "\n";
  }
  std::string text;
};

std::string read(std::string_view packet) {
  OscReader reader;
  Lines lines;
  return reader.read(std::as_bytes(std::span(packet)), lines) ? lines.text
                                                              : "malformed: " + lines.text;
}

TEST(OscPacket, MessagesOfNestedBundlesComeInTheirOrder) {
  EXPECT_EQ(read(oscMessage("/a", {1, 2.5F, std::string("x"), -0.25})),
            "/a i1 r2.500000 tx r-0.250000\n");
  EXPECT_EQ(read(oscBundle({oscMessage("/a", {}), oscBundle({oscMessage("/b", {-7})}),
                            oscMessage("/c", {std::string("")})})),
            "/a\n/b i-7\n/c t\n");
  EXPECT_EQ(read(oscBundle({})), "");
  EXPECT_EQ(read(oscText("/a") + oscText(",hI") + oscWord(0) + oscWord(3)), "/a ? ?\n");
}

TEST(OscPacket, OfADatagramThatIsMalformedAnywhereNothingIsTaken) {
  const std::string good = oscMessage("/a", {1}), bundle = oscBundle({good, good});
  for (std::size_t n = 0; n < bundle.size(); ++n) {
    const bool one = n == 16 || n == 16 + 4 + good.size();  // cut between two elements
    EXPECT_EQ(read(bundle.substr(0, n)).starts_with("malformed"), !one) << n;
    if (!one) {
      EXPECT_EQ(read(bundle.substr(0, n)), "malformed: ") << n;
    }
  }
  EXPECT_EQ(read(oscBundle({good, "/no tags"})), "malformed: ");
  EXPECT_EQ(read(oscBundle({"#bun"})), "malformed: ");
  EXPECT_EQ(read("#bun"), "malformed: ");
}

// oscpack adds 4 to the size in 32-bit arithmetic; with a size of 0xFFFFFFFC, it would read the
// same element for ever.
TEST(OscPacket, AnElementThatReachesBeyondItsBundleIsMalformed) {
  const std::string head = oscText("#bundle") + oscWord(0) + oscWord(0);
  const std::string good = oscMessage("/a", {1});
  for (const std::uint32_t size :
       {0xFFFFFFFCU, 0xFFFFFFF8U, 0x80000000U, 0x7FFFFFFFU, 0x7FFFFFFCU, 8U, 3U, 1U, 0U}) {
    const std::string bundle = head + oscWord(size) + "abcd";
    EXPECT_EQ(read(bundle), "malformed: ") << size;
    EXPECT_EQ(read(oscBundle({good, bundle})), "malformed: ") << size;
    // The inner bundle's element reaches beyond the inner bundle, but not beyond the outer one.
    EXPECT_EQ(read(oscBundle({oscBundle({bundle}), good, good})), "malformed: ") << size;
  }
}

// oscpack itself detects this damage, in messages that end where the datagram does.
TEST(OscPacket, MessagesWithoutAnEndAreMalformed) {
  for (const std::string& packet :
       {std::string("/abc"), oscText("/a") + ",iii", oscText("/a") + oscText(",s") + "text",
        oscText("/a") + oscText(",s"), oscText("/a") + oscText(",d") + oscWord(1),
        oscText("/a") + oscText(",[i") + oscWord(1), oscText("/a") + oscText(",Q")}) {
    EXPECT_EQ(read(packet), "malformed: ") << packet;
    EXPECT_EQ(read(oscBundle({packet, oscMessage("/b", {1})})), "malformed: ") << packet;
  }
}

// oscpack does not check the length of a blob: reading beyond it would crash the program.
TEST(OscPacket, AMessageWithABlobIsPassedOver) {
  for (const std::uint32_t length : {3U, 0x7FFFFFFFU, 0xFFFFFFF0U, 0xFFFFFFFFU}) {
    const std::string blobs = oscText("/a") + oscText(",bbi") + oscWord(length) + oscText("xyz");
    EXPECT_EQ(read(blobs), "") << length;
    EXPECT_EQ(read(oscBundle({blobs, oscMessage("/b", {1})})), "/b i1\n") << length;
  }
  // For oscpack, this address ends later than at its first zero.
  const std::string odd("/\0ab/xy\0,bb\0\xFF\xFF\xFF\xF0", 16);
  EXPECT_EQ(read(odd), "");
}

TEST(OscPacket, NestingAndArgumentsHaveLimits) {
  std::string nested = oscMessage("/a", {1});
  for (int i = 0; i < OscReader::kDeepest; ++i) nested = oscBundle({nested});
  EXPECT_EQ(read(nested), "/a i1\n");
  EXPECT_EQ(read(oscBundle({nested})), "malformed: ");
  const std::vector<test::OscValue> most(OscReader::kMostArguments, 1);
  EXPECT_TRUE(read(oscMessage("/a", most)).starts_with("/a i1"));
  auto more = most;
  more.push_back(1);
  EXPECT_EQ(read(oscMessage("/a", more)), "malformed: ");
  EXPECT_EQ(read(oscMessage("/a", {std::string(65507, 'x')})), "malformed: ");
}

TEST(OscPacket, DamagedDatagramsHarmNothing) {
  const std::string good = oscBundle({oscMessage("/tuio/2Dcur", {std::string("set"), 1, 0.5F}),
                                      oscBundle({oscMessage("/b", {2.0, std::string("text")})})});
  int whole = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int value = 0; value < 256; ++value) {
      std::string bytes = good;
      bytes[i] = static_cast<char>(value);
      whole += read(bytes).starts_with("malformed") ? 0 : 1;
    }
  }
  EXPECT_GT(whole, 1000);
  Random random(3);
  for (int i = 0; i < 20'000; ++i) {
    std::string noise(4 * random.below(20), '\0');
    for (char& c : noise) c = static_cast<char>(random.below(4) ? 0 : random.next());
    (void)read(random.below(2) ? oscText("#bundle") + noise : noise);
  }
}

}  // namespace
}  // namespace merlin
