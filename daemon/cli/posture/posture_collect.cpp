// merlin posture collect: records hands of one posture from a running daemon's glove into a CSV
// file.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/base/log.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/live_samples.h"
#include "daemon/cli/posture/posture.h"
#include "daemon/cli/print.h"
#include "daemon/cli/stop_signals.h"
#include "daemon/shm/segment.h"
#include "nn/evaluate.h"

namespace merlin::cli {
namespace {

constexpr int kSensorBar = 24;
constexpr std::size_t kBarsALine = 2;
constexpr Duration kCollectRedraw = std::chrono::milliseconds(100);
constexpr Duration kSamplePatience = std::chrono::seconds(3);  // maximum time without a sample

struct CollectOptions {
  std::string label, output = "hands.csv", instance = "merlin", units = "rad";
  std::string device;  // empty: the first glove
  double seconds = 2;

  nn::InputUnit unit() const { return unitNamed(units).value_or(nn::InputUnit::kRadians); }
};

// A glove of a running merlind.
struct LiveGlove {
  std::string name;
  LiveSamples<GloveSample> samples;
  int stop = -1;  // the descriptor of stopSignals()
};

// The hands that were recorded, perhaps for a shorter time than wanted.
struct CollectedHands {
  nn::Recording recording;
  std::optional<Error> ended;  // error that ended the recording early
};

nn::LabelledHand handOf(const GloveSample& sample, const std::string& label, nn::InputUnit unit) {
  nn::LabelledHand hand{label, {}};
  if (unit == nn::InputUnit::kRaw) {
    std::copy_n(std::begin(sample.raw), hand.value.size(), hand.value.begin());
  } else {
    std::copy(std::begin(sample.angle_rad), std::end(sample.angle_rad), hand.value.begin());
  }
  return hand;
}

// Draws a bar for the raw value (0 to 255) of each sensor on stderr. `again`: whether to draw over
// the bars of the last call.
void drawBars(const GloveSample& sample, bool again) {
  std::string out;
  std::size_t lines = 0;
  for (std::size_t i = 0; i < nn::kInputs; ++i) {
    const int full = kSensorBar * sample.raw[i] / 255;
    const bool last = i % kBarsALine == kBarsALine - 1 || i + 1 == nn::kInputs;
    out += fmt::format("{:>22} {:3} [{:#<{}}{:.<{}}]{}", nn::kInputNames[i], sample.raw[i], "",
                       full, "", kSensorBar - full, last ? "\033[K\n" : "  ");
    lines += last ? 1 : 0;
  }
  printError("{}{}", again ? fmt::format("\033[{}A", lines) : "", out);
}

Error noGlove(const shm::DeviceSlots& devices, const CollectOptions& options) {
  std::string names;
  for (const auto& glove : devices.gloves) names += (names.empty() ? "" : ", ") + glove.name;
  return {Errc::kInvalidArgument,
          fmt::format("the merlind that runs as \"{}\" has no glove{}{}; its gloves: {}",
                      options.instance, options.device.empty() ? "" : " named ", options.device,
                      names.empty() ? "none" : names)};
}

// Opens the glove that the options name, or the first glove. Errors: kInvalidArgument (there is no
// such glove), those of LiveSamples::open().
Result<LiveGlove> openGlove(const CollectOptions& options, int stop) {
  const auto devices = shm::DevicesReader::open(shm::segmentName(options.instance, "devices"));
  const auto* const glove = devices ? (*devices)->glove(options.device) : nullptr;
  if (devices && !glove) return noGlove(**devices, options);
  const std::string name = glove ? glove->name : "";
  // If merlind runs without devices, this returns the error that says why.
  auto samples = LiveSamples<GloveSample>::open(options.instance, name, name);
  if (!samples) return samples.error();
  return LiveGlove{name, *std::move(samples), stop};
}

nn::Slots measuredIn(const GloveSample& sample) {
  nn::Slots measured{};
  for (std::size_t i = 0; i < nn::kInputs; ++i) measured[i] = sample.raw[i] != 0;
  return measured;
}

// Calls `take` for each sample of the glove until `take` returns false. Errors: kTimeout (no sample
// for 3 s), kClosed (a signal has arrived, or merlind has ended).
template <typename Take>
Result<Ok> listenToGlove(LiveGlove& glove, Take take) {
  const SystemClock clock;
  Timestamp heard = clock.now();
  for (bool goes_on = true; goes_on;) {
    if (stopArrived(glove.stop)) return Error{Errc::kClosed, "ended by a signal"};
    const auto taken = glove.samples.listen([&](const GloveSample& sample) {
      heard = clock.now();
      goes_on = goes_on && take(sample);
    });
    if (!taken) return Error{taken.error().code, "merlind has ended"};
    if (clock.now() - heard >= kSamplePatience)
      return Error{Errc::kTimeout, glove.name + " has sent nothing for 3 s: see merlin status"};
  }
  return Ok{};
}

// Records hands from the glove for options.seconds, counted from the first sample; draws the
// sensors on a terminal.
CollectedHands collect(LiveGlove& glove, const CollectOptions& options) {
  const SystemClock clock;
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  Timestamp drawn{}, began{};
  CollectedHands collected;
  nn::Recording& recording = collected.recording;
  recording.unit = options.unit();
  const auto listened = listenToGlove(glove, [&](const GloveSample& sample) {
    const Timestamp now = clock.now();
    if (began == Timestamp{}) began = now;
    recording.hands.push_back(handOf(sample, options.label, recording.unit));
    const nn::Slots measured = measuredIn(sample);
    for (std::size_t i = 0; i < nn::kInputs; ++i)
      recording.measured[i] = recording.measured[i] || measured[i];
    if (terminal && now - drawn >= kCollectRedraw) {
      drawBars(sample, drawn != Timestamp{});
      drawn = now;
    }
    return now - began < fromSeconds(options.seconds);
  });
  if (!listened) collected.ended = listened.error();
  return collected;
}

// Checks that the hands in the file have the unit that is to be recorded, judging by their values:
// angles are within +-6.3 radians, and raw counts are whole numbers from 0 to 255. `before`: the
// hands in the file, read with the unit "auto". Errors: kInvalidArgument.
Result<Ok> checkUnit(const nn::Recording& before, const CollectOptions& options) {
  const auto refused = [&](const std::string& has, const char* records) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: has {}, and --units {} records {}; give the file's unit with "
                             "--units, or another file with -o",
                             options.output, has, options.units, records)};
  };
  const bool angles = before.unit == nn::InputUnit::kRadians;
  if (options.unit() == nn::InputUnit::kRadians)
    return angles ? Result<Ok>(Ok{}) : refused("raw counts (values beyond +-6.3)", "radians");
  for (const nn::LabelledHand& hand : before.hands) {
    for (std::size_t i = 0; i < nn::kInputs; ++i) {
      const float value = hand.value[i];
      if (!before.measured[i] || (value >= 0 && value <= 255 && value == std::floor(value)))
        continue;
      return refused(fmt::format("{} ({} is {})", angles ? "angles in radians" : "another unit",
                                 nn::kInputNames[i], value),
                     "raw counts, whole numbers from 0 to 255");
    }
  }
  return Ok{};
}

