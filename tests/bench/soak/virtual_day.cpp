#include "tests/bench/soak/virtual_day.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "daemon/status/documents.h"
#include "tests/bench/figures.h"

namespace merlin::bench {
namespace {

constexpr std::array<float, 6> kRest{}, kSpin = {0, 0, 0, 0.1F, 0.6F, 0},
                                        kPush = {0, 0, -0.7F, 0, 0, 0},
                                        kTumble = {0, 0, 0, 0.5F, 0.3F, 0.2F};
constexpr emulate::HandPlace kFar{{0.9F, 0.3F, 0.1F}, 0.8};
// The first phase is that of a person who is absent.
constexpr emulate::Phase kPhases[] = {
    {1, "open", kRest, 0, false},      {1, "open", kSpin, 0, true},
    {1, "point", kPush, 0, false},     {1, "fist", kRest, 0, true},
    {1, "fist", kRest, 0, true, kFar}, {1, "open", kTumble, 0, true, kFar},
    {1, "thumb-up", kSpin, 0, false},  {1, "open", kRest, 1, false},
    {1, "victory", kRest, 0, true},    {1, "pinch", kTumble, 0, false},
    {1, "open", kRest, 2, false},      {1, "hook", kPush, 0, true, kFar}};
// Number of visits in an hour, by the hour of the day.
constexpr std::array<double, 24> kVisits = {0, 0, 0, 0, 0, 0, 0, 0, 2, 4, 6, 6,
                                            2, 4, 6, 6, 5, 3, 2, 1, 1, 0, 0, 0};

alarms::AlarmQueue alarmOfSome() {
  AlarmSettings settings;
  settings.run = {"/bin/true"};
  settings.most_per_hour = 6;
  return alarms::AlarmQueue(settings);
}

void mix(std::uint64_t& digest, std::string_view text) {
  for (const char c : text) {
    digest ^= static_cast<std::uint8_t>(c);
    digest *= 0x100000001b3;  // FNV-1a
  }
}

}  // namespace

const emulate::MotionScript& scriptOf(const std::size_t& held) {
  static std::map<const std::size_t*, emulate::MotionScript> scripts;
  return scripts.try_emplace(&held, emulate::MotionScript{"soak", "", kPhases, &held})
      .first->second;
}

Result<std::string> VirtualDisk::read() {
  if (text_.empty()) return Error{Errc::kNotFound, "there is no state yet"};
  return text_;
}

Result<Ok> VirtualDisk::write(const std::string& text) {
  if (full) return Error{Errc::kIo, "no space left on the device"};
  text_ = text;
  return Ok{};
}

VirtualDay::VirtualDay(const Parts& parts, std::uint64_t seed)
    : parts_(parts),
      random_(seed),
      people_random_(seed + 1),
      begin_(parts.clock.now()),
      configured_(parts.settings),
      disk_(new VirtualDisk),
      keeper_(std::unique_ptr<state::StateFiles>(disk_), watch_, std::chrono::milliseconds(1)),
      health_events_(parts.devices.slots()),
      wall_events_(*parts.wall.segment()),
      alarm_(alarmOfSome()) {
  constexpr double kForEver = 1e6;
  for (std::size_t i = 0; i < parts_.devices.count(); ++i)
    explain("start", "device", "^" + parts_.devices.name(i) + ": (ok|absent)", false, 30);
  explain("people", "wall", "^the start view has returned", false, kForEver);
  explain("people", "wall", "^the desired frame rate is", false, kForEver);
}

void VirtualDay::start(const std::stop_token& stop, Timestamp end) {
  stop_ = stop;
  parts_.fibers.start([this, stop] { people(stop); });
  parts_.fibers.start([this, stop, end] { faults(stop, end); });
  parts_.fibers.start([this, stop] { mainThread(stop); });
}

double VirtualDay::between(double low, double high) {
  return low + (high - low) * std::uniform_real_distribution<double>()(random_);
}

bool VirtualDay::sleep(double seconds) {
  return parts_.clock.sleepUntil(parts_.clock.now() + fromSeconds(seconds), stop_);
}

void VirtualDay::explain(const std::string& fault, const std::string& kind,
                         const std::string& pattern, bool due, double seconds) {
  explanations_.push_back(
      {fault, kind, pattern, std::regex(pattern), parts_.clock.now() + fromSeconds(seconds), due});
}

void VirtualDay::explainDevice(const std::string& fault, std::size_t device) {
  const std::string& name = parts_.devices.name(device);
  explain(fault, "device", "^" + name + ": ", false, 150);
  explain(fault, "device", "^" + name + ": ok", true, 150);
  explain(fault, "flight", name, false, 150);
}

void VirtualDay::people(const std::stop_token& stop) {
  std::uniform_real_distribution<double> share;
  while (!stop.stop_requested()) {
    const auto hours = static_cast<std::size_t>(toSeconds(parts_.clock.now() - begin_) / 3600);
    if (share(people_random_) < kVisits[(hours + 9) % 24] / 60) visit();  // the day begins at nine
    if (!sleep(60)) return;
  }
}

// One person visits the wall, sometimes with a guest who waits for a turn.
void VirtualDay::visit() {
  ++counts_.visits;
  const bool with_guest = people_random_() % 3 == 0;
  const auto phases = 20 + people_random_() % 130;
  std::uniform_real_distribution<double> seconds(0.4, 4);
  for (std::uint64_t i = 0; i < phases && !stop_.stop_requested(); ++i) {
    parts_.persons.first = people_random_() % std::size(kPhases);
    parts_.persons.guest = with_guest ? people_random_() % std::size(kPhases) : 0;
    if (people_random_() % 25 == 0) command();
    if (!sleep(seconds(people_random_))) break;
  }
  parts_.persons = {};
}

void VirtualDay::command() {
  switch (people_random_() % 6) {
    case 0: parts_.wall.loop().request(wall::WallLoop::kNextContent); break;
    case 1: parts_.wall.loop().request(wall::WallLoop::kNextMode); break;
    case 2: parts_.wall.loop().request(wall::WallLoop::kResetView); break;
    case 3: parts_.wall.attendance().toggleBlank(); break;
    case 4: parts_.wall.attendance().toggleFreeze(); break;
    default:
      keeper_.change([this](state::State& s) { s.rate_hz = 25 + people_random_() % 5; });
      keeper_.settle();
      parts_.wall.loop().setRate(keeper_.state().rate_hz);
      break;
  }
}

void VirtualDay::mainThread(const std::stop_token& stop) {
  constexpr int kBeatsASecond = 10;
  for (int beat = 0; !stop.stop_requested(); ++beat) {
    const Timestamp now = parts_.clock.now();
    parts_.devices.segment().writeHeartbeat(now);
    parts_.wall.segment().writeHeartbeat(now);
    if (beat % kBeatsASecond == 0) tend(now);
    takeEvents(now);
    if (!sleep(1.0 / kBeatsASecond)) return;
  }
}

// Does the periodic work of merlind's main thread; called once a second.
void VirtualDay::tend(Timestamp now) {
  std::string happened;
  const auto look = [&happened](const Result<std::string>& mended) {
    const std::string& what = mended ? *mended : mended.error().what;
    if (!what.empty()) happened = what;
  };
  look(parts_.devices.segment().mend());
  look(parts_.wall.segment().mend());
  look(parts_.wall.outputs().mend());
  happened.empty() ? services_.ok("shared memory") : services_.failed("shared memory", happened);
  const std::string fault = keeper_.fault();
  fault.empty() ? services_.ok("state") : services_.failed("state", fault);
  for (const std::string& document : {status::devicesStatus(parts_.devices.slots(), now),
                                      status::wallStatus(*parts_.wall.segment(), now),
                                      status::newestSamples(parts_.devices.slots(), now)})
    counts_.documents += document.empty() ? 0U : 1U;
  std::vector<wall::BoardMessage> messages;
  (void)board_.tryRead(messages);
  if (alarm_.next(now)) ++counts_.alarms;
}

void VirtualDay::takeEvents(Timestamp now) {
  add("devices", kDeviceEvent, health_events_.take(now));
  add("devices", kFlightEvent, parts_.devices.flight().check());
  add("wall", kWallEvent, wall_events_.take());
  add("wall", kPictureEvent, wall_events_.takePictures());
  std::vector<Event> notices;
  for (std::string& notice : keeper_.takeNotices())
    notices.push_back(faultEvent(std::move(notice)));
  add("wall", kStateEvent, notices);
  add("wall", kServiceEvent, services_.takeEvents());
  for (const page::LoggedEvent& event : log_.after(told_)) {
    told_ = event.number;
    alarm_.add({event.role, event.time_utc, event.kind, event.what});
    judge(event);
  }
}

void VirtualDay::add(const char* role, const EventKind& kind, const std::vector<Event>& events) {
  for (const Event& event : events) {
    log_.addDocument(role, status::event(kind.name, event, parts_.clock.now()));
    board_.add(parts_.clock.now(), event.what);
  }
}

void VirtualDay::judge(const page::LoggedEvent& event) {
  const Timestamp now = parts_.clock.now();
  std::string found;
  std::erase_if(explanations_, [now](const auto& e) { return e.until < now && !e.due; });
  for (Explanation& e : explanations_) {
    if (e.kind != event.kind || now > e.until || !std::regex_search(event.what, e.expression))
      continue;
    ++e.count;
    found = e.fault;
  }
  // The names of flight recordings contain the time of day, so they are not part of the digest.
  mix(counts_.digest, fmt::format("{} {} {}", toNanoseconds(now), event.kind,
                                  event.kind == kFlightEvent.name ? "" : event.what));
  if (found.empty()) {
    found = "UNEXPLAINED";
    counts_.wrong.push_back(fmt::format("unexplained event after {:.1f} s: {}, {}: {}",
                                        toSeconds(now - begin_), event.role, event.kind,
                                        event.what));
    note("  " + counts_.wrong.back());
  }
  ++counts_.events[event.kind][found];
}

std::vector<std::string> VirtualDay::untold() const {
  std::vector<std::string> missing;
  for (const Explanation& e : explanations_) {
    if (e.due && e.count == 0)
      missing.push_back(fmt::format("{}: {}: {}", e.fault, e.kind, e.pattern));
  }
  return missing;
}

}  // namespace merlin::bench
