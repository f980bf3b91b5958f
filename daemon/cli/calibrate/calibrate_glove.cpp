// merlin calibrate glove: guides a person through a few poses of the hand and computes the offset
// and gain of each sensor.
#include <memory>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/cli/calibrate/calibrate.h"
#include "daemon/cli/calibrate/calibrated_device.h"
#include "daemon/cli/calibrate/ignoring_sink.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/guide.h"
#include "daemon/cli/print.h"
#include "drivers/cyberglove/device.h"
#include "drivers/cyberglove/guided_calibration.h"
#include "drivers/hand/hand.h"

namespace merlin::cli {
namespace {

using cyberglove::GuidedCalibration;

struct GloveOptions {
  std::string port, output, device;
  int baud = 0;  // 0: the rate in the configuration
  GuideTiming timing;
};

// Measures the glove directly on its serial line.
class GuidedGlove final : public Guided, private IgnoringSink {
 public:
  GuidedGlove(const CybergloveSettings& settings, ByteStream& line, const Clock& clock)
      : settings_(settings), line_(line), device_(cyberglove::makeDevice(settings, clock, *this)) {}

  Result<std::string> open() { return device_->open(line_); }
  Result<Ok> listen(bool measuring) override {
    measuring_ = measuring;
    return device_->poll(line_);
  }
  void begin(std::size_t pose) override { calibration_.begin(pose); }
  Result<std::string> end() override { return spans(); }
  Result<CybergloveSettings> solve() const { return calibration_.solve(settings_); }

 private:
  void publish(const GloveSample& sample) noexcept override {
    if (measuring_) calibration_.add(sample);
  }
  std::string spans() const;

  CybergloveSettings settings_;
  ByteStream& line_;
  std::unique_ptr<Device> device_;
  GuidedCalibration calibration_;
  bool measuring_ = false;
};

// Returns one line per sensor: a bar for the raw values 0 to 255, in which the range measured so
// far is marked.
std::string GuidedGlove::spans() const {
  constexpr int kWidth = 51;
  const auto column = [](int raw) { return static_cast<std::size_t>(raw * (kWidth - 1) / 255); };
  std::string text;
  for (std::size_t i = 0; i < kGloveSlots; ++i) {
    const int low = calibration_.low(i), high = calibration_.high(i);
    if (high == 0) continue;
    std::string bar(kWidth, '.');
    for (std::size_t at = column(low); at <= column(high); ++at) bar[at] = '#';
    text += fmt::format("{}{:23} {} {:3} to {:3}", text.empty() ? "" : "\n  ", hand::kJointNames[i],
                        bar, low, high);
  }
  return text;
}

int calibrateGlove(const GloveOptions& o) {
  if (const auto writable = checkWritable(o.output); !writable) return fail(writable.error());
  const auto device = findDevice(o.output, SampleKind::kGlove, o.device);
  if (!device) return fail(device.error());
  const auto line = openOwnLine(*device, o.port, o.baud);
  if (!line) return fail(line.error());
  const SystemClock clock;
  GuidedGlove guided(line->settings.own.cyberglove, *line->stream, clock);
  const auto identity = guided.open();
  if (!identity) return fail(identity.error());
  printOut("{}: {}\n", device->name, *identity);
  if (const auto done = guide(cyberglove::guidedPoses(), o.timing, guided); !done)
    return fail(done.error());
  const auto solved = guided.solve();
  if (!solved) return fail(solved.error());
  const auto saved = saveSettings(*device, SampleKind::kGlove,
                                  {{"offset", solved->offset}, {"gain", solved->gain}});
  if (!saved) return fail(saved.error());
  printOut("\n{}: {}, offsets and gains of this hand\n", o.output, device->name);
  return kExitDone;
}

}  // namespace

void addCalibrateGlove(Command calibrate, Run& run) {
  const auto o = std::make_shared<GloveOptions>();
  Command command = calibrate.subcommand(
      "glove",
      "Calibrate the glove: tells you a few poses to hold and computes each sensor's offset and "
      "gain. Only one program can open the line: stop merlind first.\nExample: merlin calibrate "
      "glove -o merlin.json\nExample: merlin calibrate glove serial:/dev/serial/by-id/usb-GLOVE -o "
      "merlin.json");
  command.option("port", o->port,
                 "Port of the glove: serial:/dev/..., pty:PATH or tcp://HOST:PORT; the default is "
                 "that of the glove in the configuration file");
  command.option("-o,--output", o->output, "The configuration file to write into").required();
  command
      .option("--baud", o->baud,
              "Speed of the line in bits per second; the default is that of the glove in the "
              "configuration file")
      .baud();
  addDeviceOption(command, o->device, "glove");
  addGuideTiming(command, o->timing);
  command.callback([o, &run] { run = [o] { return calibrateGlove(*o); }; });
}

}  // namespace merlin::cli
