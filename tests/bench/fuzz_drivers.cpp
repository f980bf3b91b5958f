#include "tests/bench/fuzz_drivers.h"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include <linux/input-event-codes.h>

#include "drivers/evdev/device.h"
#include "drivers/port/plausible.h"
#include "drivers/spacenav/device.h"
#include "drivers/touch/device.h"
#include "drivers/vrpn/catalog.h"
#include "drivers/vrpn/device.h"
#include "drivers/vrpn/pad_device.h"
#include "tests/support/evdev_records.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/vrpn_messages.h"

namespace merlin::bench {
namespace {

using test::evdevRecord;

class JudgingSink final : public SampleSink {
 public:
  explicit JudgingSink(const char* driver) : driver_(driver) {}
  void publish(const GloveSample& s) noexcept override { judge(s); }
  void publish(const TrackerSample& s) noexcept override { judge(s); }
  void publish(const BallSample& s) noexcept override { judge(s); }
  void publish(const TouchSample& s) noexcept override { judge(s); }
  std::uint64_t samples() const noexcept { return samples_; }

 private:
  template <typename Sample>
  void judge(const Sample& sample) noexcept {
    ++samples_;
    if (plausible(sample)) return;
    std::fprintf(stderr, "the driver %s published a sample that is not plausible\n", driver_);
    std::abort();
  }

  const char* driver_;
  std::uint64_t samples_ = 0;
};

// A connection is restarted after this number of pieces, since damage may change what all later
// bytes mean. In VRPN one wrong length does that, since its messages have no marks at which they
// begin.
constexpr std::uint64_t kPieces = 64, kVrpnPieces = 8;

// A driver and its line. The line is connected again when the driver has given up, and after a
// number of pieces.
class FuzzedDriver {
 public:
  using Make = std::unique_ptr<Device> (*)(const Clock&, SampleSink&);

  // `hello`: the bytes that the other end sends when it is connected.
  FuzzedDriver(const char* name, Make make, std::string hello, std::uint64_t most_pieces)
      : sink_(name),
        device_(make(clock_, sink_)),
        hello_(std::move(hello)),
        most_pieces_(most_pieces) {}

  // Feeds the piece to the driver; returns how many samples it published.
  std::uint64_t take(const std::string& piece) {
    clock_.advance(std::chrono::milliseconds(1));
    if (!works_ || ++pieces_ % most_pieces_ == 0) connect();
    const std::uint64_t before = sink_.samples();
    if (works_) line_->feed(piece);
    while (works_ && line_->pending()) works_ = device_->poll(*line_).ok();
    return sink_.samples() - before;
  }

 private:
  void connect() {
    line_.emplace(clock_, nullptr);
    line_->feed(hello_);
    works_ = device_->open(*line_).ok();
  }

