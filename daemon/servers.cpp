#include "daemon/servers.h"

#include <utility>

#include <fmt/format.h>

namespace merlin {
namespace {

constexpr Duration kSentAwayPeriod = std::chrono::seconds(5);

}  // namespace

// Destroys the servers of kept_ before the roles, because the relays for other machines use a
// role's server. Does not hold the lock meanwhile, because the servers' threads may be waiting for
// it.
Servers::~Servers() {
  decltype(kept_) kept;
  decltype(roles_) roles;
  {
    const std::lock_guard lock(mutex_);
    kept.swap(kept_);
    roles.swap(roles_);
  }
  kept.clear();
  roles.clear();
}

Result<Ok> Servers::startRole(const std::string& role, status::StatusServerSettings settings) {
  settings.name = role;
  const bool topics = !settings.network.endpoint.empty();
  const std::string topics_name = settings.network_name;
  const std::string topics_setting = settings.network_setting;
  const bool commands = !settings.network_commands.endpoint.empty();
  auto started = status::StatusServer::start(std::move(settings), watch_, clock_);
  if (!started) return started.error();
  const status::StatusServer* server = started->get();
  {
    const std::lock_guard lock(mutex_);
    roles_[role].server = *std::move(started);
  }
  const auto keepRelay = [&](const std::string& name, const std::string& setting, auto start) {
    keep(name, [this, server, setting, start]() -> Result<std::unique_ptr<net::Server>> {
      auto relay = (server->*start)(watch_);
      if (relay) return relay;
      return Error{relay.error().code, fmt::format("{}: {}", setting, relay.error().what)};
    });
  };
  if (topics) keepRelay(topics_name, topics_setting, &status::StatusServer::startNetworkTopics);
  if (commands) {
    keepRelay(fmt::format("commands of the {} over the network", role),
              fmt::format("/serve/{}_endpoint", role), &status::StatusServer::startNetworkCommands);
  }
  return Ok{};
}

void Servers::keep(const std::string& name, net::ServerKeeper::Start start) {
  auto keeper = std::make_unique<net::ServerKeeper>(name, std::move(start));
  keeper->tend(clock_.now());
  const std::lock_guard lock(mutex_);
  kept_.push_back(std::move(keeper));
}

void Servers::tend(Timestamp now) {
  for (const auto& keeper : kept_) keeper->tend(now);
}

std::vector<net::ServerHealth> Servers::health(const std::string& role) const {
  std::vector<net::ServerHealth> all;
  const std::lock_guard lock(mutex_);
  if (const auto found = roles_.find(role); found != roles_.end()) {
    for (const net::ServerReport& report : found->second.server->reports())
      all.push_back({report.name, "", report});
  }
  if (role != host_) return all;
  for (const auto& keeper : kept_) all.push_back(keeper->health());
  return all;
}

std::vector<Event> Servers::events(const std::string& role) {
  std::vector<Event> events;
  const Timestamp now = clock_.now();
  const std::lock_guard lock(mutex_);
  const auto found = roles_.find(role);
  if (found != roles_.end() && now - found->second.reported >= kSentAwayPeriod) {
    found->second.reported = now;
    for (const net::ServerReport& report : found->second.server->reports()) {
      auto sentence = net::sentAwaySentence(report, found->second.reported_sent_away[report.name]);
      if (!sentence.empty()) events.push_back(faultEvent(std::move(sentence)));
    }
  }
  if (role != host_) return events;
  for (const auto& keeper : kept_) {
    for (Event& event : keeper->takeEvents(now)) events.push_back(std::move(event));
  }
  return events;
}

}  // namespace merlin
