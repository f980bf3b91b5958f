// merlin calibrate tracker: sets a station's alignment and boresight, from options or from
// measurements while a person holds the station at given places.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/cli/calibrate/calibrate.h"
#include "daemon/cli/calibrate/calibrated_device.h"
#include "daemon/cli/calibrate/guided_placement.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/guide.h"
#include "daemon/cli/live_samples.h"
#include "daemon/cli/print.h"
#include "drivers/fastrak/guided_alignment.h"
#include "drivers/fastrak/protocol.h"

namespace merlin::cli {
namespace {

using fastrak::GuidedAlignment;
using fastrak::StationFrame;
using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180 / std::numbers::pi;

struct TrackerOptions {
  std::string output, device, instance = "merlin";
  int station = 1;
  std::vector<double> alignment, boresight, hemisphere;  // empty: not given as options
  std::vector<std::string> steps = {"alignment", "boresight"};
  GuideTiming timing;

  bool hasOptions() const {
    return !alignment.empty() || !boresight.empty() || !hemisphere.empty();
  }
  bool has(const char* step) const {
    return std::find(steps.begin(), steps.end(), step) != steps.end();
  }
};

std::string keyOf(const char* form, int station) {
  return fmt::format(fmt::runtime(form), station);
}
constexpr const char *kAlignmentKey = "alignment{}_cm", *kBoresightKey = "boresight{}_wxyz";

bool isFastrak(const CalibratedDevice& tracker) { return tracker.driver == "fastrak"; }

// Returns the tracker in the configuration that the options name. Errors: kInvalidArgument (its
// driver has none of the settings that the options set), those of findDevice().
Result<CalibratedDevice> findTracker(const TrackerOptions& o) {
  auto tracker = findDevice(o.output, SampleKind::kTracker, o.device);
  if (!tracker || isFastrak(*tracker) || (!o.hasOptions() && o.has("alignment"))) return tracker;
  return Error{
      Errc::kInvalidArgument,
      fmt::format("{}: {}/driver (device \"{}\") is \"{}\", but only a Fastrak has alignment, "
                  "boresight and hemisphere: name a Fastrak with --device, or leave the options "
                  "out to have the axes and the origin of this tracker measured",
                  o.output, tracker->pointer, tracker->name, tracker->driver)};
}

int setFromOptions(const TrackerOptions& o, const CalibratedDevice& tracker) {
  auto values = Json::object();
  const auto put = [&](const char* key, const std::vector<double>& list) {
    if (!list.empty()) values[keyOf(key, o.station)] = numbers(list);
  };
  put(kAlignmentKey, o.alignment);
  put("hemisphere{}", o.hemisphere);
  if (!o.boresight.empty()) {
    double square = 0;
    for (const double v : o.boresight) square += v * v;
    if (square < 0.98 || square > 1.02)
      return fail({Errc::kInvalidArgument, "--boresight: is not a unit quaternion w x y z"});
    put(kBoresightKey, o.boresight);
  }
  if (const auto saved = saveSettings(tracker, SampleKind::kTracker, values); !saved)
    return fail(saved.error());
  printOut("{}: {}, station {}\n", o.output, tracker.name, o.station);
  return kExitDone;
}

// Measures a station by the samples that merlind writes into shared memory.
class GuidedStation final : public Guided {
 public:
  GuidedStation(LiveSamples<TrackerSample> samples, std::string device, const StationFrame& present,
                std::size_t first)
      : samples_(std::move(samples)),
        device_(std::move(device)),
        present_(present),
        first_(first),
        alignment_(present) {}

