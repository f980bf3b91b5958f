// merlin calibrate pad: sets the axes and the dead zone of a gamepad, a joystick or a space mouse
// that is read directly, or of a VRPN server's analogs, from options or from movements of a person.
#include <cmath>
#include <functional>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/cli/calibrate/calibrate.h"
#include "daemon/cli/calibrate/calibrated_device.h"
#include "daemon/cli/calibrate/ignoring_sink.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/guide.h"
#include "daemon/cli/print.h"
#include "drivers/evdev/device.h"
#include "drivers/port/guided_pad.h"
#include "drivers/vrpn/pad_device.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDrivers[] = {"evdev", "vrpn_pad"};

struct PadOptions {
  std::string port, output, device;
  std::vector<std::string> axes;      // empty: not given
  double dead_zone = -1, curve = -1;  // negative: not given
  GuideTiming timing;

  bool hasOptions() const { return !axes.empty() || dead_zone >= 0 || curve >= 0; }
};

// Returns the pad in the configuration that the options name. Errors: kInvalidArgument (it has a
// driver that this command does not support), those of findDevice().
Result<CalibratedDevice> findPad(const PadOptions& o) {
  auto pad = findDevice(o.output, SampleKind::kBall, o.device, kDrivers);
  if (!pad || isOneOf(pad->driver, kDrivers)) return pad;
  return Error{
      Errc::kInvalidArgument,
      fmt::format("{}: {}/driver (device \"{}\") is \"{}\", which `merlin calibrate ball` "
                  "calibrates; for a pad, name a device with the driver {} with --device",
                  o.output, pad->pointer, pad->name, pad->driver, fmt::join(kDrivers, " or "))};
}

// Measures the device by opening its line.
class GuidedPadLine final : public Guided, private IgnoringSink {
 public:
  GuidedPadLine(const OwnLine& line, const std::string& driver, const Clock& clock)
      : stream_(*line.stream) {
    SampleSink& sink = *this;
    if (driver == "evdev") {
      auto device = std::make_unique<evdev::EvdevDevice>(line.settings.own.evdev, clock, sink);
      readings_ = [&input = device->input()] { return input.readings(); };
      device_ = std::move(device);
    } else {
      auto device = std::make_unique<vrpn::VrpnPad>(line.settings.own.vrpn_pad, clock, sink);
      readings_ = [&input = device->input()] { return input.readings(); };
      device_ = std::move(device);
    }
  }

  Result<std::string> open() { return device_->open(stream_); }
  Result<Ok> listen(bool measuring) override {
    auto polled = device_->poll(stream_);
    if (polled && measuring) pad_.add(readings_());
    return polled;
  }
  void begin(std::size_t step) override {
    step_ = step;
    pad_.begin(step);
    pad_.add(readings_());  // an axis that is already deflected then does not count as moved
  }
  Result<std::string> end() override {
    const auto answer = pad_.end();
    if (!answer) return answer.error();
    if (step_ == 0)
      return fmt::format("at rest at most {:.2f} of the full deflection", answer->deflection);
    if (answer->source == "none")
      return std::string("nothing moved, so no axis will control this motion of the model");
    return fmt::format("{}, which moved by {:.2f}", answer->source, std::abs(answer->deflection));
  }
  std::string now() const override {
    std::string line;
    for (const AxisReading& reading : readings_())
      line += fmt::format("{} {:5.2f}  ", reading.name, reading.deflection);
    return line;
  }
  std::optional<PadAxes> solve() const { return pad_.solve(); }

 private:
  ByteStream& stream_;
  std::unique_ptr<Device> device_;
  std::function<std::vector<AxisReading>()> readings_;
  GuidedPad pad_;
  std::size_t step_ = 0;
};

int savePad(const CalibratedDevice& pad, const Json& values) {
  const auto saved = saveChecked(pad, SampleKind::kBall, values);
  return saved ? kExitDone : fail(saved.error());
}

int setFromOptions(const PadOptions& o, const CalibratedDevice& pad) {
  auto values = Json::object();
  if (!o.axes.empty()) values["axes"] = o.axes;
  if (o.dead_zone >= 0) values["dead_zone"] = o.dead_zone;
  if (o.curve >= 0) values["curve"] = o.curve;
  return savePad(pad, values);
}

int guidePad(const PadOptions& o, const CalibratedDevice& pad) {
  if (const auto writable = checkWritable(o.output); !writable) return fail(writable.error());
  const auto line = openOwnLine(pad, o.port, 0);
  if (!line) return fail(line.error());
  const SystemClock clock;
  GuidedPadLine guided(*line, pad.driver, clock);
  const auto identity = guided.open();
  if (!identity) return fail(identity.error());
  printOut("{}: {}\n", pad.name, *identity);
  if (const auto done = guide(padSteps(), o.timing, guided); !done) return fail(done.error());
  const auto solved = guided.solve();
  if (!solved)
    return fail(
        {Errc::kMalformed, "no axis was moved in any step; the configuration was not changed"});
  printOut("\n");
  return savePad(pad, {{"axes", solved->axes}, {"dead_zone", solved->dead_zone}});
}

}  // namespace

void addCalibratePad(Command calibrate, Run& run) {
  const auto o = std::make_shared<PadOptions>();
  Command command = calibrate.subcommand(
      "pad",
      "Set which axes of a gamepad, joystick, space mouse (driver evdev) or of a VRPN server's "
      "analogs (driver vrpn_pad) move the model, and the dead zone: either asks you to move them, "
      "or writes the given values. The kernel gives an input device to one program: stop merlind "
      "first.\nExample: merlin calibrate pad -o merlin.json\nExample: merlin calibrate pad --axes "
      "x,rz-z,y,ry,rx,-hat0x --dead-zone 0.1 -o merlin.json");
  command.option(
      "port", o->port,
      "Port of the device, evdev:/dev/input/by-id/... or tcp://HOST:3883; the default is "
      "that of the device in the configuration file");
  command.option("-o,--output", o->output, "The configuration file to write into").required();
  addDeviceOption(command, o->device, "pad");
  command
      .option("--axes", o->axes,
              "Six axes of the device, with commas between them, that control x, y, z and the "
              "rotations about x, y, z, written as in the setting axes. If the first is reversed, "
              "write --axes=-x,...")
      .separated(',');
  command
      .option("--dead-zone", o->dead_zone,
              "Share of the full deflection up to which an axis counts as at rest")
      .range(0.0, 0.9);
  command
      .option("--curve", o->curve, "Exponent of the response: 1 is linear, more is finer near rest")
      .range(1.0, 5.0);
  addGuideTiming(command, o->timing);
  command.callback([o, &run] {
    run = [o] {
      const auto pad = findPad(*o);
      if (!pad) return fail(pad.error());
      return o->hasOptions() ? setFromOptions(*o, *pad) : guidePad(*o, *pad);
    };
  });
}

}  // namespace merlin::cli
