// Events, which the topic "event" publishes: a sentence and a severity each; and their kinds, for
// most of which alarms can be set.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace merlin {

// kFault: somebody should look; a warning in the log. kNews: a recovery, or a change that nobody
// requested. kRoutine: what people did, or what happens at every start; it raises no alarm.
enum class Severity { kFault, kNews, kRoutine };

inline constexpr std::array<std::string_view, 3> kSeverityNames = {"fault", "news", "routine"};
constexpr std::string_view nameOf(Severity severity) {
  return kSeverityNames[static_cast<std::size_t>(severity)];
}

// Returns the severity of that name; kFault for an unknown name, so that nobody misses what a newer
// release reports.
constexpr Severity severityOf(std::string_view name) {
  for (const Severity severity : {Severity::kNews, Severity::kRoutine}) {
    if (nameOf(severity) == name) return severity;
  }
  return Severity::kFault;
}

// Something that has happened.
struct Event {
  std::string what;  // a sentence
  Severity severity;

  bool isFault() const { return severity == Severity::kFault; }
};
inline Event faultEvent(std::string what) { return {std::move(what), Severity::kFault}; }
inline Event newsEvent(std::string what) { return {std::move(what), Severity::kNews}; }
inline Event routineEvent(std::string what) { return {std::move(what), Severity::kRoutine}; }

struct EventKind {
  const char* name;
  const char* help;  // what such an event reports, and what to do about it
};

inline constexpr EventKind kDeviceEvent{
    "device",
    "a device was lost, is back, or complains: look at its plug and cable, then at "
    "`merlin devices`"};
inline constexpr EventKind kWallEvent{
    "wall",
    "an output failed or works again, or the rate or the detail was reduced since the machine "
    "is too slow: look at the outputs of `merlin status`"};
inline constexpr EventKind kPictureEvent{
    "picture",
    "an output works but does not show what it was sent: it shows black, an older frame, parts of "
    "two frames or another program's picture; or it shows the right picture again: look at "
    "`picture` of the outputs in `merlin status --json`"};
inline constexpr EventKind kModelEvent{
    "model",
    "a content was replaced, or its file cannot be shown: the sentence says why; the content "
    "before it is still shown"};
inline constexpr EventKind kProjectorEvent{
    "projector",
    "a projector does not answer, or refuses: look at its network, its "
    "lamp, its password"};
inline constexpr EventKind kServiceEvent{
    "service",
    "something that merlind can do without has failed or works again: the state's file, "
    "shared memory, a reload, the input from another machine"};
inline constexpr EventKind kServerEvent{
    "server",
    "a server for other programs cannot run, or refuses clients: its port is taken, or "
    "somebody floods it"};
inline constexpr EventKind kStateEvent{
    "state", "the file of what people changed was damaged or set aside: check alignment and rate"};
inline constexpr EventKind kFlightEvent{
    "flight",
    "the last bytes of a lost device were written to a file, for whoever looks for the "
    "fault"};
inline constexpr EventKind kRoleEvent{
    "role",
    "merlind, or one of its two processes, has not run for 15 s, or runs again; it cannot report "
    "this itself, so only alarms do: look at `systemctl status 'merlin-*'` and the journal"};
// Its events are routine: one occurs whenever a hand makes a gesture.
inline constexpr EventKind kGestureEvent{"gesture", "a hand has made a gesture"};

// The kinds for which alarms can be set.
inline constexpr std::array kEventKinds = {
    kDeviceEvent,  kWallEvent,   kPictureEvent, kModelEvent,  kProjectorEvent,
    kServiceEvent, kServerEvent, kStateEvent,   kFlightEvent, kRoleEvent};

}  // namespace merlin
