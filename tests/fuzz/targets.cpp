#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "config/loader.h"
#include "daemon/base/commands.h"
#include "daemon/base/printable_text.h"
#include "daemon/base/unique_fd.h"
#include "daemon/json/json_tree.h"
#include "daemon/serve/spnav_protocol.h"
#include "daemon/serve/vrpn_protocol.h"
#include "daemon/state/state.h"
#include "daemon/status/command.h"
#include "drivers/cyberglove/calibration_files.h"
#include "drivers/cyberglove/protocol.h"
#include "drivers/evdev/input_device.h"
#include "drivers/fastrak/protocol.h"
#include "drivers/io/transcript.h"
#include "drivers/osc/device.h"
#include "drivers/port/plausible.h"
#include "drivers/sample/protocol.h"
#include "drivers/spaceball/calibration.h"
#include "drivers/spaceball/protocol.h"
#include "drivers/spacenav/protocol.h"
#include "drivers/touch/device.h"
#include "drivers/tuio/device.h"
#include "drivers/vrpn/catalog.h"
#include "drivers/vrpn/device.h"
#include "drivers/vrpn/pad_device.h"
#include "nn/io/data_set_file.h"
#include "nn/io/gesture_file.h"
#include "nn/io/network_file.h"
#include "nn/io/path_file.h"
#include "render/correct/io/mpcdi.h"
#include "render/image/image_file.h"
#include "render/lod/io/mrm_file.h"
#include "render/mesh/atlas/corner_coordinates.h"
#include "render/mesh/atlas/join_textures.h"
#include "render/mesh/io/gzip.h"
#include "render/mesh/io/mesh_file.h"
#include "render/mesh/weld_parts.h"
#include "render/points/io/cloud_file.h"
#include "render/range/io/grid_file.h"
#include "render/range/io/range_grid.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"

