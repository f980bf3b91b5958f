#include "daemon/status/sample_link.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <zmq.hpp>

#include "daemon/base/commands.h"
#include "daemon/base/log.h"
#include "daemon/status/documents.h"
#include "drivers/port/plausible.h"

namespace merlin::status {
namespace {

using Json = nlohmann::json;

constexpr int kRound_ms = 100;
constexpr std::int64_t kLongestDocument = 65536;

template <std::size_t N>
void setText(char (&field)[N], const std::string& text) {
  const std::size_t n = std::min(text.size(), N - 1);
  std::memcpy(field, text.data(), n);
  std::memset(field + n, 0, N - n);
}

// Read the member `key`: a number, or a list of exactly N numbers. `field` is unchanged if the
// member is missing or of another kind.
template <typename T>
void read(const Json& object, const char* key, T& field) {
  const auto found = object.find(key);
  if (found != object.end() && found->is_number()) field = found->get<T>();
}
template <typename T, std::size_t N>
void read(const Json& object, const char* key, T (&field)[N]) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array() || found->size() != N) return;
  for (std::size_t i = 0; i < N; ++i) {
    if ((*found)[i].is_number()) field[i] = (*found)[i].get<T>();
  }
}

// Applies one document to the segment.
class Apply {
 public:
  Apply(const Json& document, const std::string& from, Timestamp now, shm::DevicesSegment& segment)
      : document_(document), from_(from), now_(now), segment_(segment) {
    read(document, "now_ns", there_now_ns_);
  }

  void all(const shm::SlotNames& names) {
    std::size_t gloves = 0, trackers = 0, balls = 0, touches = 0;
    for (std::size_t i = 0; i < names.devices.size(); ++i) {
      const auto& [name, kind] = names.devices[i];
      if (kind == SampleKind::kGlove) glove(name, segment_.glove[gloves++]);
      if (kind == SampleKind::kTracker) tracker(name, segment_.tracker[trackers++]);
      if (kind == SampleKind::kBall) ball(name, segment_.ball[balls++]);
      if (kind == SampleKind::kTouch) touch(name, segment_.touch[touches++]);
      actions(name, segment_.actions[i]);
      health(name, segment_.health[i]);
    }
    for (std::size_t i = 0; i < names.hands.size(); ++i) {
      hand(names.hands[i], segment_.hand[i]);
      gesture(names.hands[i], segment_.gesture[i]);
      actions(names.hands[i], segment_.actions[shm::kFirstHandSource + i]);
    }
    actions("panel", segment_.actions[shm::kPanelSource]);
  }

 private:
  // Converts a time stamp of the other machine to this machine's clock, keeping its age; 0 if it
  // cannot be represented.
  std::int64_t here(std::int64_t there_ns) const {
    std::int64_t age = 0, here = 0;
    if (__builtin_sub_overflow(there_now_ns_, there_ns, &age) ||
        __builtin_sub_overflow(toNanoseconds(now_), age, &here))
      return 0;
    return here;
  }
  template <typename T>
  T common(const Json& object) const {
    T sample{};
    read(object, "received_ns", sample.received_ns);
    read(object, "counter", sample.counter);
    sample.received_ns = here(sample.received_ns);
    return sample;
  }
  template <typename T>
  void publish(shm::Channel<T>& channel, const T& sample) {
    if (!plausible(sample)) return;  // checked like a device's samples: the network is not trusted
    const auto last = channel.newest();
    if (!last || last->counter != sample.counter) channel.publish(sample);
  }
  static const Json* object(const Json& parent, const std::string& key) {
    const auto found = parent.find(key);
    return found != parent.end() && found->is_object() ? &*found : nullptr;
  }

  template <std::size_t N>
  static void readName(const Json& o, char (&field)[N]) {
    const auto name = o.find("name");
    if (name != o.end() && name->is_string()) setText(field, name->get<std::string>());
  }

