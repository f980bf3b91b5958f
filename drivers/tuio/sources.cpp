#include "drivers/tuio/sources.h"

#include <algorithm>
#include <cmath>

namespace merlin::tuio {
namespace {

constexpr std::string_view kAddresses[] = {"/tuio/2Dcur", "/tuio/2Dobj"};
// Values that follow "set": session, x, y, X, Y, m; session, class, x, y, a, X, Y, A, m, r.
constexpr std::size_t kSetValues[] = {6, 10};
constexpr std::size_t kPositionAt[] = {1, 2};
// A frame whose number is less than this much below the newest came late; if it is further below,
// the tracker was restarted.
constexpr std::int64_t kLatest = 100;
// Tolerance for coordinates outside 0..1, because a tracker may be inaccurate at its margins.
// Larger values, such as pixels, are rejected.
constexpr double kOutside = 0.25;

constexpr const char* kNotFormed = "a TUIO message does not have the form of TUIO 1.1";
constexpr const char* kNoShare =
    "positions come that are not from 0 to 1: does the tracker send pixels?";
constexpr const char* kTooMany = "more than 64 fingers or objects come at once";
constexpr const char* kTooManySources = "more than 4 TUIO sources send";

std::uint32_t keyOf(std::string_view name) noexcept {
  std::uint32_t key = 0x811C9DC5;  // FNV-1a
  for (const char c : name) key = (key ^ static_cast<unsigned char>(c)) * 0x01000193;
  return key;
}

bool isShare(const OscArgument& value) noexcept {
  return value.kind == OscArgument::kReal && value.number >= -kOutside &&
         value.number <= 1 + kOutside;
}

}  // namespace

const Sources::Contact* Sources::Contacts::find(std::int32_t session) const noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    if (list[i].session == session) return &list[i];
  }
  return nullptr;
}

void Sources::begin(std::uint32_t sender, Timestamp now) noexcept {
  key_ = sender;
  now_ = now;
  complete_ = false;
  for (Pending& frame : pending_) frame = {};
}

void Sources::take(const OscMessage& message) noexcept {
  const auto* const at = std::ranges::find(kAddresses, message.address);
  if (at == std::end(kAddresses)) return;
  const auto profile = static_cast<ProfileIndex>(at - std::begin(kAddresses));
  Pending& frame = pending_[profile];
  const auto& arguments = message.arguments;
  if (arguments.empty() || arguments[0].kind != OscArgument::kText) return drop(frame, kNotFormed);
  const std::string_view command = arguments[0].text;
  const auto values = arguments.subspan(1);
  if (command == "source") {
    if (values.empty() || values[0].kind != OscArgument::kText) return drop(frame, kNotFormed);
    key_ = keyOf(values[0].text);
  } else if (command == "alive") {
    takeAlive(values, frame);
  } else if (command == "set") {
    takeSet(values, profile, frame);
  } else if (command == "fseq") {
    takeFrame(values, profile, frame);
    frame = {};
  } else {
    drop(frame, kNotFormed);
  }
}

void Sources::drop(Pending& frame, const char* why) noexcept {
  ++bad_messages_;
  frame.bad = true;
  fault_ = why;
}

void Sources::takeAlive(std::span<const OscArgument> sessions, Pending& frame) noexcept {
  if (sessions.size() > kMostContacts) return drop(frame, kTooMany);
  frame.alive_count = 0;
  for (const OscArgument& session : sessions) {
    if (session.kind != OscArgument::kInteger) return drop(frame, kNotFormed);
    const auto listed = std::span(frame.alive).first(frame.alive_count);
    if (std::ranges::find(listed, session.integer) != listed.end()) return drop(frame, kNotFormed);
    frame.alive[frame.alive_count++] = session.integer;
  }
  frame.has_alive = true;
}

void Sources::takeSet(std::span<const OscArgument> values, ProfileIndex profile,
                      Pending& frame) noexcept {
  if (values.size() < kSetValues[profile] || values[0].kind != OscArgument::kInteger)
    return drop(frame, kNotFormed);
  const OscArgument &x = values[kPositionAt[profile]], &y = values[kPositionAt[profile] + 1];
  if (x.kind != OscArgument::kReal || y.kind != OscArgument::kReal) return drop(frame, kNotFormed);
  if (!isShare(x) || !isShare(y)) return drop(frame, kNoShare);
  Contact contact;
  contact.session = values[0].integer;
  contact.x = static_cast<float>(x.number);
  contact.y = static_cast<float>(y.number);
  Contacts& set = frame.set;
  for (std::size_t i = 0; i < set.count; ++i) {
    if (set.list[i].session != contact.session) continue;
    set.list[i] = contact;
    return;
  }
  if (set.count == kMostContacts) return drop(frame, kTooMany);
  set.list[set.count++] = contact;
}

// Returns the source of the present datagram, and adds it if it is new; null if there are too many.
Sources::Source* Sources::current() noexcept {
  Source* free = nullptr;
  for (Source& source : sources_) {
    if (source.used && source.key == key_) return &source;
    if (!source.used && !free) free = &source;
  }
  if (!free) return nullptr;
  *free = {};
  free->used = true;
  free->key = key_;
  return free;
}

// A frame with the number -1 repeats the present state, and is never late.
void Sources::takeFrame(std::span<const OscArgument> values, ProfileIndex profile,
                        Pending& frame) noexcept {
  if (values.empty() || values[0].kind != OscArgument::kInteger) return drop(frame, kNotFormed);
  if (frame.bad) return;
  if (!frame.has_alive) return drop(frame, kNotFormed);
  Source* const source = current();
  if (!source) return drop(frame, kTooManySources);
  source->heard = now_;
  Profile& known = source->profiles[profile];
  const std::int32_t number = values[0].integer;
  const std::int64_t behind = static_cast<std::int64_t>(known.frame) - number;
  if (number >= 0 && behind > 0 && behind < kLatest) {
    ++late_frames_;
    return;
  }
  if (number >= 0) known.frame = number;
  commit(profile, frame, known);
  complete_ = true;
  fault_ = "";
}

// A contact that is alive keeps its place unless this frame sets a new one. It is left out if no
// place was ever received, because the datagram was lost.
void Sources::commit(ProfileIndex profile, const Pending& frame, Profile& into) noexcept {
  Contacts next;
  for (const std::int32_t session : std::span(frame.alive).first(frame.alive_count)) {
    const Contact* const before = into.now.find(session);
    const Contact* const set = frame.set.find(session);
    if (!before && !set) continue;
    Contact contact = set ? *set : *before;
    contact.id = before ? before->id : next_id_[profile]++;
    next.list[next.count++] = contact;
  }
  into.now = next;
}

bool Sources::forgetSilent(Timestamp now) noexcept {
  bool any = false;
  for (Source& source : sources_) {
    if (!source.used || now - source.heard < kSilent) continue;
    source.used = false;
    any = true;
  }
  return any;
}

void Sources::clear() noexcept {
  for (Source& source : sources_) source.used = false;
  fault_ = "";
}

void Sources::fill(TouchFrames& frames) const noexcept {
  for (const Source& source : sources_) {
    if (!source.used) continue;
    for (const Profile& profile : source.profiles) {
      for (const Contact& contact : std::span(profile.now.list).first(profile.now.count))
        frames.add(contact.id, contact.x, contact.y);
    }
  }
}

std::size_t Sources::number() const noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(sources_, &Source::used));
}

}  // namespace merlin::tuio
