// merlin wall testcard: shows a test card instead of the wall's picture.
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"
#include "daemon/cli/wall/align.h"
#include "daemon/cli/wall/aligned_wall.h"
#include "daemon/shm/segment.h"
#include "render/testcard/card.h"

namespace merlin::cli {
namespace {

struct CardOptions {
  std::string instance = "merlin";
  std::string card;
};

constexpr Duration kTestcardPollPeriod = std::chrono::milliseconds(5);
constexpr Duration kTestcardPatience = std::chrono::seconds(2);

// Waits until the wall has shown another frame after `frame`, so that the card is visible when the
// command ends.
void awaitFrameAfter(const std::string& instance, std::uint64_t frame) {
  const auto segment =
      shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(instance, "wall"));
  SystemClock clock;
  for (const Timestamp until = clock.now() + kTestcardPatience; segment && clock.now() < until;) {
    const auto stats = (*segment)->stats.read();
    if (stats && stats->frames > frame) return;
    clock.sleepUntil(clock.now() + kTestcardPollPeriod, {});
  }
}

int testcard(const CardOptions& options) {
  if (options.card == "list") {
    for (const char* const name : render::testcard::kCardNames) fmt::print("{}\n", name);
    return kExitDone;
  }
  const auto asked = askRole(options.instance, "wall", {"testcard", options.card});
  if (!asked) return fail(wallsReason(asked.error(), "testcard"));
  const auto answer = nlohmann::json::parse(*asked, nullptr, false);
  awaitFrameAfter(options.instance, answer.value("after", std::uint64_t{0}));
  return kExitDone;
}

}  // namespace

void addTestcard(Command wall, Run& run) {
  const auto options = std::make_shared<CardOptions>();
  Command command = wall.subcommand(
      "testcard",
      "Show a test card on all tiles, corrected as the picture is. grid: geometry; edges: the "
      "outermost pixels, corners and strips of overlap; ramps: grey, red, green, blue along the "
      "whole screen; names: which output is which, and what is up; focus: single pixels and "
      "Siemens stars; black, grey, white: nothing else, to see where outputs overlap; off: the "
      "picture again; list: print the names of all cards. A restart ends it too.\n"
      "Example: merlin wall testcard grid");
  addInstance(command, options->instance);
  command.option("card", options->card, "Name of the card, off or list")
      .required()
      .typeName(fmt::format("{}|off|list", fmt::join(render::testcard::kCardNames, "|")));
  command.callback([options, &run] { run = [options] { return testcard(*options); }; });
}

}  // namespace merlin::cli
