// merlin watch: prints the status as one line per second until interrupted.
#include <memory>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"
#include "daemon/cli/wall/status_text.h"
#include "daemon/status/client.h"

namespace merlin::cli {
namespace {

struct WatchOptions {
  std::string instance = "merlin";
  double seconds = 0;
  bool json = false;
};

// Each role publishes its status every second. Prints a line after every N documents, where N is
// the number of roles.
int watch(const WatchOptions& options) {
  const auto roles = findRoles(options.instance);
  if (!roles) return fail(roles.error());
  std::vector<std::string> endpoints;
  for (const FoundRole& role : *roles) endpoints.push_back(role.endpoints.status);
  const SystemClock clock;
  const Timestamp began = clock.now();
  nlohmann::ordered_json both = nlohmann::ordered_json::object();
  std::size_t documents = 0;
  const auto followed = status::follow(
      endpoints, {"status"}, std::chrono::seconds(3),
      [&](const std::string&, const std::string& document) {
        mergeStatus(both, document);
        if (++documents % roles->size() == 0) {
          printOut("{}\n", options.json ? both.dump() : statusLine(both));
          std::fflush(stdout);
        }
        return options.seconds <= 0 || toSeconds(clock.now() - began) < options.seconds;
      });
  if (!followed)
    return fail({followed.error().code, "the daemon has ended: " + followed.error().what});
  return kExitDone;
}

}  // namespace

void addWatch(Command app, Run& run) {
  const auto options = std::make_shared<WatchOptions>();
  Command command =
      app.subcommand("watch",
                     "Print one line per second: actual and desired rate, triangles, late frames, "
                     "posture, devices.\nExample: merlin watch --for 20");
  addInstance(command, options->instance);
  command.option("--for", options->seconds, "Duration in seconds; the default is until interrupted")
      .seconds();
  command.flag("--json", options->json, "Print one JSON document per line");
  command.callback([options, &run] { run = [options] { return watch(*options); }; });
}

}  // namespace merlin::cli
