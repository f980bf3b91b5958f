// merlin gesture record: records takes of one gesture, or ordinary motion, from the tracked hand of
// a running daemon into a CSV file.
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/gesture/gesture.h"
#include "daemon/cli/live_samples.h"
#include "daemon/cli/print.h"
#include "daemon/cli/stop_signals.h"
#include "nn/io/path_file.h"

namespace merlin::cli {
namespace {

constexpr Duration kHandPatience = std::chrono::seconds(3);  // maximum time without a sample
// Maximum time between two samples of a take.
constexpr Duration kLongestGap = std::chrono::milliseconds(250);
// Number of attempts at one take; after that, the recording ends.
constexpr int kMostTriesOfATake = 5;
constexpr double kBetweenFiles_s = 10;  // time from the last pose in the file to the first new pose

struct GestureRecordOptions {
  std::string label, hand, output = "gestures.csv", instance = "merlin";
  std::vector<int> axes = {-2, -3, 1};
  std::size_t times = 5;
  double seconds = 2, pause = 1.5;
};

// A hand of a running merlind.
struct LiveHand {
  std::string name;
  std::size_t index = 0;  // index in /hands
  LiveSamples<HandSample> samples;
  int stop = -1;  // the descriptor of stopSignals()
};

// The takes that were recorded, perhaps fewer than wanted.
struct RecordedTakes {
  nn::PathRecording recording;
  std::size_t count = 0;
  std::optional<Error> ended;  // error that ended the recording early
};

// Returns the names of the hands as a clause for a message, "its hands are left, right".
std::string handsOf(const shm::DeviceSlots& devices) {
  std::string names;
  for (const auto& hand : devices.hands) names += (names.empty() ? "" : ", ") + hand.name;
  return names.empty() ? "it has no hand: add one to /hands"
                       : fmt::format("its hands are {}", names);
}

// Opens the hand that the options name, or the first hand. Errors: kInvalidArgument (there is no
// such hand, or no tracker), those of LiveSamples::open().
Result<LiveHand> openHand(const GestureRecordOptions& options, int stop) {
  const auto devices = shm::DevicesReader::open(shm::segmentName(options.instance, "devices"));
  const auto* const hand = devices ? (*devices)->hand(options.hand) : nullptr;
  if (devices && !hand)
    return Error{
        Errc::kInvalidArgument,
        fmt::format(
            "--hand: the merlind that runs as \"{}\" has no hand{}; {}", options.instance,
            options.hand.empty() ? "" : fmt::format(" named \"{}\"", printable(options.hand)),
            handsOf(**devices))};
  // Shared memory does not say which tracker a hand follows, so the first tracker is taken. Its
  // health is not read here: if the tracker of a hand sends nothing, the hand sends nothing either.
  const auto* const tracker = devices ? (*devices)->tracker() : nullptr;
  if (devices && !tracker)
    return Error{Errc::kInvalidArgument,
                 fmt::format("the merlind that runs as \"{}\" has no tracker that a hand could "
                             "follow: add one to /devices",
                             options.instance)};
  // If merlind runs without devices, this returns the error that says why.
  auto samples = LiveSamples<HandSample>::open(options.instance, hand ? hand->name : "",
                                               tracker ? tracker->name : "");
  if (!samples) return samples.error();
  return LiveHand{hand->name, static_cast<std::size_t>(hand - (*devices)->hands.data()),
                  *std::move(samples), stop};
}

// Appends the poses of the hand during the next `seconds` to `poses`, turned to the axes of the
// wall and labelled `label`; discards them if `poses` is null. Errors: kClosed (a signal has
// arrived, or merlind has ended), kTimeout (the hand sends nothing).
Result<Ok> listen(LiveHand& hand, double seconds, const nn::WallAxes& axes, std::uint32_t label,
                  std::vector<nn::LabelledPose>* poses) {
  const SystemClock clock;
  const Timestamp began = clock.now();
  Timestamp heard = began;
  while (clock.now() - began < fromSeconds(seconds)) {
    const auto taken = hand.samples.listen([&](const HandSample& s) {
      heard = clock.now();
      // On a busy machine, samples are delivered late; those received before or after the take are
      // skipped.
      const Timestamp received = fromNanoseconds(s.received_ns);
      if (poses && received >= began && received < began + fromSeconds(seconds))
        poses->push_back({label, axes.turned(s.received_ns, s.position_m, s.orientation_wxyz)});
    });
    if (!taken) return Error{taken.error().code, "merlind has ended"};
    if (stopArrived(hand.stop)) return Error{Errc::kClosed, "ended by a signal"};
    if (clock.now() - heard >= kHandPatience)
      return Error{Errc::kTimeout,
                   fmt::format("the hand \"{0}\" has sent nothing for 3 s: see `merlin status` for "
                               "its tracker; /hands/{1}/tracker and /hands/{1}/station say which "
                               "station is worn on it",
                               hand.name, hand.index)};
  }
  return Ok{};
}

// Returns whether the hand was tracked from `from` to `to` without a gap longer than kLongestGap.
bool isSeenThroughout(std::span<const nn::LabelledPose> take, Timestamp from, Timestamp to) {
  Timestamp last = from;
  for (const nn::LabelledPose& p : take) {
    const Timestamp at = fromNanoseconds(p.pose.at_ns);
    if (at - last > kLongestGap) return false;
    last = at;
  }
  return to - last <= kLongestGap;
}

// Checks that a take can be used. Errors: kTimeout (the hand was not tracked all the time); those
// of nn::checkTake(), unless the take is ordinary motion.
Result<Ok> checkTaken(std::span<const nn::LabelledPose> poses, Timestamp began,
                      const GestureRecordOptions& options) {
  if (!isSeenThroughout(poses, began, began + fromSeconds(options.seconds)))
    return Error{Errc::kTimeout,
                 "the hand was not tracked all the time: see its tracker in `merlin status`"};
  if (options.label == nn::kNoGesture) return Ok{};
  return nn::checkTake({{options.label}, {poses.begin(), poses.end()}});
}

// Records one take and appends it to `poses`. An unusable take is repeated, at most
// kMostTriesOfATake attempts in all. Errors: those of listen() and, for the last attempt, of
// checkTaken().
Result<Ok> takeOne(LiveHand& hand, const GestureRecordOptions& options, const nn::WallAxes& axes,
                   std::uint32_t label, std::vector<nn::LabelledPose>& poses) {
  const SystemClock clock;
  for (int tries = 1;; ++tries) {
    if (auto waited = listen(hand, options.pause, axes, label, nullptr); !waited) return waited;
    printError("now: {}\n", options.label);
    std::vector<nn::LabelledPose> take;
    const Timestamp began = clock.now();
    if (auto taken = listen(hand, options.seconds, axes, label, &take); !taken) return taken;
    const auto checked = checkTaken(take, began, options);
    if (checked) {
      poses.insert(poses.end(), take.begin(), take.end());
      return Ok{};
    }
    const std::string& why = checked.error().what;
    if (tries == kMostTriesOfATake)
      return Error{
          checked.error().code,
          fmt::format(
              "hand \"{}\": {} takes in a row could not be used; reason for the last one: {}",
              hand.name, kMostTriesOfATake, why)};
    printError("this take cannot be used: {}\nonce more: hold the hand still ...\n", why);
  }
}

RecordedTakes recordAll(LiveHand& hand, const GestureRecordOptions& options,
                        const nn::WallAxes& axes) {
  RecordedTakes taken;
  const std::uint32_t label = taken.recording.labelled(options.label);
  for (; taken.count < options.times; ++taken.count) {
    printError("{} of {}: hold the hand still ...\n", taken.count + 1, options.times);
    const auto one = takeOne(hand, options, axes, label, taken.recording.poses);
    if (one) continue;
    taken.ended = one.error();
    break;
  }
  return taken;
}

// Checks, before the first take, that the takes can be written. Errors: those of checkWritable()
// and nn::loadPaths(); kInvalidArgument (the file has as many gestures as are allowed).
Result<Ok> checkTakesFile(const GestureRecordOptions& options) {
  if (auto writable = checkWritable(options.output); !writable) return writable;
  if (!std::filesystem::exists(options.output)) return Ok{};
  auto before = nn::loadPaths(options.output);
  if (!before) return before.error();
  before->labelled(options.label);
  if (before->labels.size() <= nn::kMostGestures + 1) return Ok{};
  return Error{
      Errc::kInvalidArgument,
      fmt::format("{}: has {} gestures, as many as are allowed; choose another file with -o",
                  options.output, nn::kMostGestures)};
}

// If the file exists, inserts its takes before those of `recording`, and shifts the times of the
// latter to follow them. Errors: those of nn::loadPaths().
Result<Ok> addTo(nn::PathRecording& recording, const std::string& path) {
  if (!std::filesystem::exists(path)) return Ok{};
  auto before = nn::loadPaths(path);
  if (!before) return before.error();
  const std::int64_t later_ns = before->poses.back().pose.at_ns +
                                static_cast<std::int64_t>(kBetweenFiles_s * 1e9) -
                                recording.poses.front().pose.at_ns;
  for (nn::LabelledPose p : recording.poses) {
    p.label = before->labelled(recording.labels[p.label]);
    p.pose.at_ns += later_ns;
    before->poses.push_back(p);
  }
  recording = *std::move(before);
  return Ok{};
}

// Appends the takes to the output file and prints their number. Errors: those of addTo() and
// nn::savePaths().
Result<Ok> saveTakes(RecordedTakes taken, const GestureRecordOptions& options) {
  const std::size_t poses = taken.recording.poses.size();
  if (auto added = addTo(taken.recording, options.output); !added) return added;
  if (auto saved = nn::savePaths(options.output, taken.recording); !saved) return saved;
  printOut("{}: {} takes of \"{}\" recorded, {} poses; {} poses in all\n", options.output,
           taken.count, options.label, poses, taken.recording.poses.size());
  return Ok{};
}

// Checks the label and returns the axes that the options name. Errors: kInvalidArgument (the label
// or the axes are not valid).
Result<nn::WallAxes> checkedAxes(const GestureRecordOptions& options) {
  if (options.label != nn::kNoGesture && !nn::isGestureName(options.label))
    return Error{Errc::kInvalidArgument,
                 fmt::format("LABEL \"{}\": allowed are 1 to {} letters, digits, - or _",
                             printable(options.label), nn::kLongestGestureName)};
  const auto axes = nn::WallAxes::of({options.axes[0], options.axes[1], options.axes[2]});
  if (axes) return *axes;
  return Error{Errc::kInvalidArgument,
               fmt::format("--axes {}: allowed are the numbers 1, 2 and 3, each once, with or "
                           "without a minus sign, that make a right-handed system, as in "
                           "/wall/scene/tracker_axes",
                           fmt::join(options.axes, " "))};
}

int recordTakes(const GestureRecordOptions& options) {
  const auto axes = checkedAxes(options);
  if (!axes) return fail(axes.error());
  if (const auto fits = checkTakesFile(options); !fits) return fail(fits.error());
  const UniqueFd stop = stopSignals();
  auto hand = openHand(options, stop.get());
  if (!hand) return fail(hand.error());
  RecordedTakes taken = recordAll(*hand, options, *axes);
  if (taken.count > 0) {
    if (const auto saved = saveTakes(taken, options); !saved) return fail(saved.error());
  }
  if (!taken.ended) return kExitDone;
  return fail(
      {taken.ended->code,
       taken.ended->what + (taken.count == 0 ? "; no take was recorded, so nothing was written"
                                             : fmt::format("; {} of {} takes were recorded",
                                                           taken.count, options.times))});
}

}  // namespace

void addGestureRecord(Command gesture, Run& run) {
  const auto options = std::make_shared<GestureRecordOptions>();
  Command command = gesture.subcommand(
      "record",
      "Record takes of one gesture from the tracked hand of a running merlind and append them to a "
      "CSV file: before each take the hand rests, and after \"now\" it makes the gesture once, "
      "briskly. The label none records ordinary motion.\nExample: merlin gesture record wave -o "
      "gestures.csv");
  command.option("label", options->label, "The gesture's name, or none")
      .required()
      .typeName("LABEL");
  command
      .option("--hand", options->hand,
              "Name of the hand in the configuration of merlind; the default is its first hand")
      .typeName("NAME");
  command.option("-o", options->output, "The CSV file").showDefault().typeName("FILE.csv");
  command.option("--times", options->times, "Number of takes")
      .range(std::size_t{1}, std::size_t{1000})
      .showDefault();
  command.option("--seconds", options->seconds, "Duration of each take in seconds")
      .range(0.5, 600.0)
      .showDefault();
  command.option("--pause", options->pause, "Rest before each take in seconds")
      .range(0.6, 60.0)
      .showDefault();
  command
      .option(
          "--axes", options->axes,
          "The tracker's axes that are the wall's x (right), y (up) and z (towards the person), "
          "as in /wall/scene/tracker_axes: 1 is x, 2 is y, 3 is z; negative: the opposite "
          "direction")
      .expected(3)
      .showDefault();
  addInstance(command, options->instance);
  command.callback([options, &run] { run = [options] { return recordTakes(*options); }; });
}

}  // namespace merlin::cli