  Result<Ok> listen(bool measuring) override {
    return samples_.listen([&](const TrackerSample& sample) {
      newest_ = sample;
      if (measuring) alignment_.add(sample);
    });
  }
  void begin(std::size_t step) override { alignment_.begin(first_ + step); }
  Result<std::string> end() override {
    const std::string complaint = samples_.complaint();
    const auto held = alignment_.end();
    if (!held && !complaint.empty())
      return Error{held.error().code, fmt::format("{} sends no samples: {}", device_, complaint)};
    if (!held) return held.error();
    const auto& p = held->position_m;
    return fmt::format(
        "{} samples, mean position {:.2f} {:.2f} {:.2f} cm, all within {:.2f} cm and {:.2f} "
        "degrees of the mean",
        held->samples, 100 * p[0], 100 * p[1], 100 * p[2], 100 * held->spread_m,
        kDegrees * held->spread_rad);
  }
  std::string now() const override {
    if (!newest_) return "no sample yet";
    const auto sample = fastrak::inTransmitterFrame(*newest_, present_);
    std::array<float, 4> q{};
    std::copy(std::begin(sample.orientation_wxyz), std::end(sample.orientation_wxyz), q.begin());
    const auto angles = fastrak::anglesOf(q);
    const auto& p = sample.position_m;
    return fmt::format(
        "x {:7.2f}  y {:7.2f}  z {:7.2f} cm   az {:6.1f}  el {:6.1f}  roll {:6.1f} "
        "degrees",
        100 * p[0], 100 * p[1], 100 * p[2], angles[0], angles[1], angles[2]);
  }
  StationFrame solve() const { return alignment_.solve(); }

