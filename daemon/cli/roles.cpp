#include "daemon/cli/roles.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "daemon/base/printable_text.h"
#include "daemon/base/tcp_address.h"
#include "daemon/cli/allowed.h"

namespace merlin::cli {
namespace {

constexpr std::string_view kIpc = "ipc://";

// Returns the role if it runs on this machine; nothing otherwise. `denied` is set to the error if
// its shared memory exists but cannot be read.
template <typename Segment>
std::optional<FoundRole> find(const std::string& instance, const char* role,
                              std::optional<Error>& denied) {
  const std::string name = shm::segmentName(instance, role);
  const auto segment = shm::SegmentReader<Segment>::open(name);
  if (!segment && segment.error().code == Errc::kIo) denied = segment.error();
  if (!segment || !shm::isRunning(name, (*segment)->header, SystemClock().now()))
    return std::nullopt;
  const shm::Header& h = (*segment)->header;
  // Without an endpoint, the segment is the wall's copy of the devices of another machine, and no
  // process on this machine has this role.
  if (h.command_endpoint[0] == '\0') return std::nullopt;
  return FoundRole{role, {h.status_endpoint, h.command_endpoint}, h.pid, h.generation};
}

template <typename Segment>
std::optional<LostRole> findLost(const std::string& instance, const char* role) {
  const std::string name = shm::segmentName(instance, role);
  const auto segment = shm::SegmentReader<Segment>::open(name);
  if (!segment) return std::nullopt;
  const shm::Header& h = (*segment)->header;
  const Timestamp now = SystemClock().now();
  // Without an endpoint, the segment is the wall's copy of the devices of another machine.
  if (h.command_endpoint[0] == '\0' || shm::isRunning(name, h, now)) return std::nullopt;
  const Timestamp last = fromNanoseconds(h.heartbeat_ns.load(std::memory_order_relaxed));
  return LostRole{role, now - last, isMerlind(h.pid) ? h.pid : 0};
}

// Returns the public key of the other daemon. `given`: the key, or the name of a file that has
// exactly one public key. Errors: kInvalidArgument.
Result<std::string> serverKey(const std::string& given) {
  if (status::isKey(given)) return given;
  const auto keys = status::readPublicKeys(given);
  if (!keys) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("--server-key: \"{}\" is neither a public key (40 characters, as "
                             "merlin keys prints it) nor a file with one: {}",
                             excerpt(given), keys.error().what)};
  }
  if (keys->size() == 1) return keys->front();
  return Error{
      Errc::kInvalidArgument,
      fmt::format("--server-key: {}: has {} public keys; one is needed", given, keys->size())};
}

// Returns the keys for a daemon on another machine, after checking its endpoints. Errors:
// kInvalidArgument (keys are missing, or an endpoint is not valid); those of readKeyPair().
Result<status::ClientKeys> clientKeys(const DaemonAddress& daemon) {
  if (daemon.keys.empty() || daemon.server_key.empty()) {
    return Error{Errc::kInvalidArgument,
                 "--endpoint also needs --keys FILE (merlin keys -o FILE makes it) and "
                 "--server-key KEY, since commands over a network are encrypted"};
  }
  for (const std::string& endpoint : daemon.endpoints) {
    const auto address = parseTcpAddress(endpoint);
    if (address && address->host != "*") continue;
    return Error{Errc::kInvalidArgument,
                 fmt::format("--endpoint: \"{}\" is not tcp://HOST:PORT, PORT 1 to 65535",
                             excerpt(endpoint))};
  }
  auto own = status::readKeyPair(daemon.keys);
  if (!own) return own.error();
  auto server = serverKey(daemon.server_key);
  if (!server) return server.error();
  return status::ClientKeys{*std::move(server), *std::move(own)};
}

// Asks the daemon at this address for its role; empty if the answer does not say it. Errors: those
// of status::ask().
Result<std::string> roleAt(const FoundRole& found, Duration patience) {
  const auto status = status::ask(found.commands(), "status", patience);
  if (!status) return status.error();
  const auto json = nlohmann::json::parse(*status, nullptr, false);
  const auto role = json.is_object() ? json.find("role") : json.end();
  return role != json.end() && role->is_string() ? role->get<std::string>() : std::string();
}

}  // namespace

std::string DaemonAddress::name() const {
  return isRemote() ? fmt::format("{}", fmt::join(endpoints, ", ")) : instance;
}