namespace merlin::fuzz {
namespace {

// Aborts unless the condition `what` holds, as it must for any bytes; libFuzzer and the test detect
// the abort.
void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: does not hold: %s\n", what);
  std::abort();
}

std::string_view textOf(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// A file in memory without a name, which contains the bytes, for functions that read files.
class MemoryFile {
 public:
  explicit MemoryFile(Bytes bytes) : fd_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    require(fd_.valid() && ::write(fd_.get(), bytes.data(), bytes.size()) ==
                               static_cast<ssize_t>(bytes.size()),
            "a file in memory");
  }
  int fd() const { return fd_.get(); }
  std::string path() const { return fmt::format("/proc/self/fd/{}", fd_.get()); }

 private:
  UniqueFd fd_;
};

template <typename Parser>
void feed(Parser parser, Bytes bytes) {
  for (const std::uint8_t byte : bytes) (void)parser.feed(std::byte{byte});
}

void cybergloveBytes(Bytes bytes) {
  feed(cyberglove::Parser(), bytes);
  cyberglove::Parser stamped;
  stamped.expect({.values = 18, .timestamp = true, .status = true});
  feed(stamped, bytes);
}

void calibrationBytes(Bytes bytes) { (void)cyberglove::importCalibration(textOf(bytes)); }

void fastrakBytes(Bytes bytes) {
  using Numbers = fastrak::Layout::Numbers;
  for (const Numbers numbers : {Numbers::kBinary, Numbers::kText, Numbers::kShort}) {
    fastrak::Parser parser;
    parser.expect({.numbers = numbers});
    for (const std::uint8_t byte : bytes) (void)parser.feed(std::byte{byte}, 1);
  }
  (void)fastrak::parseStatus(textOf(bytes));
  (void)fastrak::parseStations(textOf(bytes));
}

void spaceballBytes(Bytes bytes) {
  spaceball::Parser parser;
  for (const std::uint8_t byte : bytes) {
    const auto packet = parser.feed(std::byte{byte});
    const auto* const moved = packet ? std::get_if<spaceball::Displacement>(&*packet) : nullptr;
    if (!moved) continue;
    BallSample sample{};
    spaceball::calibrate(*moved, {}, sample);
    require(plausible(sample), "a ball's sample is plausible");
  }
}

void spacenavBytes(Bytes bytes) {
  spacenav::Parser parser;
  for (const std::uint8_t byte : bytes) {
    if (const auto frame = parser.feed(std::byte{byte})) (void)spacenav::namePiece(*frame);
  }
}

void evdevBytes(Bytes bytes) {
  EvdevParser parser;
  evdev::InputDevice device;
  bool described = false;
  BallSample sample{};
  for (const std::uint8_t byte : bytes) {
    const auto record = parser.feed(std::byte{byte});
    if (!record) continue;
    described ? device.take(*record, {}) : device.describe(*record);
    if (record->kind == EvdevRecord::kReady) {
      described = true;
      (void)device.choose({});
    }
    device.fill(sample);
    require(plausible(sample), "an input device's sample is plausible");
  }
}

void sampleBytes(Bytes bytes) { feed(sample::Parser(), bytes); }

void transcriptText(Bytes bytes) {
  const auto transcript = io::parseTranscript(textOf(bytes));
  if (!transcript) return;
  require(io::parseTranscript(io::formatTranscript(*transcript)).ok(),
          "a transcript that was read can be written and read");
}

void configurationText(Bytes bytes) {
  const LoadedSettings loaded = loadSettings(textOf(bytes), "/nowhere");
  for (const Finding& finding : loaded.findings)
    require(!finding.what.empty(), "a finding says what is wrong");
}

void commandText(Bytes bytes) {
  constexpr std::size_t kMostBytes = 4096;  // bytes of the longest request
  std::vector<status::Command> commands;
  for (const CommandInfo& info : kCommands) {
    status::Command command{std::string(info.name), std::string(info.help), nullptr, nullptr};
    if (info.argument.empty())
      command.run = [] { return Result<std::string>(std::string("{}")); };
    else
      command.run_with = [](const std::string& argument) -> Result<std::string> {
        return Error{Errc::kInvalidArgument, argument};
      };
    commands.push_back(std::move(command));
  }
  const std::string answer = status::answerTo(textOf(bytes).substr(0, kMostBytes), commands);
  require(parseJson(answer).ok(), "an answer is JSON");
}

void stateText(Bytes bytes) { (void)state::parseState(textOf(bytes), "state.json"); }

void networkText(Bytes bytes) { (void)nn::parseNetwork(textOf(bytes), "network.json"); }

void gesturesText(Bytes bytes) { (void)nn::parseGestures(textOf(bytes), "gestures.json"); }

void pathsText(Bytes bytes) { (void)nn::parsePaths(textOf(bytes), "paths.csv"); }

void recordingText(Bytes bytes) { (void)nn::parseRecording(textOf(bytes), "recording.csv"); }

void mrmFile(Bytes bytes) {
  const MemoryFile file(bytes);
  (void)render::lod::readMrmCopy(file.fd(), "model.mrm");
}

void meshFile(Bytes bytes) {
  const MemoryFile file(bytes);
  (void)render::mesh::readMeshByContent(file.path());
}

void gzipFile(Bytes bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 20;
  const auto all = render::mesh::gunzip(textOf(bytes), kMost);
  require(!all || all->size() <= kMost, "what is unpacked stays in its limit");
  const std::string beginning = render::mesh::gunzipBeginning(textOf(bytes), 100);
  require(!all || all->starts_with(beginning), "the beginning is the same");
}

// Returns a mesh made of the bytes, 28 bytes for each triangle: three indices of its 27 vertices,
// the number of its texture, then u and v of its corners as floats.
render::mesh::Mesh meshOf(Bytes bytes, std::vector<std::uint32_t>& textures) {
  constexpr std::size_t kTriangle = 28, kVertices = 27;
  render::mesh::Mesh mesh;
  std::vector<std::array<float, 2>> corners;
  render::mesh::Feature label{"label", 1, {}};
  for (std::size_t v = 0; v < kVertices; ++v) {
    mesh.positions.insert(
        mesh.positions.end(),
        {static_cast<float>(v % 3), static_cast<float>(v / 3 % 3), static_cast<float>(v / 18)});
    label.values.push_back(static_cast<float>(v / 9));
  }
  for (std::size_t at = 0; at + kTriangle <= bytes.size(); at += kTriangle) {
    const std::uint8_t* const from = bytes.data() + at;
    textures.push_back(from[3] % 4 < 3 ? from[3] % 4 : render::mesh::kNoTexture);
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.triangles.push_back(from[k] % kVertices);
      std::array<float, 2> uv{};
      std::memcpy(uv.data(), from + 4 + 8 * k, sizeof uv);
      corners.push_back(uv);
    }
  }
  mesh.features.push_back(std::move(label));
  setCornerCoordinates(mesh, corners);
  return mesh;
}

