// merlin calibrate touch: sets how a touch surface is mounted, from corners that a person touches,
// and its other settings from options.
#include <memory>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/cli/calibrate/calibrate.h"
#include "daemon/cli/calibrate/calibrated_device.h"
#include "daemon/cli/calibrate/ignoring_sink.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/guide.h"
#include "daemon/cli/print.h"
#include "drivers/port/guided_corners.h"
#include "drivers/registry.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

struct TouchOptions {
  std::string port, output, device;
  double aspect = 0;     // 0: not given
  int mouse_counts = 0;  // 0: not given
  GuideTiming timing;
};

// Measures the touch surface by opening its line, in the axes of the device.
class GuidedSurface final : public Guided, private IgnoringSink {
 public:
  GuidedSurface(const OwnLine& line, const DriverEntry& driver, const Clock& clock)
      : stream_(*line.stream), device_(driver.make(inOwnAxes(line.settings.own), clock, *this)) {}

  Result<std::string> open() { return device_->open(stream_); }
  Result<Ok> listen(bool measuring) override {
    measuring_ = measuring;
    return device_->poll(stream_);
  }
  void begin(std::size_t step) override {
    corners_.begin(step);
    corners_.add(newest_);  // a finger that is already down then does not count as a new touch
  }
  Result<std::string> end() override {
    const auto place = corners_.end();
    if (!place) return place.error();
    return fmt::format("at {:.2f} {:.2f} of the device's axes", (*place)[0], (*place)[1]);
  }
  std::string now() const override {
    if (newest_.fingers == 0) return "no finger";
    return fmt::format("{} {}, at {:.2f} {:.2f}", newest_.fingers,
                       newest_.fingers == 1 ? "finger" : "fingers", newest_.position[0][0],
                       newest_.position[0][1]);
  }
  TouchOrientation solve() const { return corners_.solve(); }

 private:
  static DriverSettings inOwnAxes(DriverSettings settings) {
    settings.touch.orientation = settings.tuio.orientation = {};
    return settings;
  }
  void publish(const TouchSample& sample) noexcept override {
    newest_ = sample;
    if (measuring_) corners_.add(sample);
  }

  ByteStream& stream_;
  std::unique_ptr<Device> device_;
  GuidedCorners corners_;
  TouchSample newest_{};
  bool measuring_ = false;
};

int saveTouch(const CalibratedDevice& touch, const Json& values) {
  const auto saved = saveChecked(touch, SampleKind::kTouch, values);
  return saved ? kExitDone : fail(saved.error());
}

int guideTouch(const TouchOptions& o, const CalibratedDevice& touch) {
  if (const auto writable = checkWritable(o.output); !writable) return fail(writable.error());
  const auto line = openOwnLine(touch, o.port, 0);
  if (!line) return fail(line.error());
  const SystemClock clock;
  GuidedSurface guided(*line, *findDriver(touch.driver), clock);
  const auto identity = guided.open();
  if (!identity) return fail(identity.error());
  printOut("{}: {}\n", touch.name, *identity);
  if (const auto done = guide(cornerSteps(), o.timing, guided); !done) return fail(done.error());
  const TouchOrientation solved = guided.solve();
  printOut("\n");
  return saveTouch(touch, {{"swap_axes", solved.swap_axes},
                           {"invert_x", solved.invert_x},
                           {"invert_y", solved.invert_y}});
}

int calibrateTouch(const TouchOptions& o) {
  const auto touch = findDevice(o.output, SampleKind::kTouch, o.device);
  if (!touch) return fail(touch.error());
  if (o.mouse_counts > 0 && touch->driver != "touch")
    return fail({Errc::kInvalidArgument,
                 fmt::format("--mouse-counts: \"{}\" has the driver {}, which reads no mouse",
                             touch->name, touch->driver)});
  auto values = Json::object();
  if (o.aspect > 0) values["aspect"] = o.aspect;
  if (o.mouse_counts > 0) values["mouse_counts"] = o.mouse_counts;
  return values.empty() ? guideTouch(o, *touch) : saveTouch(*touch, values);
}

}  // namespace

void addCalibrateTouch(Command calibrate, Run& run) {
  const auto o = std::make_shared<TouchOptions>();
  Command command = calibrate.subcommand(
      "touch",
      "Set how a touch frame or touch screen is mounted (drivers touch and tuio): asks you to "
      "touch three corners of the picture; or writes the given values. Only one program can open "
      "the device: stop merlind first.\nExample: merlin calibrate touch -o merlin.json\nExample: "
      "merlin calibrate touch --mouse-counts 3000 -o merlin.json");
  command.option(
      "port", o->port,
      "Port of the device, evdev:/dev/input/by-id/... or udp://ADDRESS:3333; the default "
      "is that of the device in the configuration file");
  command.option("-o,--output", o->output, "The configuration file to write into").required();
  addDeviceOption(command, o->device, "touch surface");
  command
      .option("--aspect", o->aspect,
              "Width of the surface divided by its height, as a person sees it")
      .range(0.1, 10.0);
  command
      .option("--mouse-counts", o->mouse_counts,
              "Mouse only: counts of its motion that correspond to the surface's height")
      .range(100, 100000);
  addGuideTiming(command, o->timing);
  command.callback([o, &run] { run = [o] { return calibrateTouch(*o); }; });
}

}  // namespace merlin::cli