  test::FakeClock clock_;
  JudgingSink sink_;
  std::unique_ptr<Device> device_;
  std::optional<test::FakeStream> line_;
  std::string hello_;
  std::uint64_t most_pieces_, pieces_ = 0;
  bool works_ = false;
};

FuzzFeed driverFeed(const char* name, FuzzedDriver::Make make, std::string hello,
                    std::uint64_t most_pieces = kPieces) {
  const auto driver = std::make_shared<FuzzedDriver>(name, make, std::move(hello), most_pieces);
  return [driver](const std::string& piece) { return driver->take(piece); };
}

std::int32_t anyInt(Random& r) { return static_cast<std::int32_t>(r.next()); }

// Returns a position that is sometimes outside its range of 0 to 1000.
std::int32_t anyPlace(Random& r) { return static_cast<std::int32_t>(r.below(1100)) - 50; }

FuzzFeed gamepadFeed() {
  std::string hello = test::evdevNamed(EvdevRecord::kName, 0, "pad");
  for (const int code : {ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ, ABS_HAT0X, ABS_HAT0Y})
    hello += evdevRecord(EvdevRecord::kAxis, code, 0, -1000, 1000);
  hello += evdevRecord(EvdevRecord::kRelative, REL_DIAL);
  for (int code = BTN_SOUTH; code <= BTN_THUMBR; ++code)
    hello += test::evdevNamed(EvdevRecord::kKey, code, "A");
  return driverFeed(
      "evdev",
      [](const Clock& c, SampleSink& k) { return evdev::makeDevice(EvdevSettings{}, c, k); },
      hello + evdevRecord(EvdevRecord::kReady));
}

std::string gamepadReport(Random& r) {
  const auto code = [&](int first, std::uint64_t count) {
    return first + static_cast<int>(r.below(count));
  };
  return evdevRecord(EvdevRecord::kMoved, code(ABS_X, ABS_HAT0Y + 1), anyInt(r)) +
         evdevRecord(EvdevRecord::kPressed, code(BTN_SOUTH, 15), code(0, 3)) +
         evdevRecord(EvdevRecord::kReport);
}

FuzzFeed touchFeed(const std::string& hello) {
  return driverFeed(
      "touch",
      [](const Clock& c, SampleSink& k) { return touch::makeDevice(TouchSettings{}, c, k); },
      hello + evdevRecord(EvdevRecord::kReady));
}

FuzzFeed frameFeed() {
  return touchFeed(evdevRecord(EvdevRecord::kAxis, ABS_MT_SLOT, 0, 0, 9) +
                   evdevRecord(EvdevRecord::kAxis, ABS_MT_TRACKING_ID, 0, 0, 65535) +
                   evdevRecord(EvdevRecord::kAxis, ABS_MT_POSITION_X, 0, 0, 1000) +
                   evdevRecord(EvdevRecord::kAxis, ABS_MT_POSITION_Y, 0, 0, 1000));
}

std::string frameReport(Random& r) {
  const auto slot = static_cast<std::int32_t>(r.below(12));  // two more slots than the device has
  const auto finger = r.below(4) == 0 ? -1 : static_cast<std::int32_t>(r.below(65536));
  return evdevRecord(EvdevRecord::kMoved, ABS_MT_SLOT, slot) +
         evdevRecord(EvdevRecord::kMoved, ABS_MT_TRACKING_ID, finger) +
         evdevRecord(EvdevRecord::kMoved, ABS_MT_POSITION_X, anyPlace(r)) +
         evdevRecord(EvdevRecord::kMoved, ABS_MT_POSITION_Y, anyPlace(r)) +
         evdevRecord(EvdevRecord::kReport);
}

FuzzFeed mouseFeed() {
  return touchFeed(evdevRecord(EvdevRecord::kRelative, REL_X) +
                   evdevRecord(EvdevRecord::kRelative, REL_Y) +
                   evdevRecord(EvdevRecord::kRelative, REL_WHEEL) +
                   test::evdevNamed(EvdevRecord::kKey, BTN_LEFT, "LEFT"));
}

std::string mouseReport(Random& r) {
  constexpr int kWays[] = {REL_X, REL_Y, REL_WHEEL};
  return evdevRecord(EvdevRecord::kShifted, kWays[r.below(3)], anyInt(r)) +
         evdevRecord(EvdevRecord::kPressed, BTN_LEFT + static_cast<int>(r.below(8)),
                     static_cast<std::int32_t>(r.below(2))) +
         evdevRecord(EvdevRecord::kReport);
}

// The numbers with which the emulated VRPN server describes its device and its types.
enum ServerNumbers : std::int32_t { kDevice = 1, kPoses = 2, kButton = 3, kButtons = 4, kChannels };

std::string serverHello(std::string_view device) {
  return vrpnCookie() + test::vrpnSender(kDevice, device) + test::vrpnType(kPoses, kVrpnPoseType) +
         test::vrpnType(kButton, kVrpnButtonType) + test::vrpnType(kButtons, kVrpnButtonsType) +
         test::vrpnType(kChannels, kVrpnChannelsType);
}

std::string poseMessage(std::int32_t sensor, float x) {
  constexpr float kTurn[] = {0.8F, 0, 0.6F, 0};
  const float place[] = {x, 1, -x};
  return test::vrpnMessage(kDevice, kPoses, vrpnPose(sensor, place, kTurn));
}

FuzzFeed poseFeed() {
  return driverFeed(
      "vrpn", [](const Clock& c, SampleSink& k) { return vrpn::makeDevice(VrpnSettings{}, c, k); },
      serverHello(VrpnSettings{}.device) + poseMessage(0, 0), kVrpnPieces);
}

std::string anyPose(Random& r) {
  return poseMessage(static_cast<std::int32_t>(r.below(4)), static_cast<float>(r.uniform(-30, 30)));
}

FuzzFeed padFeed() {
  return driverFeed(
      "vrpn_pad",
      [](const Clock& c, SampleSink& k) { return vrpn::makeDevice(VrpnPadSettings{}, c, k); },
      serverHello(VrpnPadSettings{}.device), kVrpnPieces);
}

std::string padMessage(Random& r) {
  const auto small = [&](std::uint64_t count) { return static_cast<std::int32_t>(r.below(count)); };
  switch (r.below(3)) {
    case 0: return test::vrpnMessage(kDevice, kButton, vrpnButton(small(300), r.below(2) == 0));
    case 1:
      return test::vrpnMessage(kDevice, kButtons,
                               vrpnButtons(static_cast<std::uint32_t>(r.next()), small(33)));
    default: {
      const double channels[] = {r.uniform(-2, 2), 1e308, r.uniform(-2, 2), -1e308};
      return test::vrpnMessage(kDevice, kChannels, vrpnChannels(channels));
    }
  }
}

// Feeds the catalogue that `merlin devices` makes of a server; a piece counts if the server's
// devices are still known after it.
FuzzFeed catalogFeed() {
  const auto catalog = std::make_shared<std::optional<vrpn::Catalog>>();
  return [catalog, pieces = std::uint64_t{0}](const std::string& piece) mutable -> std::uint64_t {
    if (!*catalog || ++pieces % kPieces == 0) (void)catalog->emplace().take(serverHello("Wand0"));
    if (!(*catalog)->take(piece)) {
      catalog->reset();
      return 0;
    }
    return (*catalog)->devices().empty() ? 0 : 1;
  };
}

std::string anyDescription(Random& r) {
  const std::string name(1 + r.below(120), static_cast<char>('a' + r.below(26)));
  return r.below(2) ? test::vrpnSender(anyInt(r), name) : anyPose(r);
}

FuzzFeed spaceMouseFeed() {
  constexpr std::int32_t kShort = 5;  // length of the name [bytes]
  spacenav::Frame name{spacenav::kDeviceName, 0x73756F6D, 0x65, 0, 0, 0, 0, kShort};
  return driverFeed(
      "spacenav",
      [](const Clock& c, SampleSink& k) { return spacenav::makeDevice(SpacenavSettings{}, c, k); },
      spacenav::encodeWord(spacenav::kHello) + spacenav::encode(name));
}

std::string spaceMouseFrame(Random& r) {
  spacenav::Frame frame{};
  for (std::int32_t& word : frame) word = anyInt(r);
  frame[0] = static_cast<std::int32_t>(r.below(4));
  if (frame[0] == spacenav::kPress || frame[0] == spacenav::kRelease)
    frame[1] = static_cast<std::int32_t>(r.below(14));
  return spacenav::encode(frame);
}

const FuzzTarget kDrivers[] = {
    {"driver evdev", gamepadFeed, gamepadReport},
    {"driver touch", frameFeed, frameReport},
    {"driver touch, mouse", mouseFeed, mouseReport},
    {"driver vrpn", poseFeed, anyPose},
    {"driver vrpn_pad", padFeed, padMessage},
    {"vrpn catalog", catalogFeed, anyDescription},
    {"driver spacenav", spaceMouseFeed, spaceMouseFrame},
};

}  // namespace

std::span<const FuzzTarget> fuzzedDrivers() { return kDrivers; }

}  // namespace merlin::bench
