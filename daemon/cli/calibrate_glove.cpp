// merlin calibrate glove: guides a person through a few poses.
#include <array>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "daemon/base/files.h"
#include "daemon/cli/calibrate.h"
#include "daemon/cli/exit_status.h"
#include "drivers/cyberglove/device.h"
#include "drivers/cyberglove/guided_calibration.h"
#include "drivers/hand/hand.h"
#include "drivers/io/open_stream.h"

namespace merlin::cli {
namespace {

using cyberglove::GuidedCalibration;

struct GloveOptions {
  std::string port, output;
  int baud = 38400;
  double hold_s = 1;
  double pause_s = 0;  // 0: Enter begins a pose
};

struct Collector final : SampleSink {
  explicit Collector(GuidedCalibration& c) : calibration(c) {}
  void publish(const GloveSample& sample) noexcept override {
    if (collecting) calibration.add(sample);
  }
  void publish(const TrackerSample&) noexcept override {}
  void publish(const BallSample&) noexcept override {}
  GuidedCalibration& calibration;
  bool collecting = false;
};

// One line a sensor: its raw values from 1 to 255, with what has been seen of them.
void showSpans(const GuidedCalibration& calibration) {
  constexpr int kWidth = 51;
  const auto column = [](int raw) { return static_cast<std::size_t>(raw * (kWidth - 1) / 255); };
  for (std::size_t i = 0; i < kGloveSlots; ++i) {
    const int low = calibration.low(i), high = calibration.high(i);
    if (high == 0) continue;
    std::string bar(kWidth, '.');
    for (std::size_t at = column(low); at <= column(high); ++at) bar[at] = '#';
    fmt::print("  {:23} {} {:3} to {:3}\n", hand::kJointNames[i], bar, low, high);
  }
  std::fflush(stdout);
}

bool enterPressed() {
  pollfd item{STDIN_FILENO, POLLIN, 0};
  char line[256];
  return ::poll(&item, 1, 0) > 0 && ::read(STDIN_FILENO, line, sizeof line) >= 0;
}

// Reads the glove until `until` says so.
template <typename Until>
Result<Ok> pollUntil(Device& device, ByteStream& line, Until until) {
  while (!until()) {
    if (auto polled = device.poll(line); !polled) return polled;
  }
  return Ok{};
}

int calibrateGlove(const GloveOptions& o) {
  const auto address = io::parsePort(o.port);
  if (!address) return fail(address.error());
  if (const auto writable = checkWritable(o.output); !writable) return fail(writable.error());
  auto line = io::openPort(*address, o.baud);
  if (!line) return fail(line.error());
  const SystemClock clock;
  GuidedCalibration calibration;
  Collector collector(calibration);
  const auto device = cyberglove::makeDevice({}, clock, collector);
  const auto identity = device->open(**line);
  if (!identity) return fail(identity.error());
  fmt::print("{}\n", *identity);
  for (std::size_t pose = 0; pose < cyberglove::guidedPoses().size(); ++pose) {
    const auto& [name, instruction] = cyberglove::guidedPoses()[pose];
    fmt::print("\n{}: {}{}\n", name, instruction, o.pause_s > 0 ? "" : "; then press Enter");
    std::fflush(stdout);
    const Timestamp ready = clock.now() + fromSeconds(o.pause_s);
    const auto waited = pollUntil(
        *device, **line, [&] { return o.pause_s > 0 ? clock.now() >= ready : enterPressed(); });
    if (!waited) return fail(waited.error());
    calibration.begin(pose);
    collector.collecting = true;
    const Timestamp end = clock.now() + fromSeconds(o.hold_s);
    const auto held = pollUntil(*device, **line, [&] { return clock.now() >= end; });
    collector.collecting = false;
    if (!held) return fail(held.error());
    showSpans(calibration);
  }
  const auto solved = calibration.solve({});
  if (!solved) return fail(solved.error());
  const auto saved =
      saveDeviceSettings(o.output, "glove", {{"offset", solved->offset}, {"gain", solved->gain}});
  if (!saved) return fail(saved.error());
  fmt::print("\n{}: offsets and gains of this hand\n", o.output);
  return kExitDone;
}

}  // namespace

void addCalibrateGlove(CLI::App& calibrate, Run& run) {
  const auto o = std::make_shared<GloveOptions>();
  CLI::App* command = calibrate.add_subcommand("glove",
                                               "Guides you through a few poses and shows each "
                                               "sensor's span.\nExample: merlin calibrate glove "
                                               "serial:/dev/serial/by-id/usb-GLOVE -o merlin.json");
  command->add_option("port", o->port, "serial:/dev/..., pty:PATH or tcp://HOST:PORT")->required();
  command->add_option("-o,--output", o->output, "The configuration")->required();
  command->add_option("--baud", o->baud, "Speed of the line")->capture_default_str();
  command->add_option("--hold", o->hold_s, "Seconds that each pose is measured")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  command->add_option("--pause", o->pause_s, "Seconds to take a pose, in place of Enter")
      ->check(CLI::Range(0.1, 600.0));
  command->callback([o, &run] { run = [o] { return calibrateGlove(*o); }; });
}

}  // namespace merlin::cli
