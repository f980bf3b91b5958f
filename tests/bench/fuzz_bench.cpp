// ./dev bench fuzz: sends random and mutated bytes through every parser and driver, in a build with
// AddressSanitizer and UBSan, which end the program at a fault. Prints how many packets each parser
// recovered.
//
// Half of the bytes are random. The other half is a valid stream with occasional damage: a byte is
// flipped, lost, doubled or replaced by a burst, or four bytes are replaced by an extreme length.
// The damage therefore reaches parsers in the middle of a message.
#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "daemon/base/random.h"
#include "daemon/base/sanitizer.h"
#include "drivers/cyberglove/calibration_files.h"
#include "drivers/cyberglove/protocol.h"
#include "drivers/cyberglove/text.h"
#include "drivers/emulate/emulator.h"
#include "drivers/fastrak/protocol.h"
#include "drivers/io/transcript.h"
#include "drivers/osc/poses.h"
#include "drivers/port/datagram_line.h"
#include "drivers/port/evdev_line.h"
#include "drivers/port/osc_packet.h"
#include "drivers/sample/protocol.h"
#include "drivers/spaceball/protocol.h"
#include "drivers/spacenav/protocol.h"
#include "drivers/tuio/sources.h"
#include "drivers/vrpn/protocol.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/bench/fuzz_drivers.h"
#include "tests/support/extreme_length.h"
#include "tests/support/osc_packets.h"

