#include "daemon/cli/remote.h"

namespace merlin::cli {

RemoteOptions::RemoteOptions(Command app) {
  app.option(
         "--endpoint", address_.endpoints,
         "Speak with a merlind on another machine, encrypted: the address tcp://HOST:PORT of its "
         "role, as "
         "/serve/wall_endpoint or /serve/devices_endpoint of its configuration sets it. May be "
         "given once for each role. For status, watch and the commands that have no other "
         "options.\n"
         "Example: merlin --endpoint tcp://wall.lab:7402 --keys my.keys --server-key wall.public "
         "status")
      .repeatable()
      .typeName("ADDRESS");
  app.option("--keys", address_.keys, "File with our own key pair, which merlin keys -o FILE makes")
      .typeName("FILE");
  app.option("--server-key", address_.server_key,
             "Public key of that merlind, or a file that has it")
      .typeName("KEY|FILE");
}

DaemonAddress RemoteOptions::daemon(const std::string& instance) {
  used_ = true;
  DaemonAddress daemon = address_;
  daemon.instance = instance;
  return daemon;
}

Result<Ok> RemoteOptions::check() const {
  if (used_ && address_.isRemote()) return Ok{};
  if (!address_.isRemote() && address_.keys.empty() && address_.server_key.empty()) return Ok{};
  if (!address_.isRemote())
    return Error{Errc::kInvalidArgument, "--keys and --server-key need --endpoint"};
  return Error{Errc::kInvalidArgument,
               "--endpoint is only for status, watch and the commands that have no other options, "
               "such as blank; run this one on the other machine"};
}

}  // namespace merlin::cli
