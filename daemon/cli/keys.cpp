// merlin keys: a pair of keys for a daemon that speaks over a network.
#include <memory>

#include <fmt/format.h>
#include <sys/stat.h>

#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/status/curve.h"

namespace merlin::cli {
namespace {

int makeKeys(const std::string& path) {
  struct stat status {};
  // Whatever it is: a file that may not be read, a link that leads nowhere.
  if (::lstat(path.c_str(), &status) == 0) {
    return fail({Errc::kInvalidArgument,
                 path + ": is there already; a new pair would lock out whoever knows the old one"});
  }
  const auto keys = status::makeKeyPair();
  if (!keys) return fail(keys.error());
  if (const auto written = status::writeKeyPair(path, *keys); !written)
    return fail(written.error());
  say("{}\n", keys->public_key);
  return kExitDone;
}

}  // namespace

void addKeys(Command app, Run& run) {
  const auto path = std::make_shared<std::string>();
  Command command = app.subcommand(
      "keys",
      "A pair of keys, for samples over a network: the file stays here, the public key that is "
      "printed goes to the other side.\nExample: merlin keys -o /etc/merlin/wall.keys");
  command.option("-o,--output", *path, "The file, readable by its owner alone").required();
  command.callback([path, &run] { run = [path] { return makeKeys(*path); }; });
}

}  // namespace merlin::cli