 private:
  LiveSamples<TrackerSample> samples_;
  std::string device_;  // name of the tracker
  StationFrame present_;
  std::size_t first_;
  GuidedAlignment alignment_;
  std::optional<TrackerSample> newest_;
};

// Returns the frame in which the running merlind reports samples of this station of the tracker.
// Errors: kTimeout (merlind has not published it yet).
Result<StationFrame> presentFrame(const shm::DeviceSlots& devices, const std::string& name,
                                  int station) {
  const auto* const tracker = devices.tracker(name);
  const auto frames = tracker ? tracker->frames->read() : std::nullopt;
  if (!frames) return Error{Errc::kTimeout, "merlind is still starting: try again"};
  const auto s = static_cast<std::size_t>(station - 1);
  StationFrame frame;
  std::copy_n(frames->alignment_cm[s], 9, frame.alignment_cm.begin());
  std::copy_n(frames->boresight_wxyz[s], 4, frame.boresight_wxyz.begin());
  return frame;
}

// Returns whether the value of `key` in the file equals `running`, the value of the running
// merlind. `own`: the driver's settings in the file; `standard`: the default value, compared if
// `own` lacks `key`.
template <std::size_t N>
bool agrees(const Json& own, const std::string& key, const std::array<float, N>& running,
            const std::array<float, N>& standard) {
  constexpr float kRounded = 0.006F;  // tolerance for the rounding of numbers in the file
  const auto at = own.find(key);
  if (at != own.end() && (!at->is_array() || at->size() != N)) return false;
  for (std::size_t i = 0; i < N; ++i) {
    if (at != own.end() && !(*at)[i].is_number()) return false;
    const float value = at == own.end() ? standard[i] : (*at)[i].template get<float>();
    if (std::abs(value - running[i]) > kRounded) return false;
  }
  return true;
}

// Checks that alignment and boresight have the same values in the file and in the running merlind,
// unless --steps measures them. The measured settings are relative to the running values. Errors:
// kInvalidArgument.
Result<Ok> checkKept(const TrackerOptions& o, const CalibratedDevice& tracker,
                     const StationFrame& present) {
  const std::string alignment = keyOf(kAlignmentKey, o.station);
  const std::string boresight = keyOf(kBoresightKey, o.station);
  std::string other;
  if (!o.has("alignment") &&
      !agrees(tracker.own, alignment, present.alignment_cm, FastrakSettings::kAligned))
    other = alignment;
  if (!o.has("boresight") &&
      !agrees(tracker.own, boresight, present.boresight_wxyz, FastrakSettings::kAhead))
    other = boresight;
  if (other.empty()) return Ok{};
  return Error{
      Errc::kInvalidArgument,
      fmt::format("{}: its {}/{}/{} differs from that of the running merlind, but "
                  "--steps does not measure it again: restart merlind with this file, or measure "
                  "both",
                  o.output, tracker.pointer, tracker.driver, other)};
}

int guideTracker(const TrackerOptions& o, const CalibratedDevice& tracker) {
  if (const auto writable = checkWritable(o.output); !writable) return fail(writable.error());
  if (!isFastrak(tracker)) {
    const auto placed = guidePlacement(tracker, o.station, o.timing);
    return placed ? kExitDone : fail(placed.error());
  }
  auto samples = LiveSamples<TrackerSample>::open(
      o.instance, fmt::format("{}{}", tracker.name, o.station), tracker.name);
  if (!samples) return fail(samples.error());
  const auto present = presentFrame(samples->devices(), tracker.name, o.station);
  if (!present) return fail(present.error());
  if (const auto kept = checkKept(o, tracker, *present); !kept) return fail(kept.error());
  const std::size_t first = o.has("alignment") ? fastrak::kOrigin : fastrak::kAhead;
  const std::size_t end = o.has("boresight") ? fastrak::kAhead + 1 : fastrak::kAhead;
  GuidedStation guided(*std::move(samples), tracker.name, *present, first);
  printOut("{}, station {}, of merlind \"{}\"\n", tracker.name, o.station, o.instance);
  const auto steps = fastrak::alignmentSteps().subspan(first, end - first);
  if (const auto done = guide(steps, o.timing, guided); !done) return fail(done.error());
  const StationFrame solved = guided.solve();
  const Json alignment = numbers(solved.alignment_cm), boresight = numbers(solved.boresight_wxyz);
  const auto saved = saveSettings(
      tracker, SampleKind::kTracker,
      {{keyOf(kAlignmentKey, o.station), alignment}, {keyOf(kBoresightKey, o.station), boresight}});
  if (!saved) return fail(saved.error());
  printOut("\n{}: {}, station {}, alignment {} cm, boresight {}; restart merlind to use it\n",
           o.output, tracker.name, o.station, alignment.dump(), boresight.dump());
  return kExitDone;
}

}  // namespace

void addCalibrateTracker(Command calibrate, Run& run) {
  const auto o = std::make_shared<TrackerOptions>();
  Command command = calibrate.subcommand(
      "tracker",
      "Set the alignment and boresight of a Fastrak's station: either tells you at which places to "
      "hold the station, while a running merlind measures them, or writes the given values. For a "
      "tracker of a VRPN server or one that sends OSC: tells you the places, measures them on the "
      "tracker's own line, and sets its axes and origin_m.\nExample: merlin calibrate tracker "
      "--station 1 -o merlin.json\nExample: merlin calibrate tracker --station 1 --boresight "
      "0.7071 0 0 0.7071 -o merlin.json");
  addDeviceOption(command, o->device, "tracker");
  command.option("--station", o->station).range(1, 4).showDefault();
  command.option("--steps", o->steps, "Settings to measure: alignment, boresight or both")
      .separated(',')
      .oneOf({"alignment", "boresight"})
      .showDefault();
  addGuideTiming(command, o->timing);
  addInstance(command, o->instance);
  command
      .option(
          "--alignment", o->alignment,
          "New origin, a point on the new x axis and a point on the new y axis, each as x y z in "
          "the transmitter's frame, in centimetres")
      .expected(9)
      .range(-1000.0, 1000.0);
  command
      .option(
          "--boresight", o->boresight,
          "Orientation of the receiver that counts as straight ahead: a unit quaternion w x y z, "
          "as merlin shm dump shows it")
      .expected(4)
      .range(-1.0, 1.0);
  command
      .option("--hemisphere", o->hemisphere,
              "Vector in the transmitter's frame that points into the half-space in which the "
              "receiver is")
      .expected(3)
      .range(-1.0, 1.0);
  command.option("-o,--output", o->output, "The configuration file to write into").required();
  command.callback([o, &run] {
    run = [o] {
      const auto tracker = findTracker(*o);
      if (!tracker) return fail(tracker.error());
      return o->hasOptions() ? setFromOptions(*o, *tracker) : guideTracker(*o, *tracker);
    };
  });
}

}  // namespace merlin::cli
