// merlin calibrate ball: sets the ball's axis map and sensitivities, from options or from pushes
// and twists of a person.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/cli/calibrate/calibrate.h"
#include "daemon/cli/calibrate/calibrated_device.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/guide.h"
#include "daemon/cli/live_samples.h"
#include "daemon/cli/print.h"
#include "drivers/spaceball/guided_axes.h"

namespace merlin::cli {
namespace {

struct BallOptions {
  std::string output, device, instance = "merlin";
  // The initial values mean that the option was not given.
  int translation = 0, rotation = 0, full = 0, dead_zone = -1;
  std::vector<int> axis_map;
  GuideTiming timing;

  bool hasOptions() const {
    return translation > 0 || rotation > 0 || full > 0 || dead_zone >= 0 || !axis_map.empty();
  }
};

// Whether the ball has the driver spacenav, with a single full scale for all axes.
bool isSpaceMouse(const CalibratedDevice& ball) { return ball.driver == "spacenav"; }

// Returns the ball in the configuration that the options name. Errors: kInvalidArgument (its driver
// has no axis map and sensitivities), those of findDevice().
Result<CalibratedDevice> findBall(const BallOptions& o) {
  constexpr const char* kDrivers[] = {"spaceball", "spacenav"};
  auto ball = findDevice(o.output, SampleKind::kBall, o.device, kDrivers);
  if (!ball || ball->driver == "spaceball" || isSpaceMouse(*ball)) return ball;
  const bool is_pad = ball->driver == "evdev" || ball->driver == "vrpn_pad";
  const std::string instead =
      is_pad ? fmt::format("run `merlin calibrate pad --device {} -o {}` instead", ball->name,
                           o.output)
             : "name another ball with --device";
  return Error{Errc::kInvalidArgument,
               fmt::format("{}: {}/driver (device \"{}\") is \"{}\", a driver without axis map and "
                           "full scales to calibrate: {}",
                           o.output, ball->pointer, ball->name, ball->driver, instead)};
}

// Checks the options against the driver of the ball. Errors: kInvalidArgument (an option that the
// driver lacks, or an axis map in which an axis is missing).
Result<Ok> checkOptions(const BallOptions& o, const CalibratedDevice& ball) {
  if (isSpaceMouse(ball) ? o.translation > 0 || o.rotation > 0 : o.full > 0) {
    const char* const allowed =
        isSpaceMouse(ball) ? "--full-scale" : "--full-scale-translation and --full-scale-rotation";
    return Error{Errc::kInvalidArgument,
                 fmt::format("\"{}\" has the driver {}, whose options for its scale are {}",
                             ball.name, ball.driver, allowed)};
  }
  if (o.axis_map.empty()) return Ok{};
  std::array<bool, 7> seen{};
  for (const int axis : o.axis_map) seen[static_cast<std::size_t>(std::abs(axis))] = true;
  if (!seen[0] && std::count(seen.begin(), seen.end(), true) == 6) return Ok{};
  return Error{Errc::kInvalidArgument,
               "--axis-map: needs each of 1 to 6 once; a negative number reverses the axis"};
}

int setFromOptions(const BallOptions& o, const CalibratedDevice& ball) {
  if (const auto fits = checkOptions(o, ball); !fits) return fail(fits.error());
  auto values = nlohmann::ordered_json::object();
  if (o.translation > 0) values["full_scale_translation"] = o.translation;
  if (o.rotation > 0) values["full_scale_rotation"] = o.rotation;
  if (o.full > 0) values["full_scale"] = o.full;
  if (o.dead_zone >= 0) values["dead_zone"] = o.dead_zone;
  if (!o.axis_map.empty()) values["axis_map"] = o.axis_map;
  if (const auto saved = saveSettings(ball, SampleKind::kBall, values); !saved)
    return fail(saved.error());
  printOut("{}: {}\n", o.output, ball.name);
  return kExitDone;
}

// Measures the ball by the raw counts that merlind writes into shared memory.
class GuidedBall final : public Guided {
 public:
  GuidedBall(LiveSamples<BallSample> samples, std::string device,
             const spaceball::BallResponse& response)
      : samples_(std::move(samples)), device_(std::move(device)), axes_(response) {}

