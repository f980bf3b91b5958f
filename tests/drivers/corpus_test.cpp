// The corpus: replays every transcript of tests/transcripts through its driver and compares the
// result with the .expect file beside it: one JSON line for each sample, then the counts of dropped
// data, and how the replay ended.
//
// corpus_test --rebuild: rewrites every .expect file, for review as a diff
// corpus_test --synthesise: rewrites the existing synthetic transcripts by means of the emulators
//
// All other combinations of models, settings and damage are generated while the test runs.
#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "drivers/io/recording_stream.h"
#include "drivers/io/replay_stream.h"
#include "drivers/registry.h"
#include "tests/support/borrowed_stream.h"
#include "tests/support/device_bench.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {
namespace {

namespace fs = std::filesystem;
const fs::path kFolder = fs::path(MERLIN_SOURCE_DIR) / "tests/transcripts";

// Parses the settings in the header of a transcript that differ from the defaults, such as
// "slot7=derived rate=50".
DriverSettings settingsOf(std::string_view text) {
  DriverSettings s;
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    const std::string key = word.substr(0, word.find('='));
    const std::string value = word.substr(std::min(word.find('=') + 1, word.size()));
    if (key == "slot7") s.cyberglove.slot7 = static_cast<Slot7Rule>(std::stoi(value));
    if (key == "rate") s.cyberglove.rate_hz = std::stod(value);
    if (key == "stamps") s.cyberglove.time_stamps = true;
    if (key == "inches") s.fastrak.centimetres = false;
    if (key == "text") s.fastrak.numbers = FastrakSettings::Numbers::kText;
    if (key == "short") s.fastrak.numbers = FastrakSettings::Numbers::kShort;
    if (key == "angles") s.fastrak.angles = true;
    if (key == "stylus") s.fastrak.stylus = true;
    if (key == "deadzone") s.spaceball.dead_zone = std::stoi(value);
    if (key == "turned") s.spaceball.axis_map = {3, -1, 2, 6, -4, 5};
  }
  return s;
}

template <typename T>
std::string list(const T& values, const char* form) {
  std::string text;
  for (const auto v : values) text += fmt::format(fmt::runtime(form), text.empty() ? "" : ",", v);
  return "[" + text + "]";
}

// Writes one JSON line for each sample: metres to 0.1 mm, radians to 1 mrad, axes to 0.001.
class Lines final : public SampleSink {
 public:
  void publish(const GloveSample& s) noexcept override {
    text += fmt::format("{{\"glove\":{},\"flags\":{},\"sensors\":{},\"raw\":{},\"rad\":{}}}\n",
                        count(s.counter), s.flags, s.sensors,
                        list(std::span(s.raw).first(23), "{}{}"), list(s.angle_rad, "{}{:.3f}"));
  }
  void publish(const TouchSample& s) noexcept override {
    text += fmt::format("{{\"touch\":{},\"fingers\":[", count(s.counter));
    for (std::size_t i = 0; i < s.fingers; ++i) {
      text += fmt::format("{}[{},{:.4f},{:.4f}]", i == 0 ? "" : ",", count(s.id[i]),
                          s.position[i][0], s.position[i][1]);
    }
    text += ']';
    if (s.buttons != 0 || count(s.wheel) != 0)
      text += fmt::format(",\"buttons\":{},\"wheel\":{}", s.buttons, count(s.wheel));
    text += "}\n";
  }
  void publish(const TrackerSample& s) noexcept override {
    text += fmt::format("{{\"tracker\":{},\"station\":{},\"error\":\"{}\",\"m\":{},\"wxyz\":{}}}\n",
                        count(s.counter), s.station, s.error, list(s.position_m, "{}{:.4f}"),
                        list(s.orientation_wxyz, "{}{:.3f}"));
  }
  void publish(const BallSample& s) noexcept override {
    text += fmt::format("{{\"ball\":{},\"buttons\":{},\"push\":{},\"twist\":{},\"raw\":{}}}\n",
                        count(s.counter), s.buttons, list(s.translation, "{}{:.3f}"),
                        list(s.rotation, "{}{:.3f}"), list(s.raw, "{}{}"));
  }
  std::string text;
  bool counts = true;  // false: counters are printed as 0, since after a reconnect they continue

 private:
  template <typename T>
  T count(T value) const {
    return counts ? value : T{0};
  }
};