  void posture(const Json& of_glove, shm::Channel<PostureSample>& slot) {
    const Json* o = object(of_glove, "posture");
    if (!o) return;
    auto s = common<PostureSample>(*o);
    read(*o, "since_ns", s.since_ns);
    s.since_ns = here(s.since_ns);
    read(*o, "code", s.code);
    read(*o, "activation", s.activation);
    readName(*o, s.name);
    publish(slot, s);
  }
  void glove(const std::string& name, shm::GloveSlots& slots) {
    const Json* o = object(document_, name);
    if (!o) return;
    posture(*o, slots.posture);
    auto s = common<GloveSample>(*o);
    read(*o, "flags", s.flags);
    read(*o, "sensors", s.sensors);
    read(*o, "angle_rad", s.angle_rad);
    read(*o, "raw", s.raw);
    publish(slots.samples, s);
  }
  void tracker(const std::string& name, shm::TrackerSlots& slots) {
    const auto list = document_.find(name);
    if (list == document_.end() || !list->is_array()) return;
    for (const Json& o : *list) {
      auto s = common<TrackerSample>(o);
      read(o, "station", s.station);
      if (s.station < 1 || s.station > kStations) continue;
      read(o, "position_m", s.position_m);
      read(o, "orientation_wxyz", s.orientation_wxyz);
      const auto error = o.find("error");
      const bool text = error != o.end() && error->is_string();
      s.error = text && error->get<std::string>().size() == 1 ? error->get<std::string>()[0] : ' ';
      publish(slots.stations[s.station - 1], s);
    }
  }
  void ball(const std::string& name, shm::Channel<BallSample>& slot) {
    const Json* o = object(document_, name);
    if (!o) return;
    auto s = common<BallSample>(*o);
    read(*o, "buttons", s.buttons);
    read(*o, "translation", s.translation);
    read(*o, "rotation", s.rotation);
    read(*o, "raw", s.raw);
    read(*o, "period_us", s.period_us);
    read(*o, "keys", s.keys);
    publish(slot, s);
  }
  void touch(const std::string& name, shm::Channel<TouchSample>& slot) {
    const Json* o = object(document_, name);
    const auto list = o ? o->find("fingers") : Json::const_iterator();
    if (!o || list == o->end() || !list->is_array() || list->size() > kFingers) return;
    auto s = common<TouchSample>(*o);
    read(*o, "aspect", s.aspect);
    read(*o, "buttons", s.buttons);
    read(*o, "wheel", s.wheel);
    for (const Json& finger : *list) {
      if (!finger.is_object()) return;
      read(finger, "id", s.id[s.fingers]);
      read(finger, "position", s.position[s.fingers]);
      ++s.fingers;
    }
    publish(slot, s);
  }
  void hand(const std::string& name, shm::Channel<HandSample>& slot) {
    const Json* o = object(document_, name);
    if (!o) return;
    auto s = common<HandSample>(*o);
    read(*o, "flags", s.flags);
    read(*o, "glove_ns", s.glove_ns);
    s.glove_ns = here(s.glove_ns);
    read(*o, "joint_rad", s.joint_rad);
    read(*o, "position_m", s.position_m);
    read(*o, "orientation_wxyz", s.orientation_wxyz);
    read(*o, "velocity_m_s", s.velocity_m_s);
    read(*o, "turn_rad_s", s.turn_rad_s);
    read(*o, "delay_s", s.delay_s);
    publish(slot, s);
  }
  void gesture(const std::string& hand, shm::SeqSlot<GestureState>& slot) {
    const Json* of_hand = object(document_, hand);
    const Json* o = of_hand ? object(*of_hand, "gesture") : nullptr;
    if (!o) return;
    auto s = common<GestureState>(*o);
    read(*o, "began_ns", s.began_ns);
    s.began_ns = here(s.began_ns);
    read(*o, "passed_over", s.passed_over);
    read(*o, "certainty", s.certainty);
    if (!std::isfinite(s.certainty)) s.certainty = 0;
    readName(*o, s.name);
    const auto last = slot.read();
    if (!last || last->counter != s.counter || last->passed_over != s.passed_over) slot.publish(s);
  }
  // Fills the list `recent` of actions that have begun. The documents do not contain the order in
  // which actions began, so those that began between two documents are listed in the order of
  // kActions.
  static void list(const shm::ActionState& last, shm::ActionState& s) {
    constexpr std::uint32_t kKept = sizeof(s.recent);
    s.sequence = last.sequence;
    std::copy(std::begin(last.recent), std::end(last.recent), s.recent);
    for (std::size_t i = 0; i < kActions.size(); ++i) {
      const std::uint32_t times =
          s.begun[i] > last.begun[i] ? std::min(s.begun[i] - last.begun[i], kKept) : 0;
      for (std::uint32_t n = 0; n < times; ++n)
        s.recent[s.sequence++ % kKept] = static_cast<std::uint8_t>(i);
    }
  }
  void actions(const std::string& source, shm::SeqSlot<shm::ActionState>& slot) {
    const Json* all = object(document_, "actions");
    const Json* found = all ? object(*all, source) : nullptr;
    if (!found) return;
    const auto last = slot.read();
    shm::ActionState s{};
    read(*found, "changed_ns", s.changed_ns);
    s.changed_ns = here(s.changed_ns);
    read(*found, "generation", s.generation);
    const auto begun = found->find("begun"), held = found->find("held");
    for (std::size_t i = 0; i < kActions.size(); ++i) {
      if (begun != found->end() && begun->is_object()) read(*begun, kActions[i], s.begun[i]);
      const bool is_held = held != found->end() && held->is_array() &&
                           std::find(held->begin(), held->end(), kActions[i]) != held->end();
      s.held[i] = is_held && isHeldAction(kActions[i]) ? 1 : 0;
    }
    const bool same = last && last->generation == s.generation;
    if (same) list(*last, s);
    const bool news = !same || !std::equal(std::begin(s.begun), std::end(s.begun), last->begun) ||
                      !std::equal(std::begin(s.held), std::end(s.held), last->held);
    if (news) slot.publish(s);
  }
  void health(const std::string& device, shm::SeqSlot<DeviceHealth>& slot) {
    const Json* all = object(document_, "health");
    const Json* found = all ? object(*all, device) : nullptr;
    if (!found) return;
    const auto last = slot.read();
    DeviceHealth h{};
    std::uint32_t state = 0;
    read(*found, "state", state);
    h.state = static_cast<HealthState>(std::min(state, 3U));
    read(*found, "since_ns", h.since_ns);
    h.since_ns = here(h.since_ns);
    h.updated_ns = toNanoseconds(now_);
    read(*found, "samples", h.samples);
    read(*found, "rate_hz", h.rate_hz);
    read(*found, "reconnects", h.reconnects);
    const auto text = [&](const char* key) {
      const auto t = found->find(key);
      return t != found->end() && t->is_string() ? t->get<std::string>() : std::string();
    };
    setText(h.port, from_);
    setText(h.identity, text("identity"));
    setText(h.reason, text("reason"));
    // since_ns, computed anew from each document, would vary with the network's delay: keep the
    // first.
    if (last && last->state == h.state) h.since_ns = last->since_ns;
    slot.publish(h);
  }

