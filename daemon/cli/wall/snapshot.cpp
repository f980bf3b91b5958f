// merlin snapshot: writes the frame that the wall shows now as a PNG file.
#include <memory>

#include <fmt/format.h>

#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/shm/segment.h"
#include "render/image/png_writer.h"
#include "render/out/shared_frame.h"

namespace merlin::cli {
namespace {

struct SnapshotOptions {
  std::string instance = "merlin";
  std::string output;
  bool wall = false;
};

int snapshot(const SnapshotOptions& options) {
  if (const auto named = checkEnding(options.output, "picture", ".png"); !named)
    return fail(named.error());
  auto frame = render::captureFrame(shm::segmentName(options.instance, "framebuffer"));
  if (!frame && frame.error().code == Errc::kNotFound) {
    return fail({Errc::kIo, fmt::format("no merlind shows a wall as \"{}\": {}", options.instance,
                                        frame.error().what)});
  }
  if (!frame) return fail(frame.error());
  if (options.wall) *frame = render::wallPicture(*frame);
  if (frame->pixels.empty())
    return fail({Errc::kUnsupported, "this wall has no tiles but the operator's view"});
  const auto written = render::writePng(options.output, frame->width, frame->height, frame->pixels);
  if (!written) return fail(written.error());
  say("{}: {} x {}, frame {}, {} triangles{}\n", options.output, frame->width, frame->height,
      frame->info.sequence, frame->info.cost, frame->info.full_detail ? ", full detail" : "");
  return kExitDone;
}

}  // namespace

void addSnapshot(Command app, Run& run) {
  const auto options = std::make_shared<SnapshotOptions>();
  Command command = app.subcommand("snapshot",
                                   "Write the frame that the wall shows now as a PNG "
                                   "file.\nExample: merlin snapshot -o frame.png");
  addInstance(command, options->instance);
  command.option("-o", options->output, "The PNG file").required().typeName("FILE.png");
  command.flag("--wall", options->wall,
               "Only the wall's tiles, side by side, without the operator's view");
  command.callback([options, &run] { run = [options] { return snapshot(*options); }; });
}

}  // namespace merlin::cli
