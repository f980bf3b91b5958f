// Makes the document of the topic "sample".
#include <algorithm>
#include <span>

#include "daemon/base/commands.h"
#include "daemon/status/document_parts.h"
#include "daemon/status/documents.h"

namespace merlin::status {
namespace {

// Returns a short health of each device, for a client that only receives samples.
OrderedJson briefHealth(const shm::DeviceSlots& devices) {
  OrderedJson all = OrderedJson::object();
  for (const auto& [device, slot] : devices.health) {
    const auto h = slot->read();
    if (!h) continue;
    all[device] = {{"state", static_cast<std::uint32_t>(h->state)},
                   {"since_ns", h->since_ns},
                   {"identity", text(h->identity)},
                   {"reason", text(h->reason)},
                   {"samples", h->samples},
                   {"reconnects", h->reconnects},
                   {"rate_hz", round3(static_cast<double>(h->rate_hz))}};
  }
  return all;
}

OrderedJson handJson(const HandSample& h) {
  return {{"received_ns", h.received_ns},
          {"glove_ns", h.glove_ns},
          {"counter", h.counter},
          {"flags", h.flags},
          {"joint_rad", list(std::span<const float>(h.joint_rad))},
          {"position_m", list(std::span<const float>(h.position_m))},
          {"orientation_wxyz", list(std::span<const float>(h.orientation_wxyz))},
          {"velocity_m_s", list(std::span<const float>(h.velocity_m_s))},
          {"turn_rad_s", list(std::span<const float>(h.turn_rad_s))},
          {"delay_s", h.delay_s}};
}

// Returns the last gesture of a hand.
OrderedJson gestureSampleJson(const GestureState& g) {
  return {{"received_ns", g.received_ns}, {"began_ns", g.began_ns}, {"counter", g.counter},
          {"passed_over", g.passed_over}, {"name", text(g.name)},   {"certainty", g.certainty}};
}

// Returns the actions that have begun at least once; "held" lists the names of those that are held.
OrderedJson actionsJson(const shm::ActionState& state) {
  OrderedJson begun = OrderedJson::object(), held = OrderedJson::array();
  for (std::size_t i = 0; i < kActions.size(); ++i) {
    if (state.begun[i] > 0) begun[kActions[i]] = state.begun[i];
    if (state.held[i] != 0) held.push_back(kActions[i]);
  }
  return {{"changed_ns", state.changed_ns},
          {"generation", state.generation},
          {"begun", std::move(begun)},
          {"held", std::move(held)}};
}

OrderedJson postureSampleJson(const PostureSample& p) {
  return {
      {"received_ns", p.received_ns}, {"since_ns", p.since_ns},
      {"counter", p.counter},         {"code", p.code},
      {"name", text(p.name)},         {"activation", list(std::span<const float>(p.activation))}};
}

OrderedJson gloveJson(const GloveSample& g) {
  return {{"received_ns", g.received_ns},
          {"counter", g.counter},
          {"flags", g.flags},
          {"sensors", g.sensors},
          {"raw", integers(std::span<const std::uint8_t>(g.raw))},
          {"angle_rad", list(std::span<const float>(g.angle_rad))}};
}

OrderedJson stationJson(const TrackerSample& t) {
  return {{"station", t.station},
          {"received_ns", t.received_ns},
          {"counter", t.counter},
          {"error", std::string(1, t.error)},
          {"position_m", list(std::span<const float>(t.position_m))},
          {"orientation_wxyz", list(std::span<const float>(t.orientation_wxyz))}};
}

OrderedJson ballJson(const BallSample& b) {
  return {{"received_ns", b.received_ns},
          {"counter", b.counter},
          {"buttons", b.buttons},
          {"period_us", b.period_us},
          {"raw", integers(std::span<const std::int16_t>(b.raw))},
          {"translation", list(std::span<const float>(b.translation))},
          {"rotation", list(std::span<const float>(b.rotation))},
          {"keys", integers(std::span<const std::uint16_t>(b.keys))}};
}

OrderedJson touchJson(const TouchSample& t) {
  OrderedJson fingers = OrderedJson::array();
  for (std::size_t i = 0; i < std::min<std::size_t>(t.fingers, kFingers); ++i)
    fingers.push_back({{"id", t.id[i]}, {"position", list(std::span<const float>(t.position[i]))}});
  return {{"received_ns", t.received_ns},  {"counter", t.counter},
          {"fingers", std::move(fingers)}, {"aspect", round3(static_cast<double>(t.aspect))},
          {"buttons", t.buttons},          {"wheel", t.wheel}};
}

// Adds each device's newest samples under its name; the posture of the first glove is also added at
// the top level.
void addSamples(const shm::DeviceSlots& devices, OrderedJson& json) {
  for (const auto& glove : devices.gloves) {
    const auto p = glove.posture->newest();
    if (p && &glove == &devices.gloves.front()) json["posture"] = postureSampleJson(*p);
    if (const auto g = glove.samples->newest()) json[glove.name] = gloveJson(*g);
    if (p && json.contains(glove.name)) json[glove.name]["posture"] = postureSampleJson(*p);
  }
  for (const auto& tracker : devices.trackers) {
    OrderedJson stations = OrderedJson::array();
    for (const auto* channel : tracker.stations) {
      if (const auto t = channel->newest()) stations.push_back(stationJson(*t));
    }
    if (!stations.empty()) json[tracker.name] = std::move(stations);
  }
  for (const auto& ball : devices.balls) {
    if (const auto b = ball.samples->newest()) json[ball.name] = ballJson(*b);
  }
  for (const auto& touch : devices.touches) {
    if (const auto t = touch.samples->newest()) json[touch.name] = touchJson(*t);
  }
  for (const auto& hand : devices.hands) {
    const auto h = hand.samples->newest();
    if (!h) continue;
    json[hand.name] = handJson(*h);
    if (const auto g = hand.gesture->read()) json[hand.name]["gesture"] = gestureSampleJson(*g);
  }
}

}  // namespace

std::string newestSamples(const shm::DeviceSlots& devices, Timestamp now) {
  OrderedJson json = {{"now_ns", toNanoseconds(now)}, {"time_utc", timeUtc(*devices.header, now)}};
  addSamples(devices, json);
  for (const auto& [source, slot] : devices.actions) {
    if (const auto a = slot->read()) json["actions"][source] = actionsJson(*a);
  }
  json["health"] = briefHealth(devices);
  return dump(json);
}

}  // namespace merlin::status
