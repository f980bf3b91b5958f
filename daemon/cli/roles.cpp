#include "daemon/cli/roles.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>

#include "daemon/cli/allowed.h"
#include "daemon/status/client.h"

namespace merlin::cli {
namespace {

constexpr std::string_view kIpc = "ipc://";

// Returns the role if it runs. `denied` is set if its shared memory exists but cannot be read.
template <typename Segment>
std::optional<FoundRole> find(const std::string& instance, const char* role,
                              std::optional<Error>& denied) {
  const std::string name = shm::segmentName(instance, role);
  const auto segment = shm::SegmentReader<Segment>::open(name);
  if (!segment && segment.error().code == Errc::kIo) denied = segment.error();
  // On a machine that is too busy the heartbeat may be late; the lock says that it still runs, to
  // the same user.
  if (!segment || !(segment->alive(SystemClock().now()) || SharedMemory::owned(name)))
    return std::nullopt;
  const shm::Header& h = (*segment)->header;
  // Without an endpoint the segment is a copy of another machine's devices, and no process on this
  // machine executes their commands.
  if (h.command_endpoint[0] == '\0') return std::nullopt;
  return FoundRole{role, {h.status_endpoint, h.command_endpoint}, h.pid};
}

}  // namespace

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
               fmt::format("process {} is no merlind that reads devices or draws a wall", pid)};
}

Result<std::string> askRole(const std::string& instance, const std::string& role,
                            const RoleRequest& request) {
  const auto roles = findRoles(instance);
  if (!roles) return roles.error();
  for (const FoundRole& found : *roles) {
    if (found.role != role) continue;
    // ZeroMQ would try again until the patience is over.
    const std::string_view endpoint = found.endpoints.command;
    if (endpoint.starts_with(kIpc)) {
      const auto allowed = checkAllowed(std::string(endpoint.substr(kIpc.size())));
      if (!allowed) return allowed.error();
    }
    return status::ask(found.endpoints.command, request.command, request.patience,
                       request.argument);
  }
  return Error{Errc::kIo, role == "wall"
                              ? fmt::format("no merlind shows a wall as \"{}\"", instance)
                              : fmt::format("merlind \"{}\" runs without devices", instance)};
}

}  // namespace merlin::cli
