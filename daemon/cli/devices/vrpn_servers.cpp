#include "daemon/cli/devices/vrpn_servers.h"

#include <algorithm>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "drivers/io/open_stream.h"
#include "drivers/port/port_address.h"
#include "drivers/vrpn/ask_server.h"
#include "drivers/vrpn/identity.h"

namespace merlin::cli {
namespace {

constexpr const char* kUsualHere = "tcp://127.0.0.1:3883";
// Time that threads have, after their deadline, to store their answers.
constexpr Duration kGrace = std::chrono::milliseconds(100);

// State that askServers() shares with its threads, which may outlive the call.
struct Round {
  std::mutex mutex;
  std::condition_variable ended;
  // One per server, in the order of the ports, with the fault "no answer ..." until the server
  // answers.
  std::vector<VrpnAnswer> answers;
  std::size_t open = 0;  // number of threads that have not ended
};

// Returns the text of the error without the server's port, with which it may begin.
std::string faultOf(const Error& error, const PortAddress& at) {
  const std::string prefix = fmt::format("tcp://{}:{}: ", at.path, at.service);
  return error.what.starts_with(prefix) ? error.what.substr(prefix.size()) : error.what;
}

void ask(const PortAddress& at, Timestamp until, VrpnAnswer& answer) {
  const SystemClock clock;
  const auto stream = io::openPort(at, 0);
  if (!stream) {
    answer.fault = faultOf(stream.error(), at);
    if (answer.port == kUsualHere)  // this server is always asked, even if nobody named it
      answer.fault += "; no VRPN server runs on this machine";
    return;
  }
  const auto asked = vrpn::askServer(**stream, clock, until, answer.catalog);
  if (!asked && asked.error().code != Errc::kTimeout) answer.fault = faultOf(asked.error(), at);
  if (asked) answer.fault.clear();
}

void startAsking(const std::shared_ptr<Round>& round, std::size_t index, Timestamp until) {
  const auto at = parsePort(round->answers[index].port);
  if (!at) return;
  std::thread([round, index, at = *at, until, answer = round->answers[index]]() mutable {
    ask(at, until, answer);
    const std::scoped_lock lock(round->mutex);
    round->answers[index] = std::move(answer);
    --round->open;
    round->ended.notify_one();
  }).detach();
  ++round->open;
}

}  // namespace

std::optional<std::string> vrpnPort(const std::string& text) {
  const std::string scheme = "tcp://";
  const std::string host = text.starts_with(scheme) ? text.substr(scheme.size()) : text;
  const bool alone = host.ends_with(']') || host.find(':') == std::string::npos;
  const std::string port = scheme + host + (alone ? ":3883" : "");
  return parsePort(port) ? std::optional(port) : std::nullopt;
}

std::optional<DeviceSettings> vrpnDeviceOf(const std::string& name, const std::string& port,
                                           const std::string& identity) {
  const auto reads = vrpn::readIdentity(identity);
  if (!reads) return std::nullopt;
  DeviceSettings device;
  device.name = name;
  device.line.driver = reads->driver;
  device.line.port = port;
  (reads->driver == "vrpn" ? device.own.vrpn.device : device.own.vrpn_pad.device) = reads->device;
  return device;
}

std::vector<std::string> serversToAsk(const DevicesSettings& devices,
                                      const std::vector<std::string>& given) {
  std::vector<std::string> all = {kUsualHere};
  const auto add = [&](const std::string& port) {
    const auto at = parsePort(port);
    const auto same = [&](const std::string& other) { return sameLine(*at, *parsePort(other)); };
    if (at && at->kind == PortKind::kTcp && std::ranges::none_of(all, same)) all.push_back(port);
  };
  for (const DeviceSettings& device : devices.list) {
    if (device.line.driver == "vrpn" || device.line.driver == "vrpn_pad") add(device.line.port);
  }
  for (const std::string& port : given) add(port);
  return all;
}

std::vector<VrpnAnswer> askServers(const std::vector<std::string>& ports, Duration wait) {
  const Timestamp until = SystemClock().now() + wait;
  const auto round = std::make_shared<Round>();
  for (const std::string& port : ports)
    round->answers.push_back({port, {}, fmt::format("no answer within {:.1f} s", toSeconds(wait))});
  // Held so that no thread changes `open` before all are counted.
  std::unique_lock lock(round->mutex);
  try {
    for (std::size_t i = 0; i < ports.size(); ++i) startAsking(round, i, until);
  } catch (const std::system_error&) {  // too many threads; the remaining servers are not asked
  }
  round->ended.wait_for(lock, wait + kGrace, [&] { return round->open == 0; });
  return round->answers;
}

}  // namespace merlin::cli