void texturedMesh(Bytes bytes) {
  namespace mesh = render::mesh;
  using render::image::Wrap;
  static const render::image::ImageFile picture{2, 3, std::vector<std::uint8_t>(18, 77), {}};
  mesh::SurfaceTextures textures{{{&picture, Wrap::kRepeat, Wrap::kMirror},
                                  {&picture, Wrap::kClamp, Wrap::kRepeat},
                                  {&picture}},
                                 {}};
  mesh::Mesh surface = meshOf(bytes, textures.of_triangle);
  const std::size_t triangles = surface.triangleCount();
  const auto joined = joinTextures(surface, textures);
  require(surface.triangleCount() == triangles, "each triangle stays");
  if (joined.width > 0) {
    require(validate(surface).ok(), "the mesh is valid");
    for (const float x : surface.find("texcoord")->values)
      require(x >= 0 && x <= 1, "coordinates lie in the atlas");
    require(render::image::decodeImage(surface.texture).ok(), "the atlas is a picture");
  }
  mesh::weldParts(surface);
  require(surface.triangleCount() == triangles, "each triangle stays, welded");
  for (const std::uint32_t v : surface.triangles)
    require(v < surface.vertexCount(), "each vertex is there");
}

void pictureFile(Bytes bytes) { (void)render::image::decodeImage(bytes); }

void mpcdiFile(Bytes bytes) {
  const auto file = render::correct::Mpcdi::open(std::as_bytes(bytes));
  if (!file) return;
  for (const auto& region : file->regions()) (void)file->measured(region.id);
}

void rangeFile(Bytes bytes) {
  (void)render::range::parseGrid(textOf(bytes));
  (void)render::range::parseRangeGrid(textOf(bytes));
}

void cloudFile(Bytes bytes) { (void)render::points::parseCloud(textOf(bytes)); }

void vrpnBytes(Bytes bytes) {
  (void)serve::readVrpnCallback(textOf(bytes));
  std::string_view input = textOf(bytes);
  for (;;) {
    const auto front = serve::readVrpn(input);
    if (front.broken || !front.message) return;
    require(front.bytes > 0, "a message takes bytes");
    const std::string_view payload = front.message->payload;
    (void)readVrpnName(payload);
    if (const auto button = readVrpnButton(payload))
      require(button->button < kVrpnButtons, "is one");
    if (const auto buttons = readVrpnButtons(payload))
      require(buttons->count <= kVrpnButtons, "no more buttons than VRPN has");
    if (const auto channels = readVrpnChannels(payload))
      require(channels->count <= kVrpnChannels, "no more channels than VRPN has");
    input.remove_prefix(front.bytes);
  }
}

// A sink that requires every sample to be plausible.
struct PlausibleSink final : SampleSink {
  void publish(const GloveSample& s) noexcept override {
    require(plausible(s), "a glove's sample");
  }
  void publish(const BallSample& s) noexcept override { require(plausible(s), "a ball's sample"); }
  void publish(const TouchSample& s) noexcept override { require(plausible(s), "a touch sample"); }
  void publish(const TrackerSample& s) noexcept override {
    require(plausible(s), "a tracker's sample");
  }
};