// Returns the hands that the output file contains already; none if it does not exist. Errors: those
// of checkWritable(), nn::loadRecording() and checkUnit().
Result<nn::Recording> handsSoFar(const CollectOptions& options) {
  if (const auto writable = checkWritable(options.output); !writable) return writable.error();
  if (!std::filesystem::exists(options.output)) return nn::Recording{};
  auto before = nn::loadRecording(options.output);
  if (!before) return before;
  if (const auto fits = checkUnit(*before, options); !fits) return fits.error();
  before->unit = options.unit();
  return before;
}

// Checks that the hands in the file have the same sensors as the glove (`measured`). Errors:
// kInvalidArgument.
Result<Ok> checkSensors(const nn::Recording& before, const nn::Slots& measured,
                        const std::string& path) {
  if (before.hands.empty() || before.measured == measured) return Ok{};
  return Error{
      Errc::kInvalidArgument,
      path + ": was recorded with a glove that has other sensors; choose another file with -o"};
}

// Appends the recorded hands to the output file. The file is read again, because it may have
// changed during the recording. Errors: those of handsSoFar(), checkSensors() and
// nn::saveRecording().
Result<Ok> saveHands(nn::Recording recording, const CollectOptions& options) {
  auto found = handsSoFar(options);
  if (!found) return found.error();
  nn::Recording before = *std::move(found);
  const std::size_t taken = recording.hands.size();
  if (auto fits = checkSensors(before, recording.measured, options.output); !fits) return fits;
  before.hands.insert(before.hands.end(), recording.hands.begin(), recording.hands.end());
  recording.hands = std::move(before.hands);
  recording.synthetic = before.synthetic;
  if (auto saved = nn::saveRecording(options.output, recording); !saved) return saved;
  printOut("{}: {} hands of \"{}\" recorded, {} in all\n", options.output, taken, options.label,
           recording.hands.size());
  for (const nn::Overlap& o : nn::overlapsOf(options.label, recording.hands))
    printError(
        "warning: \"{}\" and \"{}\" are hard to tell apart: their means are {:.1f} standard "
        "deviations apart, and {} hands are nearer to the mean of the other posture\n",
        o.first, o.second, o.deviations, o.mixed_up);
  return Ok{};
}