namespace merlin::bench {
namespace {

using Feed = FuzzFeed;

std::int16_t anyShort(Random& r) { return static_cast<std::int16_t>(r.next()); }

template <typename Parser>
Feed each(std::shared_ptr<Parser> parser) {
  return [parser](const std::string& bytes) {
    std::uint64_t packets = 0;
    for (const char c : bytes) packets += parser->feed(static_cast<std::byte>(c)) ? 1U : 0U;
    return packets;
  };
}

Feed trackerFeed(const fastrak::Layout& layout) {
  auto parser = std::make_shared<fastrak::Parser>();
  parser->expect(layout);
  return [parser](const std::string& bytes) {
    std::uint64_t packets = 0;
    for (const char c : bytes) packets += parser->feed(static_cast<std::byte>(c), 1) ? 1U : 0U;
    return packets;
  };
}

constexpr cyberglove::Layout kGloveText{
    .values = 22, .timestamp = true, .status = true, .text = true};

std::string gloveRecord(Random& r) {
  cyberglove::Record record;
  for (auto& v : record.values) v = static_cast<std::uint8_t>(1 + r.below(255));
  record.too_fast = r.below(9) == 0;
  return cyberglove::encode(record, {});
}

fastrak::Record trackerRecord(Random& r) {
  fastrak::Record record;
  record.station = 1 + static_cast<int>(r.below(4));
  for (auto& v : record.position) v = static_cast<float>(r.uniform(-300, 300));
  return record;
}

std::string ballPacket(Random& r) {
  spaceball::Displacement d;
  for (auto& axis : d.axes) axis = anyShort(r);
  d.period = static_cast<std::uint16_t>(r.next());
  if (r.below(4) > 0) return spaceball::encode(d);
  return spaceball::encodeKeys(static_cast<std::uint32_t>(r.next()), spaceball::Model::k4000);
}

std::string textRecord(Random& r) {
  sample::Record record;
  for (auto& axis : record.axes) axis = static_cast<int>(r.below(2001)) - 1000;
  return sample::encode(record);
}

std::string spacenavFrame(Random& r) {
  spacenav::Frame frame{};
  for (std::int32_t& word : frame) word = anyShort(r);
  frame[0] = static_cast<std::int32_t>(r.below(7));
  return spacenav::encode(frame);
}

std::string evdevRecord(Random& r) {
  EvdevRecord record;
  record.kind = static_cast<EvdevRecord::Kind>(1 + r.below(9));
  record.code = static_cast<std::uint16_t>(r.below(768));
  record.value = anyShort(r);
  std::string bytes;
  append(record, bytes);
  return bytes;
}

std::string vrpnMessage(Random& r) {
  VrpnHeader header;
  header.sender = anyShort(r);
  header.type = anyShort(r);
  std::string bytes;
  appendVrpn(header, std::string(r.below(300), 'x'), bytes);
  return bytes;
}

// A VRPN stream has no marks by which a reader finds the beginning of a message, so the driver
// closes a connection with a fault. Here a new connection begins with the next piece after a fault,
// and with every sixteenth piece.
Feed vrpnFeed() {
  auto parser = std::make_shared<vrpn::Parser>();
  return [parser, pieces = 0](const std::string& bytes) mutable {
    if (parser->broken() || ++pieces % 16 == 0) parser->reset();
    std::uint64_t packets = 0;
    for (const char c : bytes) {
      const auto message = parser->feed(static_cast<std::byte>(c));
      packets += message ? 1U : 0U;
      if (!message) continue;
      const std::string_view payload = message->payload;
      (void)(readVrpnName(payload) || readVrpnPose(payload) || readVrpnButton(payload) ||
             readVrpnButtons(payload) || readVrpnChannels(payload));
    }
    return packets;
  };
}

// Reads the datagrams of a line; a datagram counts as a packet if `taken` returns true.
template <typename Sink>
Feed datagramFeed(std::shared_ptr<Sink> sink,
                  std::function<bool(Sink&, OscReader&, const Datagram&)> taken) {
  auto parser = std::make_shared<DatagramParser>();
  auto reader = std::make_shared<OscReader>();
  return [=](const std::string& bytes) {
    std::uint64_t packets = 0;
    for (const char c : bytes) {
      const auto datagram = parser->feed(static_cast<std::byte>(c));
      if (datagram) packets += taken(*sink, *reader, *datagram) ? 1U : 0U;
    }
    return packets;
  };
}

Feed tuioFeed() {
  return datagramFeed<tuio::Sources>(
      std::make_shared<tuio::Sources>(),
      [](tuio::Sources& sources, OscReader& reader, const Datagram& d) {
        sources.clear();
        sources.begin(d.sender, {});
        return reader.read(d.bytes, sources) && sources.complete();
      });
}

std::string tuioFrame(Random& r) {
  const auto contact = [&] {
    return test::TuioContact{static_cast<int>(r.below(100)), static_cast<float>(r.uniform()),
                             static_cast<float>(r.uniform())};
  };
  const auto frame = static_cast<int>(r.below(1000));
  return test::datagram(r.below(2) ? test::tuioCursors(frame, {contact()}, {1000, 1001}, "a@b")
                                   : test::tuioObject(frame, contact()));
}

struct NoSamples final : SampleSink {
  void publish(const GloveSample&) noexcept override {}
  void publish(const TrackerSample&) noexcept override {}
  void publish(const BallSample&) noexcept override {}
  void publish(const TouchSample&) noexcept override {}
};

Feed oscFeed() {
  static NoSamples nowhere;
  return datagramFeed<osc::Poses>(std::make_shared<osc::Poses>(OscSettings{}, nowhere),
                                  [](osc::Poses& poses, OscReader& reader, const Datagram& d) {
                                    const std::uint64_t before = poses.samples();
                                    (void)reader.read(d.bytes, poses);
                                    return poses.samples() > before;
                                  });
}

std::string oscPose(Random& r) {
  const auto place = [&] { return static_cast<float>(r.uniform(-3, 3)); };
  return test::datagram(test::oscMessage(fmt::format("/tracker/{}/pose", 1 + r.below(4)),
                                         {place(), place(), place(), 0.0F, 0.6F, 0.0F, 0.8F}));
}

std::string transcriptLine(Random& r) {
  return fmt::format("# device: x # serial: 9600\n@{:.6f} {}{:04x} <- note\n# end\n", r.uniform(),
                     r.below(2) ? "to " : "", r.below(65536));
}

const FuzzTarget kParsers[] = {
    {"cyberglove", [] { return each(std::make_shared<cyberglove::Parser>()); }, gloveRecord},
    {"cyberglove stamped",
     [] {
       auto parser = std::make_shared<cyberglove::Parser>();
       parser->expect({.values = 18, .timestamp = true, .status = true});
       return each(parser);
     },
     [](Random& r) {
       cyberglove::Record record;
       record.timestamp = static_cast<std::uint32_t>(r.next());
       return cyberglove::encode(record, {.values = 18, .timestamp = true, .status = true});
     }},
    {"cyberglove text",
     [] {
       auto parser = std::make_shared<cyberglove::Parser>();
       parser->expect(kGloveText);
       return each(parser);
     },
     [](Random& r) {
       cyberglove::Record record;
       for (auto& v : record.values) v = static_cast<std::uint8_t>(1 + r.below(255));
       record.unplugged = r.below(9) == 0;
       return cyberglove::encode(record, kGloveText);
     }},
    {"cyberglove answers",
     []() -> Feed {
       return [](const std::string& bytes) -> std::uint64_t {
         return cyberglove::ofText(bytes) ? 1U : 0U;
       };
     },
     [](Random& r) {
       std::string mask("?T");
       for (int i = 0; i < 4; ++i) mask += static_cast<char>(r.next());
       return cyberglove::asText(mask) + "\r\n";
     }},
    {"fastrak", [] { return trackerFeed({}); },
     [](Random& r) { return fastrak::encode(trackerRecord(r), fastrak::kDriverList, {}); }},
    {"fastrak decimals", [] { return trackerFeed({.numbers = fastrak::Layout::Numbers::kText}); },
     [](Random& r) {
       return fastrak::encode(trackerRecord(r), fastrak::kDriverList, {.binary = false});
     }},
    {"fastrak 14-bit",
     [] { return trackerFeed({.numbers = fastrak::Layout::Numbers::kShort, .angles = true}); },
     [](Random& r) {
       constexpr std::array<int, 3> kItems = {18, 19, 0};
       return fastrak::encode(trackerRecord(r), kItems, {});
     }},
    {"fastrak replies",
     []() -> Feed {
       return [](const std::string& bytes) -> std::uint64_t {
         return (fastrak::parseStatus(bytes) ? 1U : 0U) + (fastrak::parseStations(bytes) ? 1U : 0U);
       };
     },
     [](Random& r) {
       if (r.below(2)) return fastrak::encode(fastrak::Stations{true, false, true, false}, 1);
       return fastrak::encode(fastrak::Status{});
     }},
    {"spaceball", [] { return each(std::make_shared<spaceball::Parser>()); }, ballPacket},
    {"spacenav", [] { return each(std::make_shared<spacenav::Parser>()); }, spacenavFrame},
    {"evdev", [] { return each(std::make_shared<EvdevParser>()); }, evdevRecord},
    {"vrpn", vrpnFeed, vrpnMessage},
    {"tuio", tuioFeed, tuioFrame},
    {"osc", oscFeed, oscPose},
    {"sample", [] { return each(std::make_shared<sample::Parser>()); }, textRecord},
    {"calibration files",
     []() -> Feed {
       return [](const std::string& bytes) -> std::uint64_t {
         return cyberglove::importCalibration(bytes) ? 1U : 0U;
       };
     },
     [](Random& r) {
       std::string text;
       for (int i = 0; i < 23; ++i)
         text += fmt::format("{} {} {}\n", 40 + r.below(60), 20 + r.below(20), 150 + r.below(100));
       return text;
     }},
    {"transcript",
     []() -> Feed {
       return [](const std::string& bytes) -> std::uint64_t {
         return io::parseTranscript(bytes) ? 1U : 0U;
       };
     },
     transcriptLine},
};

// Returns the packet, sometimes damaged.
std::string mutated(std::string bytes, Random& r) {
  if (bytes.empty()) return bytes;
  const std::size_t at = r.below(bytes.size());
  switch (r.below(10)) {
    case 0: bytes[at] = static_cast<char>(bytes[at] ^ 1 << r.below(8)); break;
    case 1: bytes.erase(at, 1); break;
    case 2: bytes.insert(at, 1, bytes[at]); break;
    case 3:
      for (std::uint64_t i = r.below(40); i > 0; --i)
        bytes.insert(at, 1, static_cast<char>(r.next()));
      break;
    case 4: test::writeExtremeLength(bytes, at, r); break;
    default: break;
  }
  return bytes;
}

struct Count {
  std::uint64_t bytes = 0, sent = 0, recovered = 0, from_noise = 0;
};

// Fuzzes one target. Packets that are recovered beyond those sent undamaged are chance: random
// bytes that form a packet.
void fuzz(const FuzzTarget& target, double most, std::uint64_t seed, Report& report) {
  note(fmt::format("{} ...", target.name));
  Random random(seed);
  const auto start = std::chrono::steady_clock::now();
  Count count;
  Feed feed = target.make();
  while (static_cast<double>(count.bytes) < most / 2) {
    const std::string bytes = mutated(target.packet(random), random);
    count.bytes += bytes.size();
    ++count.sent;
    count.recovered += feed(bytes);
  }
  feed = target.make();
  std::string noise(64, '\0');
  while (static_cast<double>(count.bytes) < most) {
    for (char& c : noise) c = static_cast<char>(random.next());
    count.bytes += noise.size();
    count.from_noise += feed(noise);
  }
  const double took =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (count.sent > 0 && count.recovered == 0) {
    throw DidNotRun(fmt::format("the parser of {} recovered none of {} packets; --bytes gives more",
                                target.name, count.sent));
  }
  const auto recovered =
      Measured::of(static_cast<double>(count.recovered) / static_cast<double>(count.sent),
                   count.sent, fmt::format("packets for {}", target.name));
  report.text(
      "{:20} {:12} bytes, {:9} packets sent, {:9} recovered ({:.1f} %), {:6} out of noise, "
      "{:.1f} s\n",
      target.name, count.bytes, count.sent, count.recovered, 100 * recovered, count.from_noise,
      took);
  report.figure(fmt::format("{}.recovered", target.name), recovered, "1");
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  double bytes = 1e8;
  std::uint64_t seed = 1;
  merlin::bench::CommandLine app("Gives random and mutated bytes to every parser.");
  app.option("--bytes", bytes, "Number of bytes for each parser").range(1.0, 1e15).showDefault();
  app.option("--seed", seed, "Seed of the bytes").showDefault();
  return app.run("fuzz", argc, argv, [&](merlin::bench::Report& report) {
#ifndef MERLIN_ADDRESS_SANITIZER
    report.text("(without sanitizers: only a crash would show)\n");
#endif
    for (const auto& target : merlin::bench::kParsers)
      merlin::bench::fuzz(target, bytes, seed, report);
    for (const auto& target : merlin::bench::fuzzedDrivers())
      merlin::bench::fuzz(target, bytes, seed, report);
    return true;
  });
}
