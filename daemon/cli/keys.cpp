// merlin keys: makes a key pair for a daemon that communicates over a network.
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
  // lstat(), so that an unreadable file or a dangling link counts as existing too.
  if (::lstat(path.c_str(), &status) == 0) {
    return fail({Errc::kInvalidArgument, path + ": exists already; a new key pair would lock out "
                                                "everyone who knows the old public key"});
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
      "Make a key pair for samples over a network. The file stays on this machine; the public key, "
      "which is printed, goes to the other side.\nExample: merlin keys -o /etc/merlin/wall.keys");
  command.option("-o,--output", *path, "Name of the key file; only its owner can read it")
      .required();
  command.callback([path, &run] { run = [path] { return makeKeys(*path); }; });
}

}  // namespace merlin::cli