  const Json& document_;
  const std::string& from_;
  Timestamp now_;
  shm::DevicesSegment& segment_;
  std::int64_t there_now_ns_ = 0;
};

}  // namespace

bool applySamples(const std::string& document, const std::string& from, Timestamp now,
                  const shm::SlotNames& names, shm::DevicesSegment& segment) {
  if (document.size() > kLongestDocument) return false;
  const auto json = Json::parse(document, nullptr, false);
  if (!json.is_object() || !json.contains("now_ns")) return false;
  Apply(json, from, now, segment).all(names);
  return true;
}

struct SampleLink::Socket {
  zmq::context_t context{1};
  zmq::socket_t subscriber{context, zmq::socket_type::sub};
};

Result<std::unique_ptr<SampleLink>> SampleLink::start(SampleLinkSettings settings,
                                                      shm::SlotNames names,
                                                      shm::DevicesSegment& segment,
                                                      ThreadWatch& watch, const Clock& clock) {
  std::unique_ptr<SampleLink> link(
      new SampleLink(std::move(settings), std::move(names), segment, clock));
  try {
    link->connect();
  } catch (const zmq::error_t& e) {
    return Error{Errc::kInvalidArgument, fmt::format("{}: {} (is the address or a key wrong?)",
                                                     link->settings_.endpoint, e.what())};
  }
  link->thread_ = WatchedThread(
      watch, "devices of another machine",
      [l = link.get()](const std::stop_token& stop, Progress& p) { l->run(stop, p); });
  return link;
}