  Result<Ok> listen(bool measuring) override {
    return samples_.listen([&](const BallSample& sample) {
      newest_ = sample;
      if (measuring) axes_.add(sample);
    });
  }
  void begin(std::size_t step) override {
    step_ = step;
    axes_.begin(step);
  }
  Result<std::string> end() override {
    if (const std::string complaint = samples_.complaint(); !complaint.empty())
      return Error{Errc::kTimeout, fmt::format("{} does not answer: {}", device_, complaint)};
    const auto answer = axes_.end();
    if (!answer) return answer.error();
    if (step_ == 0) return fmt::format("at rest at most {} counts", answer->counts);
    return fmt::format("most {}{} with {} counts, next {} with {} counts",
                       answer->axis < 0 ? '-' : '+', spaceball::nameOfAxis(answer->axis),
                       answer->counts, spaceball::nameOfAxis(answer->next_axis),
                       answer->next_counts);
  }
  std::string now() const override {
    const BallSample sample =
        newest_.value_or(BallSample{});  // a ball that sends nothing is at rest
    std::string line;
    for (int axis = 1; axis <= 6; ++axis)
      line += fmt::format("{} {:6}  ", spaceball::nameOfAxis(axis), sample.raw[axis - 1]);
    return line + "counts";
  }
  SpaceballSettings solve() const { return axes_.solve({}); }

 private:
  LiveSamples<BallSample> samples_;
  std::string device_;  // name of the device
  std::size_t step_ = 0;
  spaceball::GuidedAxes axes_;
  std::optional<BallSample> newest_;
};

// Returns the settings to write into the configuration. A space mouse has one full scale for all
// axes: the smaller of the two, so that each axis can reach it.
nlohmann::ordered_json valuesOf(const SpaceballSettings& s, bool space_mouse) {
  if (space_mouse)
    return {{"full_scale", std::min(s.full_scale_translation, s.full_scale_rotation)},
            {"dead_zone", s.dead_zone},
            {"axis_map", s.axis_map}};
  return {{"full_scale_translation", s.full_scale_translation},
          {"full_scale_rotation", s.full_scale_rotation},
          {"dead_zone", s.dead_zone},
          {"axis_map", s.axis_map}};
}

int guideBall(const BallOptions& o, const CalibratedDevice& ball) {
  if (const auto writable = checkWritable(o.output); !writable) return fail(writable.error());
  auto samples = LiveSamples<BallSample>::open(o.instance, ball.name, ball.name);
  if (!samples) return fail(samples.error());
  GuidedBall guided(
      *std::move(samples), ball.name,
      isSpaceMouse(ball) ? spaceball::kSpaceMouseResponse : spaceball::kSpaceballResponse);
  printOut("{} of merlind \"{}\"\n", ball.name, o.instance);
  if (const auto done = guide(spaceball::axesSteps(), o.timing, guided); !done)
    return fail(done.error());
  const SpaceballSettings s = guided.solve();
  const nlohmann::ordered_json values = valuesOf(s, isSpaceMouse(ball));
  if (const auto saved = saveSettings(ball, SampleKind::kBall, values); !saved)
    return fail(saved.error());
  printOut(
      "\n{}: {}, axis map {}, full push {} counts, full twist {}, dead zone {}; restart "
      "merlind to use it\n",
      o.output, ball.name, values["axis_map"].dump(), s.full_scale_translation,
      s.full_scale_rotation, s.dead_zone);
  return kExitDone;
}

}  // namespace

void addCalibrateBall(Command calibrate, Run& run) {
  const auto o = std::make_shared<BallOptions>();
  Command command =
      calibrate.subcommand("ball",
                           "Set the ball's axis map and sensitivities: either tells you which "
                           "pushes and twists to make, "
                           "while a running merlind measures them, or writes the given "
                           "values.\nExample: merlin calibrate ball -o "
                           "merlin.json\nExample: merlin calibrate ball --axis-map 1 2 -3 4 5 -6 "
                           "--full-scale-translation 6000 -o merlin.json");
  addDeviceOption(command, o->device, "ball");
  addGuideTiming(command, o->timing);
  addInstance(command, o->instance);
  command
      .option("--full-scale-translation", o->translation,
              "Spaceball only: raw count of a translation axis at a full push")
      .range(100, 32767);
  command
      .option("--full-scale-rotation", o->rotation,
              "Spaceball only: raw count of a rotation axis at a full twist")
      .range(100, 32767);
  command
      .option("--full-scale", o->full,
              "Space mouse (driver spacenav) only: count of an axis at a full push or twist")
      .range(100, 32767);
  command.option("--dead-zone", o->dead_zone, "Largest raw count that is treated as rest")
      .range(0, 99);
  command
      .option("--axis-map", o->axis_map,
              "Device axis for each of x, y, z and the rotations about x, y, z: 1 to 3 are the "
              "device's "
              "X, Y, Z, and 4 to 6 its rotations A, B, C; a negative number reverses the axis")
      .expected(6)
      .range(-6, 6);
  command.option("-o,--output", o->output, "The configuration file to write into").required();
  command.callback([o, &run] {
    run = [o] {
      const auto ball = findBall(*o);
      if (!ball) return fail(ball.error());
      return o->hasOptions() ? setFromOptions(*o, *ball) : guideBall(*o, *ball);
    };
  });
}

}  // namespace merlin::cli