Result<std::vector<FoundRole>> findRoles(const std::string& instance) {
  std::vector<FoundRole> roles;
  std::optional<Error> denied;
  if (auto role = find<shm::WallSegment>(instance, "wall", denied)) roles.push_back(*role);
  if (auto role = find<shm::DevicesSegment>(instance, "devices", denied)) roles.push_back(*role);
  if (!roles.empty()) return roles;
  if (denied) return *denied;
  return Error{Errc::kIo, fmt::format("no merlind runs as \"{0}\" (there is no shared memory "
                                      "/{0}-wall or /{0}-devices of a running merlind)",
                                      instance)};
}

std::string LostRole::what() const {
  const double silent_s = toSeconds(silent);
  if (pid == 0) return fmt::format("does not run; it ended {:.0f} s ago", silent_s);
  return fmt::format("hangs; the last sign of life of its process, {}, was {:.0f} s ago", pid,
                     silent_s);
}

std::vector<LostRole> lostRoles(const std::string& instance) {
  std::vector<LostRole> lost;
  if (auto role = findLost<shm::WallSegment>(instance, "wall")) lost.push_back(*std::move(role));
  if (auto role = findLost<shm::DevicesSegment>(instance, "devices"))
    lost.push_back(*std::move(role));
  return lost;
}

Result<std::vector<FoundRole>> findRoles(const DaemonAddress& daemon) {
  if (!daemon.isRemote()) return findRoles(daemon.instance);
  const auto keys = clientKeys(daemon);
  if (!keys) return keys.error();
  std::vector<FoundRole> roles;
  for (const std::string& endpoint : daemon.endpoints)
    roles.push_back({"", {"", endpoint}, 0, 0, *keys});
  return roles;
}

// Recognises merlind by its command line, or by its process name while the command line is empty,
// as for a moment during exec(). A program that was started by the link /proc/self/exe has the name
// "exe" until it renames itself (ProgramRestart). Zombies, whose command line is empty too, do not
// count.
bool isMerlind(std::uint32_t pid) {
  std::string program, state;  // "1234 (merlind) S ..."
  std::getline(std::ifstream(fmt::format("/proc/{}/cmdline", pid)), program, '\0');
  if (!program.empty()) return std::filesystem::path(program).filename() == "merlind";
  std::getline(std::ifstream(fmt::format("/proc/{}/stat", pid)), state);
  const bool is_named =
      state.find("(merlind) ") != std::string::npos || state.find("(exe) ") != std::string::npos;
  return is_named && state.find(") Z ") == std::string::npos;
}

Result<std::string> instanceOf(std::uint32_t pid) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm", error)) {
    const std::string name = entry.path().filename().string();
    const std::size_t dash = name.rfind('-');
    if (dash == std::string::npos ||
        (name.substr(dash) != "-wall" && name.substr(dash) != "-devices"))
      continue;
    const auto roles = findRoles(name.substr(0, dash));
    if (roles && std::ranges::any_of(*roles, [&](const FoundRole& r) { return r.pid == pid; }))
      return name.substr(0, dash);
  }
  return Error{Errc::kIo,
               fmt::format("process {} is not a merlind that reads devices or draws a wall", pid)};
}

Result<Ok> checkMayAsk(std::string_view endpoint) {
  if (!endpoint.starts_with(kIpc)) return Ok{};
  return checkAllowed(std::string(endpoint.substr(kIpc.size())));
}

Result<std::string> askRole(const std::string& instance, const std::string& role,
                            const RoleRequest& request) {
  const auto roles = findRoles(instance);
  if (!roles) return roles.error();
  for (const FoundRole& found : *roles) {
    if (found.role != role) continue;
    if (const auto allowed = checkMayAsk(found.endpoints.command); !allowed) return allowed.error();
    return status::ask(found.endpoints.command, request.command, request.patience,
                       request.argument);
  }
  return Error{Errc::kIo, role == "wall"
                              ? fmt::format("no merlind shows a wall as \"{}\"", instance)
                              : fmt::format("merlind \"{}\" runs without devices", instance)};
}

Result<std::string> askRole(const DaemonAddress& daemon, const std::string& role,
                            const RoleRequest& request) {
  if (!daemon.isRemote()) return askRole(daemon.instance, role, request);
  const auto roles = findRoles(daemon);
  if (!roles) return roles.error();
  for (const FoundRole& found : *roles) {
    if (roles->size() > 1) {
      const auto there = roleAt(found, request.patience);
      if (!there) return there.error();
      if (*there != role) continue;
    }
    return status::ask(found.commands(), request.command, request.patience, request.argument);
  }
  return Error{
      Errc::kInvalidArgument,
      fmt::format("{}: none of these endpoints belongs to the role {}", daemon.name(), role)};
}

}  // namespace merlin::cli
