// merlin posture collect: records hands of one posture from a running daemon's glove into a CSV
// file.
#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/base/clock.h"
#include "daemon/base/log.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/posture/posture.h"
#include "daemon/cli/print.h"
#include "daemon/shm/segment.h"
#include "nn/evaluate.h"

namespace merlin::cli {
namespace {

constexpr int kSensorBar = 24;
constexpr std::size_t kBarsALine = 2;
constexpr Duration kCollectRedraw = std::chrono::milliseconds(100);
constexpr Duration kSamplePatience = std::chrono::seconds(3);  // longest time without a sample

struct CollectOptions {
  std::string label, output = "hands.csv", instance = "merlin", units = "rad";
  std::string device;  // empty: the first glove
  double seconds = 2;
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

// Draws a bar for each sensor that shows its value within the raw range, 0 to 255. `again`: redraws
// over the bars of the last call.
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

// Records the glove for options.seconds, counted from the first sample. Errors: those of
// DevicesReader::open() (kNotFound: no daemon), kInvalidArgument (no such glove), kTimeout (no
// sample for 3 s).
Result<nn::Recording> collect(const CollectOptions& options) {
  const auto devices = shm::DevicesReader::open(shm::segmentName(options.instance, "devices"));
  if (!devices) return devices.error();
  const auto* const slots = (*devices)->glove(options.device);
  if (!slots) return noGlove(**devices, options);
  const auto& glove = *slots->samples;
  const SystemClock clock;
  nn::Recording recording;
  recording.unit = unitNamed(options.units).value_or(nn::InputUnit::kRadians);
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  Timestamp heard = clock.now(), drawn{}, began{};
  bool again = false;
  for (std::uint64_t next = glove.count();
       began == Timestamp{} || heard - began < fromSeconds(options.seconds);) {
    glove.wait(next, {0, 100'000'000});
    if (next == glove.count()) {
      if (clock.now() - heard < kSamplePatience) continue;
      return Error{Errc::kTimeout, slots->name + " has sent nothing for 3 s: see merlin status"};
    }
    heard = clock.now();
    if (began == Timestamp{}) began = heard;
    next =
        std::max(next, glove.count() - std::min<std::uint64_t>(glove.count(), shm::kHistory / 2));
    for (; next < glove.count(); ++next) {
      const auto sample = glove.at(next);
      if (!sample) continue;
      recording.hands.push_back(handOf(*sample, options.label, recording.unit));
      for (std::size_t i = 0; i < nn::kInputs; ++i)
        recording.measured[i] = recording.measured[i] || sample->raw[i] != 0;
      if (!terminal || heard - drawn < kCollectRedraw) continue;
      drawBars(*sample, again);
      drawn = heard;
      again = true;
    }
  }
  return recording;
}

// If the file `path` exists, puts its hands before those of `recording`. Errors: those of
// nn::loadRecording(); kInvalidArgument (the hands in the file have other sensors).
Result<Ok> addTo(nn::Recording& recording, const std::string& path) {
  if (!std::filesystem::exists(path)) return Ok{};
  auto before = nn::loadRecording(path, recording.unit);
  if (!before) return before.error();
  if (before->measured != recording.measured)
    return Error{
        Errc::kInvalidArgument,
        path + ": was recorded with a glove that has other sensors; choose another file with -o"};
  before->hands.insert(before->hands.end(), recording.hands.begin(), recording.hands.end());
  recording = *std::move(before);
  return Ok{};
}

int run(const CollectOptions& options) {
  if (!nn::isPostureName(options.label))
    return fail({Errc::kInvalidArgument,
                 fmt::format("LABEL \"{}\": allowed are 1 to {} letters, digits, - or _",
                             options.label, nn::kLongestName)});
  printError("hold \"{}\" for {} s\n", options.label, options.seconds);
  auto recording = collect(options);
  if (!recording) return fail(recording.error());
  const std::size_t taken = recording->hands.size();
  if (const auto added = addTo(*recording, options.output); !added) return fail(added.error());
  if (const auto saved = nn::saveRecording(options.output, *recording); !saved)
    return fail(saved.error());
  printOut("{}: {} hands of \"{}\" recorded, {} in all\n", options.output, taken, options.label,
           recording->hands.size());
  for (const nn::Overlap& o : nn::overlapsOf(options.label, recording->hands))
    printError(
        "warning: \"{}\" and \"{}\" are hard to tell apart: their means are {:.1f} standard "
        "deviations apart, and {} hands are nearer to the mean of the other posture\n",
        o.first, o.second, o.deviations, o.mixed_up);
  return kExitDone;
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