const DriverEntry* driverNamed(std::string_view name) {
  for (const DriverEntry& entry : drivers()) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

std::string replayed(const io::Transcript& transcript) {
  const DriverEntry* driver = driverNamed(transcript["driver"]);
  if (!driver) return "no driver named in the header\n";
  FakeClock clock;
  Lines lines;
  io::ReplayStream stream(transcript, clock);
  const auto device = driver->make(settingsOf(transcript["settings"]), clock, lines);
  const auto opened = device->open(stream);
  std::string identity, end;
  if (opened) {
    identity = *opened;
    Result<Ok> polled = Ok{};
    while (polled) polled = device->poll(stream);
    end = polled.error().what;
  } else {
    end = opened.error().what;
  }
  std::replace(end.begin(), end.end(), '"', '\'');
  std::replace(end.begin(), end.end(), '\\', '/');
  const DeviceCounters c = device->counters();
  return lines.text +
         fmt::format(
             "{{\"identity\":\"{}\",\"dropped\":{},\"bad_bytes\":{},\"complaint\":\"{}\","
             "\"end\":\"{}\"}}\n",
             identity, c.bad_packets, c.bad_bytes, device->complaint(), end);
}

std::vector<fs::path> corpus() {
  std::vector<fs::path> files;
  if (!fs::exists(kFolder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(kFolder)) {
    if (entry.path().extension() == ".bytes") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class Corpus : public testing::TestWithParam<fs::path> {};

TEST_P(Corpus, IsReadAsExpected) {
  const auto transcript = io::readTranscript(GetParam());
  ASSERT_TRUE(transcript) << transcript.error().what;
  const bool real = GetParam().parent_path().filename() == "real";
  EXPECT_EQ((*transcript)["synthetic"].starts_with("yes"), !real)
      << "the header says where it comes from";
  fs::path expectation = GetParam();
  expectation.replace_extension(".expect");
  ASSERT_TRUE(fs::exists(expectation)) << "make it: corpus_test --rebuild";
  EXPECT_EQ(replayed(*transcript), readText(expectation)) << GetParam();
}

INSTANTIATE_TEST_SUITE_P(Files, Corpus, testing::ValuesIn(corpus()), [](const auto& file) {
  std::string name = fs::relative(file.param, kFolder).replace_extension();
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
});

// Returns the transcript of a line that is unplugged after the device has sent `bytes` bytes.
io::Transcript pulledAfter(std::size_t bytes, io::Transcript transcript) {
  std::vector<io::TranscriptChunk>& chunks = transcript.chunks;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (chunks[i].to_device) continue;
    if (bytes < chunks[i].bytes.size()) {
      chunks[i].bytes.resize(bytes);
      chunks.resize(i + (bytes > 0 ? 1 : 0));
      break;
    }
    bytes -= chunks[i].bytes.size();
  }
  return transcript;
}

std::size_t deviceBytes(const io::Transcript& transcript) {
  std::size_t bytes = 0;
  for (const io::TranscriptChunk& chunk : transcript.chunks)
    bytes += chunk.to_device ? 0 : chunk.bytes.size();
  return bytes;
}

// Opens `device` on the transcript; returns as text what it reports until the transcript ends.
std::string readBy(Device& device, const io::Transcript& transcript, FakeClock& clock,
                   Lines& lines) {
  lines.text.clear();
  io::ReplayStream stream(transcript, clock);
  const auto opened = device.open(stream);
  Result<Ok> polled = Ok{};
  while (opened && polled) polled = device.poll(stream);
  return lines.text + (opened ? *opened : opened.error().what);
}

// Returns whether the text is empty, or is one sample that releases what was held when the line was
// unplugged.
bool isRelease(const std::string& text) {
  static const std::regex release(
      R"re(\{"touch":0,"fingers":\[\]\}\n|\{"ball":0,"buttons":0,"push":\[(0.000,?){3}\],"twist":\[(0.000,?){3}\],"raw":.*\n)re");
  return text.empty() || std::regex_match(text, release);
}

// The line is unplugged in each state of the dialogue, and during streaming.
TEST_P(Corpus, IsReadAnewAfterALineThatWasPulled) {
  const auto transcript = io::readTranscript(GetParam());
  ASSERT_TRUE(transcript) << transcript.error().what;
  const DriverEntry& driver = *driverNamed((*transcript)["driver"]);
  const auto made = [&](FakeClock& clock, Lines& lines) {
    return driver.make(settingsOf((*transcript)["settings"]), clock, lines);
  };
  FakeClock clock;
  Lines lines;
  lines.counts = false;
  const std::string fresh = readBy(*made(clock, lines), *transcript, clock, lines);
  const std::size_t bytes = deviceBytes(*transcript);
  constexpr std::size_t kDialogue = 300, kStep = 3, kMore = 20;
  for (std::size_t cut = 0; cut < bytes; cut += cut < kDialogue ? kStep : bytes / kMore + 1) {
    const auto device = made(clock, lines);
    readBy(*device, pulledAfter(cut, *transcript), clock, lines);
    const std::string again = readBy(*device, *transcript, clock, lines);
    ASSERT_TRUE(again.ends_with(fresh) && isRelease(again.substr(0, again.size() - fresh.size())))
        << "pulled after byte " << cut << "\n"
        << again << "\ninstead of\n"
        << fresh;
  }
}

TEST(CorpusFolder, HasSnapshotsOfAllDevices) {
  std::map<std::string, int> count;
  for (const fs::path& file : corpus()) ++count[file.parent_path().filename()];
  for (const char* device : {"cyberglove", "fastrak", "spaceball"}) EXPECT_GE(count[device], 8);
}

int rebuild() {
  for (fs::path file : corpus()) {
    const auto transcript = io::readTranscript(file);
    if (!transcript) {
      fmt::print(stderr, "{}\n", transcript.error().what);
      return 1;
    }
    writeText(file.replace_extension(".expect"), replayed(*transcript));
  }
  fmt::print("{} expectations\n", corpus().size());
  return 0;
}

struct Tape final : ByteTap {
  explicit Tape(Timestamp from) : start(from) {}
  void opened(Timestamp) noexcept override {}
  void heard(Timestamp at, std::span<const std::byte> b) noexcept override { add(at, false, b); }
  void said(Timestamp at, std::span<const std::byte> b) noexcept override { add(at, true, b); }
  void add(Timestamp at, bool to_device, std::span<const std::byte> b) {
    const std::string bytes(reinterpret_cast<const char*>(b.data()), b.size());
    const bool more =
        !chunks.empty() && chunks.back().to_device == to_device && chunks.back().at == at - start;
    if (more) {
      chunks.back().bytes += bytes;
    } else {
      chunks.push_back({at - start, to_device, bytes});
    }
  }
  Timestamp start;
  std::vector<io::TranscriptChunk> chunks;
};

struct Case {
  std::string driver, model, script, settings, fault;
  std::uint64_t seed;
};

constexpr const char* kFaults[] = {"none",    "garbage", "flip",    "drop",  "double",
                                   "silence", "zeros",   "another", "burst", "half"};

// Damages the streamed records that follow the dialogue.
void damage(std::vector<io::TranscriptChunk>& chunks, const Case& c, Random& random) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < chunks.size(); ++i) first = chunks[i].to_device ? i + 1 : first;
  if (first + 4 >= chunks.size()) return;
  const std::size_t at = first + 2 + random.below((chunks.size() - first) / 2);
  std::string& bytes = chunks[at].bytes;
  const std::size_t byte = random.below(bytes.size());
  if (c.fault == "flip") bytes[byte] = static_cast<char>(bytes[byte] ^ 1 << random.below(8));
  if (c.fault == "drop") bytes.erase(byte, 1);
  if (c.fault == "double") bytes.insert(byte, 1, bytes[byte]);
  if (c.fault == "half") chunks.resize(at + 1), bytes.resize(byte);
  if (c.fault == "zeros") bytes.insert(byte, 40, '\0');
  if (c.fault == "another") bytes += "@1 Spaceball alive and well after a poweron reset.\r\n";
  if (c.fault == "burst") {
    for (int i = 0; i < 200; ++i) bytes.push_back(static_cast<char>(random.next()));
  }
  if (c.fault == "silence") {
    for (std::size_t i = at; i < chunks.size(); ++i) chunks[i].at += std::chrono::seconds(4);
  }
}

io::Transcript synthesised(const Case& c) {
  emulate::EmulatorSettings emulator;
  emulator.model = c.model;
  emulator.seed = c.seed;
  emulator.garbage_every = c.fault == "garbage" ? 5 : 0;
  emulator.baud = c.driver == "spaceball" ? 9600 : 38400;
  DeviceBench bench(c.driver.c_str(), emulator, c.script.c_str());
  bench.clock.advance(fromSeconds(0.001 * static_cast<double>(c.seed % 7000)));
  Tape tape(bench.clock.now());
  io::RecordingStream stream(std::make_unique<test::BorrowedStream>(bench.stream), tape,
                             bench.clock);
  const auto device = driverNamed(c.driver)->make(settingsOf(c.settings), bench.clock, bench.sink);
  const auto opened = device->open(stream);
  const Duration length = c.driver == "spaceball" ? fromSeconds(1.0) : fromSeconds(0.2);
  for (const Timestamp end = bench.clock.now() + length; opened && bench.clock.now() < end;) {
    if (!device->poll(stream)) break;
  }
  Random random(c.seed);
  damage(tape.chunks, c, random);
  return {{{"device", opened ? *opened : "none"},
           {"driver", c.driver},
           {"settings", c.settings.empty() ? "default" : c.settings},
           {"synthetic", fmt::format("yes (drivers/emulate, model {}, script {}, seed {})", c.model,
                                     c.script, c.seed)},
           {"by", "corpus_test --synthesise"},
           {"notes", "fault: " + c.fault},
           {"serial", fmt::format("{} 8N1", emulator.baud)}},
          std::move(tape.chunks)};
}

struct NamedCase {
  std::string name;
  Case what;
};

// Returns every model combined with every setting and every kind of damage.
std::vector<NamedCase> allCases() {
  struct Family {
    const char* driver;
    std::vector<const char*> models, scripts, settings;
  };
  const Family families[] = {
      {"cyberglove", {"22", "18"}, {"visit", "grabbing"}, {"", "slot7=2 rate=60", "slot7=3"}},
      {"fastrak", {"1", "2", "3", "4"}, {"turning", "still"}, {"", "inches"}},
      {"cyberglove", {"18"}, {"visit"}, {nullptr, nullptr, nullptr, "stamps"}},
      {"fastrak",
       {"2"},
       {"turning"},
       {nullptr, nullptr, "text", "short angles", "stylus", "short inches"}},
      {"spaceball",
       {"1003", "2003", "3003", "4000"},
       {"visit", "turning"},
       {"", "turned deadzone=50"}},
  };
  std::uint64_t seed = 1;
  std::vector<NamedCase> cases;
  for (const Family& f : families) {
    for (const char* model : f.models) {
      for (std::size_t s = 0; s < f.settings.size(); ++s) {
        // An entry without settings only takes part in the numbering of the cases.
        if (f.settings[s] == nullptr) continue;
        for (const char* fault : kFaults) {
          const char* script = f.scripts[seed % f.scripts.size()];
          cases.push_back({fmt::format("{}/{}-{}-{}", f.driver, model, s, fault),
                           {f.driver, model, script, f.settings[s], fault, seed}});
          ++seed;
        }
      }
    }
  }
  return cases;
}

int synthesise() {
  int count = 0;
  for (const NamedCase& c : allCases()) {
    const fs::path file = kFolder / (c.name + ".bytes");
    if (!fs::exists(file)) continue;
    writeText(file, io::formatTranscript(synthesised(c.what)));
    ++count;
  }
  fmt::print("{} transcripts\n", count);
  return 0;
}

class Generated : public testing::TestWithParam<NamedCase> {};

// Whatever is damaged, the driver must read to the end of the recording, identify the device, and
// lose no records except those around the damage.
TEST_P(Generated, LosesOnlyWhatIsDamaged) {
  Case whole = GetParam().what;
  whole.fault = "none";
  const auto samplesOf = [](const std::string& text) {
    return std::count(text.begin(), text.end(), '\n') - 1;
  };
  const std::string undamaged = replayed(synthesised(whole)),
                    damaged = replayed(synthesised(GetParam().what));
  EXPECT_NE(undamaged.find("\"dropped\":0,\"bad_bytes\":0,"), std::string::npos) << undamaged;
  EXPECT_GT(samplesOf(undamaged), 3);
  EXPECT_EQ(damaged.find("\"identity\":\"\""), std::string::npos) << damaged;
  const std::string& fault = GetParam().what.fault;
  const bool ends_early = fault == "half" || fault == "silence" || fault == "another";
  const auto least = ends_early ? 1 : samplesOf(undamaged) * 3 / 4;
  EXPECT_GE(samplesOf(damaged), least) << undamaged << "\n" << damaged;
  EXPECT_EQ(damaged, replayed(synthesised(GetParam().what))) << "the same each time";
}

INSTANTIATE_TEST_SUITE_P(Cases, Generated, testing::ValuesIn(allCases()), [](const auto& c) {
  std::string name = c.param.name;
  for (char& ch : name) ch = std::isalnum(static_cast<unsigned char>(ch)) ? ch : '_';
  return name;
});

}  // namespace
}  // namespace merlin::test

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "--synthesise") return merlin::test::synthesise();
  if (argc > 1 && std::string_view(argv[1]) == "--rebuild") return merlin::test::rebuild();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
