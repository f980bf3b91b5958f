// merlin flight: has the daemon write the bytes of every device from the last minutes to files.
#include <memory>

#include <nlohmann/json.hpp>

#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"

namespace merlin::cli {
namespace {

int flight(const std::string& instance) {
  const auto files = askRole(instance, "devices", {"flight", "", std::chrono::seconds(10)});
  if (!files) return fail(files.error());
  for (const auto& file : nlohmann::json::parse(*files, nullptr, false))
    printOut("{}\n", file.get<std::string>());
  return kExitDone;
}

}  // namespace

void addFlight(Command app, Run& run) {
  const auto instance = std::make_shared<std::string>("merlin");
  Command command = app.subcommand(
      "flight",
      "Make the daemon write the bytes of the last minutes of every device's line to files, one "
      "transcript per device. The daemon also does so automatically after a fault.\nExample: "
      "merlin "
      "flight, then: merlin replay FILE --link /tmp/device");
  addInstance(command, *instance);
  command.callback([instance, &run] { run = [instance] { return flight(*instance); }; });
}

}  // namespace merlin::cli