// Opens the glove and waits for a sample, so that faults of the glove or the file are reported
// before the person holds the posture. Errors: those of openGlove(), listenToGlove() and
// checkSensors().
Result<LiveGlove> openGloveFor(const nn::Recording& before, const CollectOptions& options,
                               int stop) {
  auto glove = openGlove(options, stop);
  if (!glove) return glove;
  nn::Slots measured{};
  const auto heard = listenToGlove(*glove, [&](const GloveSample& sample) {
    measured = measuredIn(sample);
    return false;
  });
  if (!heard) return heard.error();
  if (const auto fits = checkSensors(before, measured, options.output); !fits) return fits.error();
  return glove;
}

int run(const CollectOptions& options) {
  if (!nn::isPostureName(options.label))
    return fail({Errc::kInvalidArgument,
                 fmt::format("LABEL \"{}\": allowed are 1 to {} letters, digits, - or _",
                             options.label, nn::kLongestName)});
  const auto before = handsSoFar(options);
  if (!before) return fail(before.error());
  const UniqueFd stop = stopSignals();
  auto glove = openGloveFor(*before, options, stop.get());
  if (!glove) return fail(glove.error());
  printError("hold \"{}\" for {} s\n", options.label, options.seconds);
  CollectedHands collected = collect(*glove, options);
  const std::size_t hands = collected.recording.hands.size();
  if (hands > 0) {
    const auto saved = saveHands(std::move(collected.recording), options);
    if (!saved) return fail(saved.error());
  }
  if (!collected.ended) return kExitDone;
  return fail({collected.ended->code,
               collected.ended->what +
                   (hands == 0 ? "; no hand was recorded, so nothing was written"
                               : fmt::format("; {} hands were recorded until then", hands))});
}

}  // namespace

void addPostureCollect(Command posture, Run& run_now) {
  const auto options = std::make_shared<CollectOptions>();
  Command command = posture.subcommand(
      "collect",
      "Record hands of one posture from the glove of a running merlind (live, or replayed with "
      "port replay:FILE) and append them to a CSV file.\nExample: merlin posture collect fist -o "
      "hands.csv");
  command.option("label", options->label, "The posture's name").required().typeName("LABEL");
  command.option("-o", options->output, "The CSV file").showDefault().typeName("FILE.csv");
  command.option("--seconds", options->seconds, "Duration of the recording in seconds")
      .range(0.1, 600.0)
      .showDefault();
  command.option("--units", options->units, "Angles in radians, or raw counts of the sensors")
      .oneOf({"rad", "raw"})
      .showDefault();
  command.option("--device", options->device, "Name of the glove; the default is the first one")
      .typeName("NAME");
  addInstance(command, options->instance);
  command.callback([options, &run_now] { run_now = [options] { return run(*options); }; });
}

}  // namespace merlin::cli
