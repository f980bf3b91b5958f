#include "daemon/cli/wall/trace.h"

#include <algorithm>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/wall/trace_json.h"
#include "daemon/shm/segment.h"

namespace merlin::cli {
namespace {

struct TraceOptions {
  std::string instance = "merlin";
  std::string output;
  double seconds = 5;
};

// Returns the traces of the last frames that cover the time `wanted`: those in shared memory and,
// if these cover less, the following ones. Errors: kTimeout (no frame for 2 s).
Result<std::vector<shm::FrameTrace>> collect(const shm::WallSegment& wall, Duration wanted) {
  std::vector<shm::FrameTrace> frames;
  const std::uint64_t have = wall.trace.count();
  std::uint64_t next = have > shm::kHistory - 1 ? have - (shm::kHistory - 1) : 0;
  const SystemClock clock;
  const auto covered = [&] {
    return frames.empty() ? Duration{} : Duration(frames.back().end_ns - frames.front().begin_ns);
  };
  for (Timestamp heard = clock.now(); next < have || frames.empty() || covered() < wanted;) {
    if (next == wall.trace.count()) {
      if (clock.now() - heard > std::chrono::seconds(2))
        return Error{Errc::kTimeout, "the wall has drawn nothing for 2 s"};
      wall.trace.wait(next, {0, 100'000'000});
      continue;
    }
    if (const auto frame = wall.trace.at(next)) frames.push_back(*frame);
    ++next;
    heard = clock.now();
  }
  if (wanted == Duration{}) return frames;
  const std::int64_t from = frames.back().end_ns - wanted.count();
  const auto first = std::find_if(frames.begin(), frames.end() - 1,
                                  [&](const shm::FrameTrace& f) { return f.begin_ns >= from; });
  frames.erase(frames.begin(), first);
  return frames;
}

template <typename T>
void addSamples(const shm::Channel<T>& channel, const std::string& device,
                std::span<const shm::FrameTrace> frames, std::vector<SampleInstant>& out) {
  const std::uint64_t count = channel.count();
  for (std::uint64_t n = count > shm::kHistory - 1 ? count - (shm::kHistory - 1) : 0; n < count;
       ++n) {
    const auto sample = channel.at(n);
    if (sample && sample->received_ns >= frames.front().begin_ns &&
        sample->received_ns <= frames.back().end_ns)
      out.push_back({device, sample->received_ns});
  }
}

// Adds the times of the samples of all devices. Of a tracker, only the first station that has sent
// any is used, because all stations send at the same time.
void addDevices(const shm::DeviceSlots& devices, std::span<const shm::FrameTrace> frames,
                std::vector<SampleInstant>& out) {
  for (const auto& glove : devices.gloves) addSamples(*glove.samples, glove.name, frames, out);
  for (const auto& tracker : devices.trackers) {
    for (const auto* station : tracker.stations) {
      if (station->count() == 0) continue;
      addSamples(*station, tracker.name, frames, out);
      break;
    }
  }
  for (const auto& ball : devices.balls) addSamples(*ball.samples, ball.name, frames, out);
  for (const auto& touch : devices.touches) addSamples(*touch.samples, touch.name, frames, out);
}

int trace(const TraceOptions& options) {
  const auto recorded = recordTrace(options.instance, fromSeconds(options.seconds));
  if (!recorded) return fail(recorded.error());
  if (const auto written = writeFile(options.output, recorded->json); !written)
    return fail(written.error());
  printOut("{}: {} frames, {} samples; open it in ui.perfetto.dev or chrome://tracing\n",
           options.output, recorded->frames, recorded->samples);
  return kExitDone;
}

}  // namespace

Result<WallTrace> recordTrace(const std::string& instance, Duration wanted) {
  const auto wall = shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(instance, "wall"));
  if (!wall) {
    return Error{Errc::kIo,
                 fmt::format("no merlind shows a wall as \"{}\": {}", instance, wall.error().what)};
  }
  const auto frames = collect(**wall, wanted);
  if (!frames) return frames.error();
  std::vector<SampleInstant> samples;
  const auto devices = shm::DevicesReader::open(shm::segmentName(instance, "devices"));
  if (devices) addDevices(**devices, *frames, samples);
  return WallTrace{traceJson(*frames, samples), frames->size(), samples.size()};
}

void addTrace(Command app, Run& run) {
  const auto options = std::make_shared<TraceOptions>();
  Command command =
      app.subcommand("trace",
                     "Write the time that each step of the last frames took, for a trace viewer.\n"
                     "Example: merlin trace -o trace.json --seconds 5");
  addInstance(command, options->instance);
  command.option("-o", options->output, "The trace file").required().typeName("FILE.json");
  command
      .option("--seconds", options->seconds,
              "Duration of the trace in seconds; if the stored frames cover less, waits for more")
      .range(0.1, 600.0)
      .showDefault();
  command.callback([options, &run] { run = [options] { return trace(*options); }; });
}

}  // namespace merlin::cli
