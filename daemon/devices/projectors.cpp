#include "daemon/devices/projectors.h"

#include <ctime>
#include <utility>

#include <fmt/format.h>

namespace merlin::devices {
namespace {

constexpr Duration kPanelRetry = std::chrono::seconds(1);

}  // namespace

pjlink::LocalMinute localMinute() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  ::localtime_r(&now, &local);
  return ::timegm(&local) / 60;
}

Projectors::Projectors(const DevicesSettings& settings, Parts parts)
    : parts_(std::move(parts)),
      schedule_(settings.projector_schedule),
      panel_due_(parts_.clock.now()) {
  ::tzset();  // needed because localtime_r() may ignore TZ
  for (const PjlinkSettings& projector : settings.projectors) add(projector);
}

Projectors::Entry& Projectors::add(const PjlinkSettings& settings) {
  entries_.push_back(std::make_unique<Entry>());
  Entry& entry = *entries_.back();
  entry.name = settings.name;
  const auto connect =
      [this, &entry,
       address = projectorAddress(settings.address)]() -> Result<std::unique_ptr<ByteStream>> {
    if (!address) return Error{Errc::kInvalidArgument, "the address is not valid"};
    if (!entry.progress) return parts_.connect(*address);
    const Progress::Pause pause(*entry.progress);  // looking up a host name may take long
    return parts_.connect(*address);
  };
  entry.loop = std::make_unique<pjlink::ProjectorLoop>(settings, connect, parts_.clock);
  return entry;
}

void Projectors::start(ThreadWatch& watch, std::vector<WatchedThread>& threads) {
  for (const auto& entry : entries_) {
    threads.emplace_back(watch, "projector " + entry->name,
                         [&entry = *entry](const std::stop_token& stop, Progress& progress) {
                           entry.progress = &progress;
                           entry.loop->run(stop, [&progress] { progress.step(); });
                         });
  }
}

void Projectors::remember(std::optional<PersonsSwitch> last,
                          std::function<void(const PersonsSwitch&)> keep) {
  by_person_ = last;
  keep_ = std::move(keep);
}

Result<Ok> Projectors::switchPanel(bool on) {
  if (!parts_.panel) return Ok{};
  return parts_.panel(on ? "projector_on" : "projector_off");
}

Result<Ok> Projectors::switchAll(bool on) {
  std::string refused;
  Errc code = Errc::kIo;
  const auto add = [&](const std::string& name, const std::string& why, const char* until) {
    refused += fmt::format("{}{}: {}; it is switched {} {}", refused.empty() ? "" : "; ", name, why,
                           on ? "on" : "off", until);
  };
  const PersonsSwitch person{on, parts_.local_minute()};
  keep_(person);
  {
    const std::lock_guard lock(mutex_);
    by_person_ = person;
    panel_wanted_.reset();
    if (const auto done = switchPanel(on); !done) {
      code = done.error().code;
      panel_wanted_ = on;
      add("panel", done.error().what, "afterwards");
    }
  }
  for (const auto& entry : entries_) {
    const pjlink::ProjectorState state = entry->loop->state();
    entry->loop->want(on);
    if (!state.answers && state.health != pjlink::Health::kOpening)
      add(entry->name, state.reason, "when it answers");
  }
  if (refused.empty()) return Ok{};
  return Error{code, refused};
}

// Returns the state to which the projectors are to be switched now; nothing: no change. A restart
// of merlind is not a switching point: if a person has switched the projectors after the last
// switching point, that state stays in effect. REQUIRES: mutex_ is held.
std::optional<bool> Projectors::due() {
  const pjlink::LocalMinute now = parts_.local_minute();
  std::optional<bool> wanted = schedule_.step(now);
  if (!wanted) return wanted;
  bool person = !std::exchange(follows_schedule_, true) && by_person_;
  if (person) {
    const auto point = schedule_.next(by_person_->at);
    person = !point || point->at > now;
  }
  if (person) wanted = by_person_->on;
  notices_.push_back(
      routineEvent(fmt::format("projectors: switched {} {}", *wanted ? "on" : "off",
                               person ? "again, as by a person before" : "by the schedule")));
  return wanted;
}

void Projectors::tend() {
  const std::lock_guard lock(mutex_);
  if (const auto wanted = due()) {
    for (const auto& entry : entries_) entry->loop->want(*wanted);
    panel_wanted_ = wanted;
    panel_due_ = parts_.clock.now();
  }
  if (!panel_wanted_ || parts_.clock.now() < panel_due_) return;
  panel_due_ = parts_.clock.now() + kPanelRetry;
  if (switchPanel(*panel_wanted_)) panel_wanted_.reset();
}

void Projectors::round() {
  for (const auto& entry : entries_) entry->loop->round();
}

std::vector<pjlink::ProjectorState> Projectors::states() const {
  std::vector<pjlink::ProjectorState> states;
  for (const auto& entry : entries_) states.push_back(entry->loop->state());
  return states;
}

std::vector<Event> Projectors::takeEvents() {
  std::vector<Event> events;
  {
    const std::lock_guard lock(mutex_);
    events = std::exchange(notices_, {});
  }
  for (const auto& entry : entries_) {
    const pjlink::ProjectorState state = entry->loop->state();
    if (state.health == pjlink::Health::kOpening) continue;
    std::string sentence =
        fmt::format("projector {}: {}, {}{}", entry->name, pjlink::powerName(state.power),
                    pjlink::healthName(state.health),
                    state.reason.empty() ? "" : fmt::format(" ({})", state.reason));
    if (sentence == entry->last) continue;
    entry->last = sentence;
    const bool is_fault = state.health != pjlink::Health::kOk;
    const bool was_fault = std::exchange(entry->was_fault, is_fault);
    // An event is routine if neither it nor the one before it is a fault, e.g. daily switching.
    const Severity severity = was_fault ? Severity::kNews : Severity::kRoutine;
    events.push_back({std::move(sentence), is_fault ? Severity::kFault : severity});
  }
  return events;
}

}  // namespace merlin::devices
