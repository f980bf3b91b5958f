// merlin keys: creates a key pair for samples and commands over a network.
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
  // lstat() also finds files that cannot be read and dangling links, which count as existing.
  if (::lstat(path.c_str(), &status) == 0) {
    return fail({Errc::kInvalidArgument, path +
                                             ": exists already; with a new key pair, machines that "
                                             "know the old public key could not connect"});
  }
  const auto keys = status::makeKeyPair();
  if (!keys) return fail(keys.error());
  if (const auto written = status::writeKeyPair(path, *keys); !written)
    return fail(written.error());
  printOut("{}\n", keys->public_key);
  return kExitDone;
}

}  // namespace

void addKeys(Command app, Run& run) {
  const auto path = std::make_shared<std::string>();
  Command command = app.subcommand(
      "keys",
      "Create a key pair for encrypted samples and commands over a network. The key file stays on "
      "this machine; the public key, which is printed, is for the other machine.\n"
      "Example: merlin keys -o /etc/merlin/wall.keys");
  command.option("-o,--output", *path, "Name of the key file, which only its owner can read")
      .required();
  command.callback([path, &run] { run = [path] { return makeKeys(*path); }; });
}

}  // namespace merlin::cli
