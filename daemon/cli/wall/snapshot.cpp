// merlin snapshot: writes the current picture of the wall as a PNG file.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"
#include "daemon/shm/segment.h"
#include "render/image/png_writer.h"
#include "render/out/shared_frame.h"

namespace merlin::cli {
namespace {

struct SnapshotOptions {
  std::string instance = "merlin";
  std::string file, output;
  bool wall = false;
};

constexpr Duration kSnapshotPollPeriod = std::chrono::milliseconds(5);
constexpr Duration kSnapshotPatience = std::chrono::seconds(5);

// Requests the next signal of an output and returns it; merlind writes it into shared memory.
// Errors: those of askRole() and captureFrame(); kTimeout.
Result<render::out::CapturedFrame> signalOf(const SnapshotOptions& options) {
  const auto answer = askRole(options.instance, "wall", {"signal", options.output});
  if (!answer) return answer.error();
  const auto json = nlohmann::json::parse(*answer, nullptr, false);
  const std::string segment = json.value("shared_memory", "");
  const auto after = json.value("after", std::uint64_t{0});
  SystemClock clock;
  for (const Timestamp until = clock.now() + kSnapshotPatience; clock.now() < until;) {
    auto frame = render::out::captureFrame(segment);
    if (!frame && frame.error().code != Errc::kTimeout) return frame;
    if (frame && frame->info.sequence > after) return frame;
    clock.sleepUntil(clock.now() + kSnapshotPollPeriod, {});
  }
  return Error{Errc::kTimeout, fmt::format("merlind shows no frame of output {} within {:.0f} s",
                                           options.output, toSeconds(kSnapshotPatience))};
}

// Checks that the wall has not been lost, because the frame in shared memory would then be out of
// date. Errors: kIo.
Result<Ok> checkWallRuns(const std::string& instance) {
  for (const LostRole& lost : lostRoles(instance)) {
    if (lost.role != "wall") continue;
    return Error{Errc::kIo,
                 fmt::format("the wall of \"{}\" {}; nothing was written, since its last "
                             "frame is not what it shows now",
                             instance, lost.what())};
  }
  return Ok{};
}

Result<render::out::CapturedFrame> frameOf(const SnapshotOptions& options) {
  if (const auto runs = checkWallRuns(options.instance); !runs) return runs.error();
  if (!options.output.empty()) return signalOf(options);
  auto frame = render::out::captureFrame(shm::segmentName(options.instance, "framebuffer"));
  if (!frame && frame.error().code == Errc::kNotFound) {
    return Error{Errc::kIo, fmt::format("no merlind shows a wall as \"{}\": {}", options.instance,
                                        frame.error().what)};
  }
  if (!frame || !options.wall) return frame;
  *frame = render::out::wallPicture(*frame);
  if (!frame->pixels.empty()) return frame;
  if (frame->width > 0) {
    return Error{Errc::kUnsupported,
                 fmt::format("the wall's tiles in rows and columns are {} x {} pixels; at most {} "
                             "pixels can be written; leave --wall out to write the frame",
                             frame->width, frame->height, render::out::kMostWallPixels)};
  }
  return Error{Errc::kUnsupported, "this wall has no tile of kind wall, only the operator's view"};
}

int snapshot(const SnapshotOptions& options) {
  if (const auto named = checkEnding(options.file, "picture", ".png"); !named)
    return fail(named.error());
  const auto frame = frameOf(options);
  if (!frame) return fail(frame.error());
  const auto written =
      render::image::writePng(options.file, frame->width, frame->height, frame->pixels);
  if (!written) return fail(written.error());
  printOut("{}: {} x {}, frame {}, detail of cost {}{}\n", options.file, frame->width,
           frame->height, frame->info.sequence, frame->info.cost,
           frame->info.full_detail ? ", full detail" : "");
  return kExitDone;
}

}  // namespace

void addSnapshot(Command app, Run& run) {
  const auto options = std::make_shared<SnapshotOptions>();
  Command command =
      app.subcommand("snapshot",
                     "Write what the wall shows now as a PNG file: the frame, the wall's tiles, or "
                     "the signal that "
                     "an output is sent.\nExample: merlin snapshot --output left -o left.png");
  addInstance(command, options->instance);
  command.option("-o", options->file, "The PNG file").required().typeName("FILE.png");
  Command what = command.group("What to write", "Without these the whole frame");
  what.flag("--wall", options->wall,
            "Only the tiles of the wall, in rows and columns as they hang, without the "
            "operator's view");
  what.option(
          "--output", options->output,
          "The next signal of this output, after its correction, whatever its kind; its name is "
          "in merlin status")
      .typeName("NAME");
  what.atMostOne();
  command.callback([options, &run] { run = [options] { return snapshot(*options); }; });
}

}  // namespace merlin::cli
