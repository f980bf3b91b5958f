// merlin show: shows a content of the configuration, or a file that is not in it.
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/base/fixed_text.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"
#include "daemon/shm/segment.h"

namespace merlin::cli {
namespace {

struct ShowOptions {
  std::string instance = "merlin";
  std::string what;
  double wait_s = 60;
};

constexpr Duration kLook = std::chrono::milliseconds(5);

// What became of a request, once the wall says and has shown another frame; nothing before the end
// of the time to wait.
std::optional<shm::WallContent> awaitDone(const ShowOptions& options, std::uint32_t request) {
  const auto segment =
      shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(options.instance, "wall"));
  SystemClock clock;
  const Timestamp until = clock.now() + fromSeconds(options.wait_s);
  std::optional<std::uint64_t> frame;
  for (; segment && clock.now() < until; clock.sleepUntil(clock.now() + kLook, {})) {
    const auto content = (*segment)->content.read();
    const auto stats = (*segment)->stats.read();
    if (!content || !stats || content->finished < request) continue;
    if (!frame) frame = stats->frames;
    if (content->refused[0] != '\0' || stats->frames > *frame) return content;
  }
  return std::nullopt;
}

int show(const ShowOptions& options) {
  // The name of a content comes first; a file is named by its whole path.
  std::error_code error;
  const bool file = options.what.find('/') != std::string::npos ||
                    std::filesystem::path(options.what).has_extension();
  const std::string whole = std::filesystem::absolute(options.what, error).string();
  const bool there = std::filesystem::exists(whole, error);
  const auto asked =
      askRole(options.instance, "wall", {"show", file && there ? whole : options.what});
  if (!asked) return fail(asked.error());
  const auto answer = nlohmann::json::parse(*asked, nullptr, false);
  const auto done = awaitDone(options, answer.value("request", std::uint32_t{0}));
  if (!done) {
    return fail({Errc::kTimeout, fmt::format("{} is not shown after {} s; merlin status says what "
                                             "the wall does",
                                             options.what, options.wait_s)});
  }
  const std::string refused(textIn(done->refused));
  if (!refused.empty()) return fail({Errc::kMalformed, refused});
  return kExitDone;
}

}  // namespace

void addShow(Command app, Run& run) {
  const auto options = std::make_shared<ShowOptions>();
  Command command = app.subcommand(
      "show",
      "Show a content on the wall: one of the configuration by its name, or any model (.mrm), "
      "picture or panorama (.tif, of merlin image import) or folder of pictures that merlind may "
      "read. Returns when it is shown.\n"
      "Example: merlin show panorama.tif");
  addInstance(command, options->instance);
  command.option("what", options->what, "Name of a content, a file or a folder")
      .required()
      .typeName("NAME|FILE");
  command.option("--wait", options->wait_s, "Longest time to wait until it is shown, in seconds")
      .seconds()
      .showDefault();
  command.callback([options, &run] { run = [options] { return show(*options); }; });
}

}  // namespace merlin::cli