SampleLink::SampleLink(SampleLinkSettings settings, shm::SlotNames names,
                       shm::DevicesSegment& segment, const Clock& clock)
    : settings_(std::move(settings)),
      names_(std::move(names)),
      segment_(segment),
      clock_(clock),
      heard_(clock.now()),
      renew_after_(settings_.renew_after) {}

SampleLink::~SampleLink() { thread_.stop(); }

void SampleLink::connect() {
  socket_.reset();  // closes the old connection first
  auto socket = std::make_unique<Socket>();
  zmq::socket_t& s = socket->subscriber;
  s.set(zmq::sockopt::linger, 0);
  s.set(zmq::sockopt::rcvtimeo, kRound_ms);
  s.set(zmq::sockopt::rcvhwm, 4);  // old samples are useless
  s.set(zmq::sockopt::maxmsgsize, kLongestDocument);
  s.set(zmq::sockopt::reconnect_ivl, 100);
  s.set(zmq::sockopt::reconnect_ivl_max, 500);
  s.set(zmq::sockopt::heartbeat_ivl, 500);
  s.set(zmq::sockopt::heartbeat_timeout, 1500);
  s.set(zmq::sockopt::curve_serverkey, settings_.server_key);
  s.set(zmq::sockopt::curve_publickey, settings_.keys.public_key);
  s.set(zmq::sockopt::curve_secretkey, settings_.keys.secret_key);
  s.set(zmq::sockopt::subscribe, "sample");
  s.connect(settings_.endpoint);
  socket_ = std::move(socket);
  connected_ = clock_.now();
}

void SampleLink::run(const std::stop_token& stop, Progress& progress) {
  lost(clock_.now());
  while (!stop.stop_requested()) {
    progress.step();
    try {
      if (socket_ && take()) continue;
      const Timestamp now = clock_.now();
      if (now - heard_ >= settings_.silence) lost(now);
      renewWhereSilent(now);
    } catch (const std::exception& e) {
      if (said_ != e.what()) logWarning("{}: {}", settings_.endpoint, e.what());
      said_ = e.what();
      std::this_thread::sleep_for(std::chrono::milliseconds(kRound_ms));
    }
  }
}

bool SampleLink::take() {
  zmq::message_t topic, document;
  if (!socket_->subscriber.recv(topic) || !topic.more() || !socket_->subscriber.recv(document))
    return false;
  bool more = document.more();
  while (more) {  // discards further parts, so that the next document begins with its topic
    zmq::message_t part;
    if (!socket_->subscriber.recv(part)) break;
    more = part.more();
  }
  if (!applySamples(document.to_string(), settings_.endpoint, clock_.now(), names_, segment_))
    return false;
  heard_ = clock_.now();
  renew_after_ = settings_.renew_after;
  ever_ = true;
  return true;
}

void SampleLink::renewWhereSilent(Timestamp now) {
  if (now - std::max(heard_, connected_) < renew_after_) return;
  renew_after_ = std::min(2 * renew_after_, settings_.renew_at_most);
  connected_ = now;  // set even if connect() fails, so that it is not tried again at once
  connect();
}

void SampleLink::lost(Timestamp now) {
  for (std::size_t i = 0; i < names_.devices.size(); ++i) {
    auto& slot = segment_.health[i];
    const auto last = slot.read();
    DeviceHealth h = last.value_or(DeviceHealth{});
    if (!last || h.state != HealthState::kAbsent) h.since_ns = toNanoseconds(now);
    h.state = HealthState::kAbsent;
    h.updated_ns = toNanoseconds(now);
    h.rate_hz = 0;
    setText(h.port, settings_.endpoint);
    setText(h.reason, fmt::format("nothing received from {}{}", settings_.endpoint,
                                  ever_ ? ": the link is lost" : " yet"));
    slot.publish(h);
  }
}

}  // namespace merlin::status
