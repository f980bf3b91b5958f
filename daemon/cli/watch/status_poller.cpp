#include "daemon/cli/watch/status_poller.h"

#include <algorithm>
#include <set>
#include <utility>

#include "daemon/cli/roles.h"
#include "daemon/cli/wall/status_text.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string fieldText(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// Adds the events in the answer of one role to `events`.
void addEvents(const std::string& answer, std::vector<WatchedEvent>& events) {
  const auto json = Json::parse(answer, nullptr, false);
  if (!json.is_array()) return;
  for (const Json& event : json) {
    if (event.is_object())
      events.push_back({fieldText(event, "time_utc"), fieldText(event, "what")});
  }
}

// Returns the median time of a frame in the last second [ms]; nothing if none was drawn.
std::optional<double> frameTime(const Json& status) {
  const auto found = status.find("work_median_ms");
  if (found == status.end() || !found->is_number()) return std::nullopt;
  const auto ms = found->get<double>();
  return ms > 0 ? std::optional(ms) : std::nullopt;
}

}  // namespace

StatusPoller::StatusPoller(DaemonAddress daemon) : daemon_(std::move(daemon)) {}

bool StatusPoller::poll(Timestamp now, WatchedState& state) {
  if (!waiting_ && now >= next_) beginRound(now);
  if (!waiting_) return false;
  for (auto& [endpoint, role] : roles_) {
    while (takeAnswer(role, now)) {
    }
  }
  if (!isDone()) return false;
  waiting_ = false;
  publish(state);
  return true;
}

// Begins a round: sends requests for the status to all roles. The roles are looked up in each
// round, because a restarted daemon may have other addresses.
void StatusPoller::beginRound(Timestamp now) {
  next_ = now + kPeriod;
  waiting_ = true;
  findAgain();
  for (auto& [endpoint, role] : roles_) {
    role.fault.clear();
    role.asked_events = false;
    if (!role.sender->isReady()) continue;
    const auto allowed = checkMayAsk(endpoint);
    const auto sent = allowed ? role.sender->send(role.at, "status", "", now) : allowed;
    if (!sent) role.fault = sent.error().what;
  }
}

void StatusPoller::findAgain() {
  const auto found = findRoles(daemon_);
  fault_ = found ? "" : found.error().what;
  std::set<std::string> present;
  for (const FoundRole& role : found ? *found : std::vector<FoundRole>()) {
    present.insert(role.endpoints.command);
    Role& known = roles_[role.endpoints.command];
    known.at = role.commands();
    if (!known.sender) known.sender = std::make_unique<status::CommandSender>();
  }
  std::erase_if(roles_, [&](const auto& role) { return !present.contains(role.first); });
}

// Takes the answer of the role if it has arrived; after a status, asks for the events. Returns
// whether the role was asked for its events.
bool StatusPoller::takeAnswer(Role& role, Timestamp now) {
  auto answer = role.sender->answer(now);
  if (!answer) return false;
  std::string& place = role.asked_events ? role.events : role.status;
  place = *answer ? **answer : "";
  if (!*answer && !role.asked_events) role.fault = answer->error().what;
  if (!*answer || role.asked_events) return false;
  role.asked_events = static_cast<bool>(role.sender->send(role.at, "events", "", now));
  return role.asked_events;
}

bool StatusPoller::isDone() const {
  return std::ranges::all_of(roles_, [](const auto& r) { return r.second.sender->isReady(); });
}

void StatusPoller::publish(WatchedState& state) const {
  Json all = Json::object();
  std::vector<WatchedEvent> events;
  std::string fault = fault_;
  for (const auto& [endpoint, role] : roles_) {
    mergeStatus(all, role.status);
    addEvents(role.events, events);
    if (!role.fault.empty()) fault = role.fault;
  }
  if (!all.empty() && !daemon_.isRemote()) addLostRoles(daemon_.instance, all);
  state.frame_times.add(frameTime(all));
  state.absent = all.empty() ? fault : "";
  if (all.empty()) return;  // the last state is kept
  std::ranges::stable_sort(events, {}, &WatchedEvent::time_utc);
  state.status = std::move(all);
  state.events = std::move(events);
}

}  // namespace merlin::cli