// Gives the bytes of a line to the whole driver, and polls the driver more often than the bytes
// need.
void driverBytes(Device& device, test::FakeClock& clock, std::string_view bytes) {
  constexpr std::size_t kPolls = 20;
  test::FakeStream stream(clock, nullptr);
  stream.feed(bytes);
  bool goes_on = device.open(stream).ok();
  for (std::size_t i = 0; goes_on && i < kPolls + bytes.size() / 256; ++i)
    goes_on = device.poll(stream).ok();
}

// Gives the bytes of a VRPN server to the tracker's driver, to the driver of buttons and analogs,
// and to the catalog of the server's devices.
void vrpnServerBytes(Bytes bytes) {
  PlausibleSink sink;
  test::FakeClock clock;
  vrpn::VrpnDevice tracker({}, clock, sink);
  driverBytes(tracker, clock, textOf(bytes));
  vrpn::VrpnPad pad({}, clock, sink);
  driverBytes(pad, clock, textOf(bytes));
  vrpn::Catalog catalog;
  (void)catalog.take(textOf(bytes));
  require(catalog.devices().size() <= vrpn::Catalog::kMostDevices, "no more than are kept");
  for (const vrpn::CatalogDevice& device : catalog.devices())
    require(!device.name.empty() && device.name.size() < 100 && isText(device.name), "a name");
}

void touchBytes(Bytes bytes) {
  PlausibleSink sink;
  test::FakeClock clock;
  touch::TouchDevice device({}, clock, sink);
  driverBytes(device, clock, textOf(bytes));
}

// Gives the bytes to the TUIO driver as one datagram.
void tuioBytes(Bytes bytes) {
  PlausibleSink sink;
  test::FakeClock clock;
  tuio::TuioDevice device({}, clock, sink);
  std::string line;
  if (!bytes.empty() && bytes.size() <= kLongestDatagram) append({1, std::as_bytes(bytes)}, line);
  driverBytes(device, clock, line + line);
}

// Gives the bytes to the OSC driver as the content of its line, which consists of records of
// datagrams.
void oscBytes(Bytes bytes) {
  PlausibleSink sink;
  test::FakeClock clock;
  osc::OscDevice device({}, clock, sink);
  driverBytes(device, clock, textOf(bytes));
}

// Gives the bytes of a client to MERLIN's own space-mouse socket.
void spnavBytes(Bytes bytes) {
  serve::SpnavClient client({});
  std::string out;
  (void)client.receive(textOf(bytes), 1000, out);
  BallSample sample{};
  sample.raw[0] = 100;
  sample.buttons = 5;
  client.sample(sample, true, out);
  require(out.size() % 4 == 0, "answers are words");
}

constexpr Target kTargets[] = {
    {"cyberglove", cybergloveBytes},
    {"calibration", calibrationBytes},
    {"fastrak", fastrakBytes},
    {"spaceball", spaceballBytes},
    {"spacenav", spacenavBytes},
    {"evdev", evdevBytes},
    {"touch", touchBytes},
    {"tuio", tuioBytes},
    {"osc", oscBytes},
    {"sample", sampleBytes},
    {"transcript", transcriptText},
    {"configuration", configurationText},
    {"command", commandText},
    {"state", stateText},
    {"network", networkText},
    {"recording", recordingText},
    {"gestures", gesturesText},
    {"paths", pathsText},
    {"mrm", mrmFile},
    {"mesh", meshFile},
    {"gzip", gzipFile},
    {"textured", texturedMesh},
    {"picture", pictureFile},
    {"mpcdi", mpcdiFile},
    {"range", rangeFile},
    {"cloud", cloudFile},
    {"vrpn", vrpnBytes},
    {"vrpn_server", vrpnServerBytes},
    {"spnav", spnavBytes},
};

}  // namespace

std::span<const Target> targets() { return kTargets; }

}  // namespace merlin::fuzz
